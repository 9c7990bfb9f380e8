/// `auto`: which method integrates, chosen anew while the run goes on.
///
/// A phase begins with an explicit method, which resolves the shock of a latch best: of order 5,
/// or, below tolerances measured to be the break-even, of order 8, or by power series where the
/// motion has them. Once what is fast has died out
/// and its steps are held back by stability and no longer by accuracy, the linearly implicit
/// extrapolation is tried; it keeps the work where it gets further for its cost, and gives it back
/// where it does not.
///
/// Whether stability holds a step back is seen from h·ρ, ρ the spectral radius of the linear model
/// [0 E2; −M⁻¹K −M⁻¹D] of springs, latches and friction at the present configuration; a bound of it that
/// costs nothing decides first, and it is measured once that says that steps may be held back.
#pragma once

#include "core/methods/held_back_steps.hpp"
#include "core/methods/steppers.hpp"
#include "core/outcome.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace wingspread {

/// Which method is active, and when that changes.
class MethodChoice {
public:
  /// @param how its method: a name from `methods()`
  /// @param series whether the wing's motion has them: where not, dop853 is in their place
  MethodChoice(const Integration& how, bool series) : automatic_(how.method == "auto") {
    // where latches are smoothed, order 8 pays at tighter tolerances only
    const double limit = how.smoothing ? break_even_smoothed : break_even;
    explicit_ = how.rtol < limit ? Method::dop853 : Method::dopri5;
    if (series && how.rtol < break_even_series) explicit_ = Method::taylor;
    for (std::size_t k = 0; k < method_names.size(); ++k)
      if (method_names[k] == how.method) explicit_ = static_cast<Method>(k);
    if (explicit_ == Method::taylor && (!series || how.smoothing)) explicit_ = Method::dop853;
    active_ = explicit_;
  }

  [[nodiscard]] Method active() const { return active_; }
  [[nodiscard]] bool automatic() const { return automatic_; }

  /// A phase begins.
  /// @param most ρ in it is no larger; infinity: nothing bounds it, and it counts as 0 until measured
  void restart(double time, long evaluations, double most) {
    active_ = explicit_;
    steps_ = 0;
    held_back_.last_free = mark(time, evaluations);
    held_back_.wait_until = explicit_ == Method::taylor ? first_thought_of_series : 0;
    measured_ = !std::isfinite(most);
    wants_first_ = false;
    keep_radius(measured_ ? 0 : most);
    patience_ = first_patience;
    pause_ = first_pause;
  }

  /// Whether ρ should be measured anew before the next step.
  [[nodiscard]] bool wants_radius() const {
    return automatic_ && (measured_ ? steps_ % radius_interval == first_radius : wants_first_);
  }
  /// @param time, evaluations of the run
  void set_radius(double radius, double time, long evaluations) {
    if (!measured_) { // steps count as held back from here on, and those that the bound alone has asked for
      held_back_.last_free = mark(time, evaluations);
      held_back_.last_free.steps -= HeldBackSteps<double>::enough - first_radius;
      measured_ = true;
    }
    keep_radius(radius);
  }

private:
  void keep_radius(double radius) {
    const double limit = explicit_ == Method::taylor   ? TaylorSeries<double>::stable_real
                         : explicit_ == Method::dop853 ? DormandPrince853<double>::stable_real
                                                       : DormandPrince5<double>::stable_real;
    stable_step_ = radius > 0 ? limit / radius : 1e300;
    held_back_.shortest = held_back_share * stable_step_;
  }

public:
  /// Whether after a step of h another method may have to be thought of: `after_step` then needs to
  /// know how quickly things change.
  [[nodiscard]] bool may_leave(double h) const {
    return automatic_ &&
           (active_ != explicit_ || held_back_.may_leave(h, static_cast<double>(steps_ + 1)));
  }

  /// A step of h was accepted, which ends at `time`.
  /// @param evaluations of the run
  /// @param quickness by how much the motion changes in a unit of time, 1/s
  /// @return whether another method goes on from here
  [[nodiscard]] bool after_step(double h, double time, long evaluations, double quickness) {
    if (!automatic_) return false;
    ++steps_;
    const Mark now = mark(time, evaluations);
    return active_ == explicit_ ? leave_explicit(h, now, quickness) : leave_implicit(now);
  }

  /// The step that the method now active should try first.
  [[nodiscard]] double first_step(double h) const {
    return active_ == explicit_ ? std::min(h, 0.5 * stable_step_) : h;
  }

  // ---- steps made elsewhere with the explicit method

