/// Limits steps through the layer |φ̇| < ω_s in which regularized friction changes its sign.
///
/// The friction −τ_c φ̇/√(φ̇² + ω_s²) has its singularities at φ̇ = ±i ω_s. Their distance to a rate is √(φ̇² + ω_s²). A
/// step that takes the rate across zero by many times this distance has few stages in the layer, or none. Its result is
/// wrong, and its error estimate does not show it. A step whose rate changes by at most a few times the least distance
/// samples the layer, and its estimate can be trusted. Such steps form a geometric series towards zero and away from
/// it.
///
/// | symbol | meaning                                                        |       |
/// |--------|----------------------------------------------------------------|-------|
/// | v0, v1 | φ̇ at the step's ends; a: φ̈ at its end                          | rad/s |
/// | d      | least distance: ω_s where v0 v1 < 0, else the ends' smaller one | rad/s |
///
/// A step that leaps over the layer loses about a tenth of the rate that friction changes in it, τ_c h/J (heuristic:
/// a larger share shortens steps without need). Where that is below the tolerance the step may leap.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/wing.hpp"
#include "core/number/over_root.hpp"

#include <cmath>

namespace wingspread {

/// Largest change of a rate in a step, times d. Heuristic: above it the error estimate misses the layer, below it
/// steps through the layer multiply.
inline constexpr double longest_leap = 3;
/// kept_inward: share of a rate that remains after a planned step towards the layer. reach_inside: largest change of
/// the rate near or inside the layer, times ω_s. Both are chosen by measurement, so that few trial steps are rejected.
inline constexpr double kept_inward = 0.35, reach_inside = 1.2;

template <class T> struct LayerLimits {
  T cut;  ///< factor to the next trial step after a step that leaps; > 1 where none does
  T next; ///< largest factor to the next step, from the rates and accelerations at the step's end
};

namespace detail {

/// Largest change towards zero of a rate: down to kept_inward of it far from the layer, into and through the layer
/// near it.
template <class T> [[nodiscard]] T reach_inward(const T& size, const T& slip_rate) {
  const T kept = larger(slip_rate, T(size * T(kept_inward)));
  return select(size > T(longest_leap) * slip_rate, T(size - kept), T(T(reach_inside) * slip_rate));
}

/// √(φ̇² + ω_s²).
template <class T> [[nodiscard]] T from_layer(const T& rate, const T& slip_rate) {
  const T square = fused(rate, rate, slip_rate * slip_rate);
  return over_root(square, square);
}

} // namespace detail

/// Limits after an accepted step. Cost: about twenty operations a hinge.
template <class T>
[[nodiscard]] LayerLimits<T> layer_limits(const Wing<T>& wing, const Layout& at,
                                          const Step<T>& step, const T& rtol, const T& atol) {
  using std::abs;
  LayerLimits<T> limits{T(1e10), T(1e10)};
  for (int i = 1; i <= at.bodies; ++i) {
    const HingeTerms<T>& hinge = wing.hinges[i];
    const int r = at.rate(i);
    const T &v0 = step.x[r], &v1 = step.x1[r], &a = step.dxdt1[r], &slip = hinge.slip_rate;
    const T size0 = abs(v0), size1 = abs(v1), change = abs(v1 - v0);
    const T at_stake = T(0.1) * hinge.most_regularized() * step.h; // N·m·s
    const auto matters =
        at_stake > wing.bodies[i].central_inertia * fused(rtol, larger(size0, size1), atol);
    if (!any(matters)) continue;
    const T from0 = detail::from_layer(v0, slip), from1 = detail::from_layer(v1, slip);
    const auto crosses = v0 * v1 < T(0);
    const T least = select(crosses, slip, smaller(from0, from1));
    const T shorter = select(crosses || from1 < from0, detail::reach_inward(size0, slip),
                             T(T(0.9 * longest_leap) * from0));
    const T cut = larger(T(shorter / larger(change, T(1e-300))), T(0.01));
    limits.cut =
        select(matters && change > T(longest_leap) * least, smaller(limits.cut, cut), limits.cut);
    const T ahead =
        select(v1 * a < T(0), detail::reach_inward(size1, slip), T(T(longest_leap) * from1));
    const T next = ahead / larger(T(abs(a) * step.h), T(1e-300));
    limits.next = select(matters, smaller(limits.next, next), limits.next);
  }
  return limits;
}

} // namespace wingspread
