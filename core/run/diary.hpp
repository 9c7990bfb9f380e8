/// The record of a run: to its observer while it goes on, and as its outcome at the end.
#pragma once

#include "core/methods/steppers.hpp"
#include "core/run/peak_search.hpp"
#include "core/run/record.hpp"
#include "core/run/underway.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wingspread {

/// Records latches, phases and energy of a run, shows it to its observer, and makes its outcome.
template <class T, class AnySystem> class Diary {
public:
  Diary(Underway<T, AnySystem>& run, const Observer& observer) : run_(run), observer_(observer) {}

  /// A run begins. Takes the storage of the last outcome's latches and phases, unless the caller has moved it out.
  void start() {
    keep_storage(outcome_.latches, latches_);
    keep_storage(outcome_.phases, phases_);
    for (std::vector<HingeEvent>* events : {&missed_, &let_go_, &releases_}) events->clear();
    largest_drift_ = 0;
    samples_ = 0;
    initial_energy_ = run_.goal.end_state || run_.goal.audit ? energy() : 0;
  }

  /// The events of latches and holds so far.
  [[nodiscard]] LatchRecord record() { return {latches_, missed_, let_go_, releases_}; }
  [[nodiscard]] bool any_latch() const { return !latches_.empty(); }
  /// How often a latch has engaged or let go.
  [[nodiscard]] std::size_t latch_events() const { return latches_.size() + let_go_.size(); }

  /// Begins a phase, unless the method is that of the last one. @param steps accepted so far
  void begin_phase(Method method, long steps) {
    const std::string_view name = method_names[static_cast<std::size_t>(method)];
    if (!phases_.empty() && phases_.back().method == name) return;
    end_phase(steps);
    phases_.push_back({std::string(name), static_cast<double>(run_.step.t), 0, -steps});
  }

  /// Whether the run has an observer.
  [[nodiscard]] bool is_watched() const { return static_cast<bool>(observer_); }

  void watch_energy() {
    if (run_.goal.audit && !any_latch())
      largest_drift_ = std::max(largest_drift_, std::abs(energy() - initial_energy_));
  }

  /// Shows the observer the run's present state; with a sample interval, only at the start.
  void notify() {
    if (!observer_ || (on_grid() && samples_ > 0)) return;
    show(run_.step.x, run_.step.t);
  }

  /// Shows the observer the samples inside a step just accepted, by dense output. Their evaluations do not count:
  /// `auto` compares the methods by the evaluations that their steps take.
  /// @param by_method by_method(s) writes the method's own state at s to the run's x; false: it has none
  template <class ByMethod> void notify_inside(ByMethod&& by_method) {
    if (!observer_ || !on_grid()) return;
    const Step<T>& step = run_.step;
    const long evaluations = run_.system.work().evaluations;
    const double end = static_cast<double>(T(step.t + step.h));
    constexpr double rounding = 1 + 1e-14; // a multiple of the interval may be the end of the run
    for (double t = time_of_sample(); t <= end * rounding; t = time_of_sample()) {
      const T s = smaller(T(1), T((T(t) - step.t) / step.h));
      if (run_.system.work().locked > 0 && !run_.goal.sample_motion_only)
        run_.evaluate_at(s); // moments on stuck hinges follow from accelerations
      else if (!(s < T(1) && by_method(s)))
        interpolate(run_.system, step, s, run_.x);
      show(run_.x, T(t));
    }
    run_.system.writable_workspace().evaluations = evaluations;
  }

  /// Makes the outcome of a run that has ended.
  void close(Status status, std::string reason, const Work& work,
             const PeakSearch<T, AnySystem>& peaks, const Finality& final) {
    end_phase(work.steps);
    const Wing<T>& wing = run_.system.wing();
    Outcome& out = outcome_;
    out.status = status;
    out.reason = std::move(reason);
    out.phases = std::move(phases_);
    out.t_end = static_cast<double>(run_.step.t);
    out.latches = std::move(latches_);
    out.missed = missed_, out.let_go = let_go_, out.releases = releases_;
    out.never_released.clear(), out.may_release_later.clear();
    if (run_.goal.peak_moment) out.peak_moment = in_scene_order(wing, peaks.moments());
    if (run_.goal.peak_force) out.peak_force = in_scene_order(wing, peaks.forces());
    if (run_.goal.hold_moment && !wing.releases.empty())
      out.hold_moment = in_scene_order(wing, peaks.holds());
    out.motor_energy.assign(peaks.motor_energy().empty() ? 0 : wing.size(), 0.0);
    for (int i = 1; i < static_cast<int>(peaks.motor_energy().size()); ++i)
      out.motor_energy[wing.hinge_of[i]] = static_cast<double>(peaks.motor_energy()[i]);
    if (run_.goal.final_angle) out.final_angle.resize(wing.size());
    for (int i = 1; run_.goal.final_angle && i <= wing.size(); ++i)
      out.final_angle[wing.hinge_of[i]] =
          static_cast<double>(T(run_.step.x[run_.at.angle(i)] - wing.hinges[i].latched));
    if (run_.goal.overtravel) out.overtravel.resize(wing.size());
    for (int i = 1; run_.goal.overtravel && i <= wing.size(); ++i)
      out.overtravel[wing.hinge_of[i]] = static_cast<double>(peaks.overtravel()[i]);
    if (run_.at.base > 0)
      out.base_peaks = {static_cast<double>(peaks.base().angle),
                        static_cast<double>(peaks.base().rate)};
    out.peaks_final = final.peaks;
    out.moments_final = final.moments, out.forces_final = final.forces;
    out.latches_final = final.latches;
    out.work = work;
    if (!run_.goal.end_state) return;
    out.final = configuration_at(run_.system, run_.step.x, run_.step.t);
    out.energy = {initial_energy_, energy(), largest_drift_};
  }
  [[nodiscard]] Outcome&& outcome() { return std::move(outcome_); }

  /// Notes the held hinges that stall the run. @pre closed
  void note_held_hinges(const std::vector<int>& never_released,
                        const std::vector<int>& may_release_later) {
    outcome_.never_released = never_released, outcome_.may_release_later = may_release_later;
  }

private:
  void show(const State<T>& x, const T& t) {
    fill_sample(sample_, run_.system, x, t, run_.goal.sample_motion_only);
    observer_(sample_);
    ++samples_;
  }

  /// Reuses the storage of the last outcome unless a caller has moved it out.
  template <class Items> static void keep_storage(Items& last, Items& next) {
    if (next.capacity() == 0) next = std::move(last);
    next.clear();
  }

  [[nodiscard]] bool on_grid() const { return run_.goal.sample_interval > 0; }
  [[nodiscard]] double time_of_sample() const {
    return static_cast<double>(samples_) * run_.goal.sample_interval;
  }

  void end_phase(long steps) {
    if (phases_.empty()) return;
    phases_.back().to = static_cast<double>(run_.step.t);
    phases_.back().steps += steps;
  }

  [[nodiscard]] double energy() { return total_energy(run_.system, run_.step.x, run_.step.t); }

  Underway<T, AnySystem>& run_;
  const Observer& observer_;
  Outcome outcome_;
  std::vector<LatchEvent> latches_;
  std::vector<HingeEvent> missed_, let_go_, releases_;
  std::vector<Phase> phases_;
  Sample sample_;                                 ///< the last one shown
  long samples_ = 0;                              ///< shown to the observer
  double initial_energy_ = 0, largest_drift_ = 0; ///< J
};

} // namespace wingspread
