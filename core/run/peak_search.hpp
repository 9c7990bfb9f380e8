/// The largest moments and forces of a run.
#pragma once

#include "core/events/standstill.hpp"
#include "core/peaks/base_peaks.hpp"
#include "core/peaks/force_peaks.hpp"
#include "core/peaks/locked_samples.hpp"
#include "core/peaks/moment_peaks.hpp"
#include "core/peaks/motor_energy.hpp"
#include "core/peaks/overtravel.hpp"
#include "core/run/underway.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace wingspread {

/// Searches every accepted step for peaks. A peak that the dense output shows inside a step is in doubt, until a step of
/// the method that ends there confirms it.
template <class T, class AnySystem> class PeakSearch {
public:
  explicit PeakSearch(Underway<T, AnySystem>& run) : run_(run) {}

  [[nodiscard]] const std::vector<PeakOf<T>>& moments() const { return moments_; }
  [[nodiscard]] const std::vector<PeakOf<T>>& forces() const { return forces_.peaks; }
  /// For the lane of an engine to write to.
  [[nodiscard]] std::vector<PeakOf<T>>& moments() { return moments_; }
  [[nodiscard]] std::vector<PeakOf<T>>& forces() { return forces_.peaks; }
  /// Peak moments of holds, N·m, by hinge 1 … n; empty without holds or if not asked for.
  [[nodiscard]] const std::vector<PeakOf<T>>& holds() const { return holds_; }
  [[nodiscard]] std::vector<PeakOf<T>>& holds() { return holds_; }
  /// Forces at the start of the step, 1 … n, N; only where forces are asked for.
  [[nodiscard]] std::vector<T>& force_before() { return forces_.before(); }

  /// Furthest turn beyond the stowed angle, 1 … n, rad; zeros if not asked for.
  [[nodiscard]] std::vector<T>& overtravel() { return overtravel_; }
  [[nodiscard]] const std::vector<T>& overtravel() const { return overtravel_; }

  /// Work of motors, J, by hinge 0 … n; empty without motors or if not asked for.
  [[nodiscard]] std::vector<T>& motor_energy() { return motor_energy_; }
  [[nodiscard]] const std::vector<T>& motor_energy() const { return motor_energy_; }

  /// Whether an elastic hold holds a hinge, whose load lanes do not watch.
  [[nodiscard]] bool watches_elastic_hold() const {
    for (int i = 1; i < static_cast<int>(holds_.size()); ++i)
      if (run_.system.is_restrained(i)) return true;
    return false;
  }

  /// How moments, and what rigid holds bear, may rise over a step whose peaks a lane has searched, 1 … n; for the lane
  /// to write to.
  [[nodiscard]] std::vector<Rise>& moments_rise() { return moments_rise_; }
  [[nodiscard]] std::vector<Rise>& holds_rise() { return holds_rise_; }

  /// Moments on stuck hinges at the end of the step searched last, 1 … n, N·m.
  [[nodiscard]] const std::vector<T>& held_at_end() const { return held_at_end_; }

  /// The largest excursions of a free base.
  [[nodiscard]] const BaseExcursion<T>& base() const { return base_; }
  [[nodiscard]] BaseExcursion<T>& base() { return base_; }

  /// A run begins.
  void start() {
    base_.start(run_.at, run_.step.x);
    moments_.assign(run_.at.bodies + 1, {});
    moments_rise_.assign(run_.at.bodies + 1, Rise::inside);
    overtravel_.assign(run_.at.bodies + 1, T(0));
    motor_energy_.assign(run_.goal.motor_energy ? run_.system.wing().motors.size() : 0, T(0));
    holds_.assign(watches_holds() ? run_.at.bodies + 1 : 0, {});
    holds_rise_.assign(holds_.size(), Rise::inside);
    if (run_.goal.peak_force) forces_.start(run_.system, force_worth_a_step());
  }

  /// Raises the peaks to the loads just after an event. @pre the changed right-hand side was last evaluated there
  void include_start() {
    include_moments(run_.step.x, run_.step.t);
    if (run_.goal.peak_force) forces_.sample(run_.system, run_.step.t);
  }

  /// A lane's findings about the peaks of a step.
  struct LaneSearch {
    bool done = false;           ///< it has written moments_rise and holds_rise
    bool forces_may_rise = true; ///< if done
  };

  /// Searches the step just accepted for the largest loads. @pre the last evaluation was at its end
  /// @return the first doubt: the fraction of the step to which the method must make a step
  [[nodiscard]] std::optional<T> first_doubt(const LaneSearch& by_lane) {
    made_inner_steps_ = held_is_bounded_ = false, searched_ = by_lane.done;
    if (run_.system.work().locked > 0) held_at_end_ = run_.system.work().holding;
    hinge_ = hold_ = 0;
    doubt_.reset(), held_at_.reset(), borne_at_.reset(), base_doubt_.reset();
    base_search_ = BaseSearch::none;
    locked_.begin();
    if (is_stuck_for_good(run_.system, run_.step.x)) return std::nullopt; // no load changes
    if (run_.at.base != 0 && (run_.goal.base_motion || run_.goal.to_t_end))
      base_search_ = BaseSearch::turn;
    if (run_.goal.peak_force)
      forces_.over_step(run_.system, run_.step, run_.x, run_.dxdt,
                        !by_lane.done || by_lane.forces_may_rise);
    return next_doubt();
  }

  /// Settles the present doubt: the method has made a step to it, which ends at the run's x. @return the next doubt
  [[nodiscard]] std::optional<T> resolve_doubt() {
    if (base_doubt_) {
      if (base_.confirm(*base_doubt_, run_.at, run_.step, run_.x, run_.dxdt, moment_worth_a_step()))
        return base_doubt_->s;
      base_doubt_.reset();
    } else if (borne_at_)
      confirm_hold();
    else if (held_at_)
      confirm_held_moment();
    else if (!doubt_)
      forces_.confirm(run_.system, run_.step, run_.x, run_.dxdt);
    else if (confirm_moment(*doubt_, moments_[hinge_], run_.system, run_.step, hinge_, run_.x,
                            run_.dxdt, moment_worth_a_step()))
      return doubt_->s;
    return next_doubt();
  }

  /// Raises the peaks to the loads at the step's end, which has moved since they were searched. @pre the last evaluation
  /// was there
  void include_end() {
    const T end = run_.step.t + run_.step.h;
    if (run_.system.work().locked > 0) held_at_end_ = run_.system.work().holding;
    include_moments(run_.step.x1, end);
    if (run_.goal.peak_force) forces_.sample(run_.system, end);
  }

  /// Adds the step, whose end is final, to what is not a load: the ways of a free base, overtravel, the work of motors.
  void close_step() {
    if (base_search_ == BaseSearch::none)
      base_.over_step(run_.at, run_.step);
    else
      (void)base_.raise_by_ends(run_.at, run_.step);         // its inside is searched
    if (is_stuck_for_good(run_.system, run_.step.x)) return; // nothing else changes
    for (int i = 1; run_.goal.overtravel && i <= run_.at.bodies; ++i)
      raise_overtravel(overtravel_[i], run_.system.wing(), run_.at, run_.step, i);
    add_motor_energy(motor_energy_, run_.system, run_.step);
  }

  /// Whether the method has made steps inside the one accepted.
  [[nodiscard]] bool made_inner_steps() const { return made_inner_steps_; }

private:
  /// The relative gain from which another step to the maximum of a force is worth making. Only the
  /// steps of extrapolation are so long that the dense output misplaces the maximum.
  [[nodiscard]] double force_worth_a_step() const {
    return run_.how.method == "bulirsch_stoer" ? std::max(1e-12, run_.how.rtol) : 1;
  }

  /// The same of a moment: a thousandth of the tolerance, and well above rounding.
  [[nodiscard]] double moment_worth_a_step() const { return std::max(1e-12, 1e-3 * run_.how.rtol); }

  /// Raises the peaks of moments and holds to those at x and t. @pre the last evaluation was there
  void include_moments(const State<T>& x, const T& t) {
    using std::abs;
    for (int i = 1; run_.goal.peak_moment && i <= run_.at.bodies; ++i)
      moments_[i].raise(T(abs(run_.system.moment(x, i))), t);
    for (int i = 1; i < static_cast<int>(holds_.size()); ++i)
      if (run_.system.is_held(i) || run_.system.is_restrained(i))
        holds_[i].raise(T(abs(load_of_hold(x, i))), t);
  }

  [[nodiscard]] bool watches_holds() const {
    return run_.goal.hold_moment && !run_.system.wing().releases.empty();
  }

  /// Forces first, then the moments of hinge after hinge, then what holds bear, then a free base's turn and rate.
  [[nodiscard]] std::optional<T> next_doubt() {
    std::optional<T> s;
    if (run_.goal.peak_force) s = forces_.doubtful();
    while (!s && run_.goal.peak_moment && ++hinge_ <= run_.at.bodies)
      s = doubtful_moment(searched_ ? moments_rise_[hinge_] : Rise::inside);
    while (!s && ++hold_ < static_cast<int>(holds_.size())) s = doubtful_hold();
    if (!s && base_search_ == BaseSearch::turn) s = doubtful_base(BaseSearch::rate);
    if (!s && base_search_ == BaseSearch::rate) s = doubtful_base(BaseSearch::done);
    made_inner_steps_ = made_inner_steps_ || s;
    return s;
  }

  /// The loads of locked hinges at the fraction s of the step.
  [[nodiscard]] const typename LockedSamples<T>::Sample& locked_at(const T& s) {
    return locked_.at(s, run_.system, !holds_.empty(), [this](const T& place) -> const State<T>& {
      return run_.evaluate_at(place);
    });
  }

  /// The bound on the loads of locked hinges over the step.
  [[nodiscard]] HeldLoadBound<T>& bound_of_held() {
    if (!held_is_bounded_) held_.over_step(run_.system, run_.step);
    held_is_bounded_ = true;
    return held_;
  }

  [[nodiscard]] std::optional<T> doubtful_moment(Rise rise) {
    PeakOf<T>& peak = moments_[hinge_];
    if (rise == Rise::none) return std::nullopt;
    if (run_.system.is_locked(hinge_)) {
      const HeldMoments<T> ends{run_.held_before[hinge_], held_at_end_[hinge_]};
      if (rise == Rise::to_ends) {
        raise_to_ends(peak, ends, run_.step);
        return std::nullopt;
      }
      const auto load = [this](const T& s) { return locked_at(s).moments[hinge_]; };
      const auto bound = [this]() -> HeldLoadBound<T>& { return bound_of_held(); };
      held_at_ = raise_held_moment(peak, run_.system, run_.step, hinge_, ends, bound, load);
      return held_at_;
    }
    if (rise == Rise::to_ends) {
      raise_to_ends(peak, MomentOverStep<T, AnySystem>(run_.system, run_.step, hinge_), run_.step);
      return std::nullopt;
    }
    doubt_ = raise_moment(peak, run_.system, run_.step, hinge_);
    if (!doubt_) return std::nullopt;
    return doubt_->s;
  }

  /// Searches the moment of hold `hold_`: the locking moment less the hinge's own laws.
  [[nodiscard]] std::optional<T> doubtful_hold() {
    if (run_.system.is_restrained(hold_)) return doubtful_elastic_hold();
    if (!run_.system.is_held(hold_)) return std::nullopt;
    const Step<T>& step = run_.step;
    const HeldMoments<T> ends{run_.held_before[hold_] - run_.system.sliding_moment(step.x, hold_),
                              held_at_end_[hold_] - run_.system.sliding_moment(step.x1, hold_)};
    PeakOf<T>& peak = holds_[hold_];
    if (searched_ && holds_rise_[hold_] == Rise::to_ends) {
      raise_to_ends(peak, ends, step);
      return std::nullopt;
    }
    const auto load = [this](const T& s) { return locked_at(s).borne[hold_]; };
    HeldLoadBound<T>& bound = bound_of_held();
    const T close = negligible(peak, bound, hold_);
    const auto rise = [&] { return Bulge<T>{bound.most_friction(hold_)}; };
    narrow_if_needed(bound, run_.system, step, hold_, ends, rise(), peak, close);
    borne_at_ =
        raise_locked_load(peak, step, ends, rise(), close, run_.system.wing().loops.empty(), load);
    return borne_at_;
  }

  /// Moment of the hold of hinge i at x, N·m. @pre the last evaluation was there
  [[nodiscard]] T load_of_hold(const State<T>& x, int i) const {
    return run_.system.is_restrained(i) ? run_.system.elastic_hold(x, i)
                                        : run_.system.locking_moment(x, i);
  }

  /// As doubtful_hold, for an elastic hold. Its moment is linear in angle and rate, so the hull bounds it.
  [[nodiscard]] std::optional<T> doubtful_elastic_hold() {
    using std::abs;
    const Step<T>& step = run_.step;
    const ReleaseTerms<T>& hold = run_.system.wing().releases[hold_];
    const Quintic<T> angle = step.coordinate(run_.at.angle(hold_), run_.at.freedoms());
    const Quintic<T> rate = step.rate(run_.at.angle(hold_), run_.at.freedoms());
    Quintic<T> load;
    for (int k = 0; k < 6; ++k)
      load[k] = fused(hold.stiffness, angle[k] - run_.system.wing().hinges[hold_].stowed,
                      hold.damping * rate[k]);
    PeakOf<T>& peak = holds_[hold_];
    if (!(bound(load) > peak.value)) return std::nullopt;
    PeakOf<T> candidate = peak;
    raise_by_interpolant(
        candidate, [&](const T& s) { return value(load, s); }, step);
    peak.raise(T(abs(load[0])), step.t), peak.raise(T(abs(load[5])), step.t + step.h);
    if (!(candidate.value > peak.value)) return std::nullopt;
    const T s = (candidate.time - step.t) / step.h;
    if (s < T(next_to_an_end) || s > T(1 - next_to_an_end)) {
      peak = candidate;
      return std::nullopt;
    }
    borne_at_ = s;
    return borne_at_;
  }

  /// The part of a free base's motion that is searched next over the step.
  enum class BaseSearch { none, turn, rate, done };

  /// Searches the present part. @param next the part after it
  [[nodiscard]] std::optional<T> doubtful_base(BaseSearch next) {
    base_doubt_ = base_.doubtful(run_.at, run_.step, base_search_ == BaseSearch::rate);
    base_search_ = next;
    if (!base_doubt_) return std::nullopt;
    return base_doubt_->s;
  }

  void confirm_hold() {
    using std::abs;
    holds_[hold_].raise(T(abs(load_of_hold(run_.x, hold_))),
                        run_.step.t + *borne_at_ * run_.step.h);
    borne_at_.reset();
  }

  void confirm_held_moment() {
    using std::abs;
    moments_[hinge_].raise(T(abs(run_.system.moment(run_.x, hinge_))),
                           run_.step.t + *held_at_ * run_.step.h);
    held_at_.reset();
  }

  Underway<T, AnySystem>& run_;
  std::vector<PeakOf<T>> moments_; ///< 1 … n
  std::vector<PeakOf<T>> holds_;   ///< 1 … n
  std::vector<T> overtravel_;      ///< 1 … n
  std::vector<T> motor_energy_;    ///< 0 … n
  BaseExcursion<T> base_;
  ForcePeaks<T, AnySystem> forces_;
  int hinge_ = 0;                          ///< the hinge searched for moment peaks
  std::optional<DoubtfulMoment<T>> doubt_; ///< of its moment; none while forces are in doubt
  HeldLoadBound<T> held_;                  ///< see bound_of_held
  bool held_is_bounded_ = false;           ///< over the step searched
  LockedSamples<T> locked_;
  std::vector<T> held_at_end_; ///< 1 … n: moments on stuck hinges at the step's end
  std::optional<T> held_at_;   ///< where the moment of a stuck hinge is in doubt
  int hold_ = 0;               ///< the hold searched
  std::optional<T> borne_at_;  ///< where its load is in doubt
  BaseSearch base_search_ =
      BaseSearch::none; ///< none: the step is not searched for the base's motion
  std::optional<typename BaseExcursion<T>::Doubt> base_doubt_;
  bool made_inner_steps_ = false;
  bool searched_ = false;                       ///< a lane has searched the peaks of the step
  std::vector<Rise> moments_rise_, holds_rise_; ///< 1 … n: if so, how they may rise over it
};

} // namespace wingspread
