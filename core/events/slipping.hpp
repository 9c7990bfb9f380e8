/// When exact friction releases a stuck hinge: the instant at which its load passes the static limit.
#pragma once

#include "core/dense/curved_search.hpp"
#include "core/dense/latch_states.hpp"
#include "core/dense/step_interpolant.hpp"
#include "core/events/standstill.hpp"
#include "core/events/stuck_load.hpp"
#include "core/mechanics/system.hpp"

#include <optional>
#include <vector>

namespace wingspread {

/// Relative distance to the static limit within which a hinge is released together with another one. Heuristic:
/// mirrored wings differ by rounding, far below; a larger value releases hinges that hold.
inline constexpr double slip_tolerance = 1e-9;

/// The part of release_margin that is due to loops, N·m. The load of a loop is the small difference of two large
/// numbers. Heuristics: at most 1e-5 of the limit, for a loop does not hold a hinge whose partner is free; at least 1e-13
/// of the loops' stiffness, some hundred times the rounding of an angle of a turn.
template <class AnySystem, class T>
[[nodiscard, gnu::noinline]] T loops_release_margin(const AnySystem& system, const State<T>& x,
                                                    int i, const T& limit) {
  T tied(0); // stiffness and damping of all loops at the hinge
  for (const LoopTerms<T>& loop : system.wing().loops) {
    if (!joins(loop, i)) continue;
    const T on = on_hinge(loop, i, system.state_of(loop, x).gear);
    tied = fused(on * on, T(loop.stiffness + loop.damping), tied);
  }
  return larger(smaller(T(system.work().least_motion * tied), T(T(1e-5) * limit)),
                T(T(1e-13) * tied));
}

/// The excess of friction over its limit from which stuck hinge i is released, N·m. Up to this excess, a released hinge
/// would creep by less than atol, or more slowly than atol. Without this margin rounding would decide, at every step,
/// about a hinge that creeps to the angle at which its load equals the limit (τ_s = τ_c): held by its latch, or by a loop
/// whose other hinge sticks.
/// @param limit static limit of the hinge's friction, N·m
template <class AnySystem, class T>
[[nodiscard]] T release_margin(const AnySystem& system, const State<T>& x, int i, const T& limit) {
  const LinearLaw<T>& law = system.work().laws[i];
  const T own = system.work().least_motion * (law.stiffness + law.damping);
  return system.wing().loops.empty() ? own : T(own + loops_release_margin(system, x, i, limit));
}

/// A release of a stuck hinge inside the step, or a graze: friction that rises so near to its limit, before it falls
/// again, that only a step of the method can decide.
template <class T> struct Slip {
  int hinge;
  T s;     ///< fraction of the step
  T slope; ///< rate of the excess over the limit, N·m/s; may be 0 or less if the step starts beyond it
  bool graze;
};

/// Difference below which two loads of stuck hinge i count as one, N·m. At the default rtol it is a hundredth of the
/// load's integration error.
/// @param limit static limit of the hinge's friction, N·m
template <class T>
[[nodiscard]] T negligible_load(const HeldLoadBound<T>& bound, int i, const T& limit) {
  return T(1e-10) * larger(limit, bound.size(i));
}

/// Whether the friction that holds hinge i may pass its limit in a step, as first_positive decides before its first
/// sample; for a pack: in which lanes.
/// @param bound of the step @param before, after excess over the limit at the step's ends, N·m
/// @param close negligible_load
template <class T>
[[nodiscard]] Truth<T> may_slip(const HeldLoadBound<T>& bound, int i, const T& before,
                                const T& after, const T& close) {
  const T inside =
      detail::rise_inside(detail::Stretch<T>{{T(0), before}, {T(1), after}}, bound.friction(i));
  const T most = larger(before, after);
  return most > T(0) || (most + inside > T(0) && inside > close);
}

/// Finds releases of stuck hinges over a step.
template <class T> class SlipSearch {
public:
  /// Stores the excess of every stuck hinge. @pre the last evaluation was at x, the start of the next step
  template <class AnySystem> void begin_step(const AnySystem& system, const State<T>& x) {
    before_.resize(system.layout().bodies + 1);
    for (int i = 1; i <= system.layout().bodies; ++i)
      before_[i] = system.is_locked(i) ? excess(system, x, i) : T(0);
  }

  /// Excess of every stuck hinge at the start of the step, 1 … n, N·m; for the lane of an engine to write to.
  [[nodiscard]] std::vector<T>& before() { return before_; }

  /// The earliest release in the step, searched on the dense output where neither a standstill nor the load's curvature
  /// excludes it.
  /// @pre the last evaluation was at the step's end, as it is again afterwards if there is none. Overwrites x and dxdt.
  template <class AnySystem>
  [[nodiscard]] std::optional<Slip<T>> first_release(AnySystem& system, const Step<T>& step,
                                                     State<T>& x, State<T>& dxdt) {
    if (!system.wing().can_stick || is_stuck_for_good(system, step.x) || !comes_near(system, step))
      return std::nullopt;
    std::optional<Slip<T>> first;
    for (int i = 1; i <= system.layout().bodies; ++i) {
      const T limit = system.static_limit(step.x, i);
      if (!system.is_locked(i) || !may_exceed(i, limit)) continue;
      const auto evaluate = [&](const T& s) {
        interpolate(system, step, s, x);
        system(x, dxdt, step.t + s * step.h);
      };
      const auto load_at = [&](const T& s) {
        evaluate(s);
        return system.locking_moment(x, i);
      };
      if (holds_easily(load_at, i, limit)) continue;
      const auto excess_at = [&](const T& s) {
        evaluate(s);
        return excess(system, x, i);
      };
      const auto found = slip_of(excess_at, i, limit, step);
      if (found && (!first || found->s < first->s)) first = found;
    }
    if (!first) system(step.x1, dxdt, step.t + step.h);
    return first;
  }

  /// Excess of the friction that holds hinge i over its limit and margin at the last evaluation, which was at x, N·m.
  template <class AnySystem>
  [[nodiscard]] static T excess(const AnySystem& system, const State<T>& x, int i) {
    using std::abs;
    const T limit = system.static_limit(x, i);
    return (abs(system.locking_moment(x, i)) - T(1 + 2 * slip_tolerance) * limit) -
           release_margin(system, x, i, limit);
  }

private:
  /// Whether any hinge that friction locks may pass its limit in the step, by the load as seen from inertial axes and
  /// from its body.
  template <class AnySystem>
  [[nodiscard]] bool comes_near(const AnySystem& system, const Step<T>& step) {
    bound_.over_step(system, step);
    after_.resize(before_.size());
    bool near = false;
    for (int i = 1; i <= system.layout().bodies; ++i) {
      if (!system.is_locked(i)) continue;
      after_[i] = excess(system, step.x1, i);
      const T limit = system.static_limit(step.x, i);
      if (may_exceed(i, limit)) bound_.narrow(system, step, i);
      near = near || may_exceed(i, limit);
    }
    return near;
  }

  /// @param limit static limit of the hinge's friction at the step's start
  [[nodiscard]] bool may_exceed(int i, const T& limit) const {
    return may_slip(bound_, i, before_[i], after_[i], negligible_load(bound_, i, limit));
  }

  /// Whether few samples resolve the load of hinge i, and show it below half of the limit. Samples the load only where the
  /// bound is so wide that halving would take more samples: loads that cancel are far below it. Half and 64 are
  /// heuristics: they choose between two searches.
  template <class Load>
  [[nodiscard]] bool holds_easily(const Load& load, int i, const T& limit) const {
    const T least =
        -larger(before_[i], after_[i]); // by which the load is below the limit at the ends
    if (!(T(2) * least > limit && bound_.most_friction(i) > T(64) * least)) return false;
    StepInterpolant<T> loads;
    const T first = load(T(0)), last = load(T(1));
    loads.begin(load, first, last);
    return loads.resolve(load, negligible_load(bound_, i, limit)) &&
           T(2) * loads.largest_magnitude().value < limit;
  }

  template <class Function>
  [[nodiscard]] std::optional<Slip<T>> slip_of(const Function& excess_at, int i, const T& limit,
                                               const Step<T>& step) {
    // Heuristics. A crest below the limit by less than 0.1 % of the limit and of the load's change over the step counts as
    // a graze: the step's error may hide a release there. Within 2 % of an end the load at that end decides. A graze ends
    // the step at the crest, and the load there decides.
    constexpr double grazes = 1e-3, near_an_end = 0.02;
    Sampled<T> crest{T(0), larger(before_[i], after_[i])};
    const auto rise = [&](const T& a, const T& b) { return bound_.friction(i, a, b); };
    const auto found =
        first_positive(excess_at, before_[i], after_[i], rise, negligible_load(bound_, i, limit),
                       shortest_part(step.t, step.h), crest);
    if (found) return Slip<T>{i, found->s, found->slope / step.h, false};
    const bool inside = crest.s > T(near_an_end) && crest.s < T(1 - near_an_end);
    const T change = crest.value - smaller(before_[i], after_[i]);
    if (inside && crest.value > T(-grazes) * smaller(limit, change))
      return Slip<T>{i, crest.s, T(0), true};
    return std::nullopt;
  }

  HeldLoadBound<T> bound_;
  std::vector<T> after_;
  std::vector<T> before_;
};

} // namespace wingspread
