/// When exact friction releases a stuck hinge: the instant at which its load passes the static limit.
#pragma once

#include "core/dense/curved_search.hpp"
#include "core/dense/step.hpp"
#include "core/events/held_load.hpp"
#include "core/mechanics/linear_solve.hpp"
#include "core/mechanics/system.hpp"

#include <cmath>
#include <optional>
#include <vector>

namespace wingspread {

/// Relative distance to the static limit within which a hinge is released together with another one. Heuristic:
/// mirrored wings differ by rounding, far below; a larger value releases hinges that hold.
inline constexpr double release_tolerance = 1e-9;

namespace detail {

/// Stiffness against a turn of stuck hinge i, N·m/rad. A loop adds its own in series with that of its other hinge.
template <class T, class AnySystem>
[[nodiscard]] T stiffness_at(const AnySystem& system, const State<T>& x, int i) {
  T stiffness = resistance(system, x, i).stiffness;
  for (const LoopTerms<T>& loop : system.wing().loops) {
    if (!joins(loop, i)) continue;
    const int other = loop.first == i ? loop.second : loop.first;
    const LoopState<T> state = system.state_of(loop, x);
    const T taut = taut_share(loop, state.elastic) * loop.stiffness;
    const T here = on_hinge(loop, i, state.gear), there = on_hinge(loop, other, state.gear);
    const T behind = resistance(system, x, other).stiffness, across = taut * there * there;
    if (system.sticks(other))
      stiffness = fused(taut * here, here, stiffness);
    else if (behind > T(0))
      stiffness = fused(taut * here, here * behind / (behind + across), stiffness);
  }
  return stiffness;
}

} // namespace detail

/// The largest excess of a stuck hinge's load over its limit that the run's tolerances do not resolve, N·m:
///
///     min( κ tol(φ), max(δ, √(κ J)) tol(φ̇) )                                                  (1)
///
/// An excess e that is not released displaces the hinge by e/κ from where it would stand, and takes at most the rate
/// e/max(δ, √(κ J)) from it: both are within the tolerance of a step. κ and δ are stiffness and damping at the hinge;
/// J, the least inertia against its turn, is that of its two bodies side by side (spectral_radius.hpp, (2)). Where
/// κ is 0, nothing brings the hinge back, and (1) is 0.
///
/// An overdamped latch needs this: its hinge creeps to |load| = τ_c. With τ_s = τ_c rounding would release it at
/// every step. A hinge released by (1) creeps for some δ/κ before it sticks again.
template <class T, class AnySystem>
[[nodiscard]] T unresolved_load(const AnySystem& system, const State<T>& x, int i) {
  using std::abs, std::sqrt;
  const Workspace<T>& work = system.work();
  const T stiffness = detail::stiffness_at(system, x, i);
  if (!(stiffness > T(0))) return T(0);
  const int parent = system.topology().parent_of(i);
  const bool parent_turns = parent > 0 || system.base_motion == BaseMotion::free;
  const T own = system.wing().bodies[i].central_inertia;
  const T parents = system.wing().bodies[parent].central_inertia;
  const T inertia = parent_turns ? own * parents / (own + parents) : own;
  const T resistance_to_rate =
      larger(resistance(system, x, i).damping, T(sqrt(stiffness * inertia)));
  const T of_angle = fused(work.rtol, T(abs(x[system.layout().angle(i)])), work.atol);
  return smaller(T(stiffness * of_angle), T(resistance_to_rate * work.atol));
}

/// A release of a stuck hinge inside the step; or a graze: friction that comes so near its limit and falls again
/// that only a step of the method can decide.
template <class T> struct Release {
  int hinge;
  T s;     ///< fraction of the step
  T slope; ///< rate of the excess over the limit, N·m/s; 0 for a graze
};

/// Finds releases of stuck hinges over a step.
template <class T> class Holding {
public:
  /// Starts a run: restores the budget of samples.
  void start() { samples_.renew(); }

  /// Stores the excess of every stuck hinge. @pre the last evaluation was at x, the start of the next step
  template <class AnySystem> void begin_step(const AnySystem& system, const State<T>& x) {
    before_.resize(system.layout().bodies + 1);
    for (int i = 1; i <= system.layout().bodies; ++i)
      before_[i] = system.sticks(i) ? excess(system, x, i) : T(0);
  }

  /// The earliest release in the step, searched on the dense output where the load's curvature does not exclude it.
  /// @pre the last evaluation was at the step's end, as it is again afterwards. Overwrites x and dxdt.
  template <class AnySystem>
  [[nodiscard]] std::optional<Release<T>> first_release(AnySystem& system, const Step<T>& step,
                                                        State<T>& x, State<T>& dxdt) {
    samples_.refill(static_cast<double>(step.h));
    if (!comes_near(system, step)) return std::nullopt;
    std::optional<Release<T>> first;
    for (int i = 1; i <= system.layout().bodies; ++i) {
      if (!system.sticks(i) || !may_exceed(i)) continue;
      const auto excess_at = [&](const T& s) {
        step.interpolate(system.layout(), s, x);
        system(x, dxdt, step.t + s * step.h);
        return excess(system, x, i);
      };
      const auto found = release_of(excess_at, i, system.static_limit(step.x, i), step.h);
      if (found && (!first || found->s < first->s)) first = found;
    }
    system(step.x1, dxdt, step.t + step.h);
    return first;
  }

  /// Whether the last step's search ran out of samples. If so, it may have missed a release.
  [[nodiscard]] bool in_vain() const { return samples_.is_spent(); }

  /// Excess of the friction that holds hinge i over its limit and unresolved_load, at the last evaluation, which was at x,
  /// N·m.
  template <class AnySystem>
  [[nodiscard]] static T excess(const AnySystem& system, const State<T>& x, int i) {
    using std::abs;
    return abs(system.holding_friction(x, i)) - fused(T(1 + 2 * release_tolerance),
                                                      system.static_limit(x, i),
                                                      unresolved_load(system, x, i));
  }

private:
  /// Whether any stuck hinge may pass its limit in the step.
  template <class AnySystem>
  [[nodiscard]] bool comes_near(const AnySystem& system, const Step<T>& step) {
    bound_.over_step(system, step);
    after_.resize(before_.size());
    bool near = false;
    for (int i = 1; i <= system.layout().bodies; ++i) {
      if (!system.sticks(i)) continue;
      after_[i] = excess(system, step.x1, i);
      near = near || may_exceed(i);
    }
    return near;
  }

  [[nodiscard]] bool may_exceed(int i) const {
    return larger(before_[i], after_[i]) + bound_.friction(i, T(0), T(1)).most > T(0);
  }

  template <class Function>
  [[nodiscard]] std::optional<Release<T>> release_of(const Function& excess_at, int i,
                                                     const T& limit, const T& h) {
    constexpr double grazes = 1e-3, width = 1e-3;
    Sampled<T> crest{T(0), larger(before_[i], after_[i])};
    const auto rise = [&](const T& a, const T& b) { return bound_.friction(i, a, b); };
    const auto s =
        first_positive(excess_at, before_[i], after_[i], rise, T(1e-10) * limit, crest, samples_);
    if (s) {
      const T slope = (excess_at(T(*s + width)) - excess_at(T(*s - width))) / (T(2 * width) * h);
      return Release<T>{i, *s, slope};
    }
    const bool inside = crest.s > T(0.02) && crest.s < T(0.98);
    const T change = crest.value - smaller(before_[i], after_[i]);
    if (inside && crest.value > T(-grazes) * smaller(limit, change))
      return Release<T>{i, crest.s, T(0)};
    return std::nullopt;
  }

  HeldLoadBound<T> bound_;
  SampleBudget samples_;
  std::vector<T> after_;
  std::vector<T> before_;
};

} // namespace wingspread