  [[nodiscard]] long steps() const { return steps_; } ///< of this phase
  /// Steps that may be accepted before ρ is due.
  [[nodiscard]] long steps_to_radius() const {
    if (!automatic_ || !measured_) return std::numeric_limits<long>::max();
    return (radius_interval + first_radius - 1 - steps_ % radius_interval) % radius_interval;
  }
  [[nodiscard]] const HeldBackSteps<double>& held_back() const { return held_back_; }
  /// So many steps of the phase have been accepted, none of which may leave.
  void resume(long steps, const HeldBackSteps<double>& held_back) {
    if (!automatic_) return;
    steps_ = steps;
    held_back_ = held_back;
  }

private:
  using Mark = StepMark<double>;
  [[nodiscard]] Mark mark(double time, long evaluations) const {
    return {time, static_cast<double>(evaluations), static_cast<double>(steps_)};
  }

  static constexpr double break_even = 5e-3; // rtol; see the work-precision study
  static constexpr double break_even_smoothed = 5e-4;
  static constexpr double break_even_series = 5e-5;
  static constexpr int radius_interval = 128; // steps between two measurements of ρ
  static constexpr int first_radius = 7;      // steps to the first: short phases need none
  static constexpr int long_enough = 1600;    // to try without promise
  /// Steps until it is thought of again where there was no promise; doubled each time.
  static constexpr int first_pause = 10, longest_pause = 80;
  static constexpr double held_back_share = 0.4; // of the stable step: that of one held back
  /// Steps of a phase by series before another method is thought of: most phases are over by then, and what holds
  /// back long steps of high order is accuracy.
  static constexpr int first_thought_of_series = 100;
  /// An implicit step costs as much as about ten explicit ones, and cannot be much longer than the
  /// motion takes to change: where the stable step is a larger part of that, it cannot pay.
  static constexpr double worth_trying = 0.02;
  static constexpr int trial = 5; // steps that the implicit method has to get going
  static constexpr int first_patience =
      64; // steps before it is tried again, doubled each time up to
  static constexpr int longest_patience = 4096;
  /// Cost of an evaluation with the solves that go with it, in those of an explicit method (measured):
  /// 1.5 where both run alone. But explicit steps are made in packs, where an evaluation costs a third
  /// (20 panels) to a sixth (3) of one alone; and what a run does must not depend on where it is made.
  static constexpr double implicit_cost = 6;

  /// Time integrated per evaluation.
  [[nodiscard]] static double speed(const Mark& from, const Mark& now) {
    return (now.time - from.time) / std::max(now.evaluations - from.evaluations, 1.0);
  }

  [[nodiscard]] bool leave_explicit(double h, const Mark& now, double quickness) {
    held_back_.accepted(true, h, now);
    if (!held_back_.may_leave(h, now.steps)) return false;
    wants_first_ = !measured_;
    if (wants_first_) return false;
    const bool promising = stable_step_ * quickness < worth_trying;
    if (!promising && now.steps < held_back_.last_free.steps + long_enough) {
      held_back_.wait_until = now.steps + pause_;
      pause_ = std::min(2 * pause_, longest_pause);
      return false;
    }
    explicit_speed_ = speed(held_back_.last_free, now);
    active_ = Method::seulex;
    tried_ = 0;
    return true;
  }

  [[nodiscard]] bool leave_implicit(const Mark& now) {
    ++tried_;
    if (tried_ == trial - 2) implicit_from_ = now; // it has found its order and step
    if (tried_ < trial) return false;
    const bool pays = speed(implicit_from_, now) / implicit_cost > explicit_speed_;
    tried_ = trial - 3;
    if (pays) return false;
    active_ = explicit_;
    held_back_.last_free = now;
    held_back_.wait_until = now.steps + patience_;
    patience_ = std::min(2 * patience_, longest_patience);
    return true;
  }

  bool automatic_;
  bool measured_ = true;     ///< ρ is, or nothing bounds it; else that bound is in its place
  bool wants_first_ = false; ///< the bound does not tell
  Method explicit_ = Method::dopri5, active_ = Method::dopri5;
  double stable_step_ = 0, explicit_speed_ = 0;
  long steps_ = 0;
  HeldBackSteps<double> held_back_{}; ///< of the explicit method
  Mark implicit_from_{};              ///< from where the implicit method is measured
  int tried_ = 0, patience_ = first_patience, pause_ = first_pause;
};

/// What a run begins with: where its wing's motion has no series, and where it has.
using FirstChoices = std::array<MethodChoice, 2>;
[[nodiscard]] inline FirstChoices first_choices(const Integration& how) {
  return {MethodChoice(how, false), MethodChoice(how, true)};
}

} // namespace wingspread
