/// Proof by energy that no hinge can reach its latch any more. Proof by standstill: core/events/standstill.hpp.
///
/// For hinge i to reach its latch, the kinetic energy T and what all springs can still give must
/// pay for the friction on its way:
///
///     T + g_i + Σ_{j≠i} G_j ≥ 0                                                            (1)
///     g_i = P_i(φ_i) − P_i(latched) − τ_i |φ_latched − φ_i|                                (2)
///     G_j = max over φ of  P_j(φ_j) − P_j(φ) − τ_j |φ − φ_j|   ≥ 0                         (3)
///
/// P is the potential of spring, harness and engaged latch; beyond the latched angle it includes the
/// latch, which can only take energy. τ is the kinetic level of exact friction. For regularized
/// friction τ is 0: such a hinge may creep at no cost. On a free base T is taken about the common
/// centre of mass. A held hinge does not move, and gives nothing. Where (1) fails for every open hinge that is not
/// held, none will ever latch.
#pragma once

#include "core/mechanics/energy.hpp"

#include <limits>
#include <optional>

namespace wingspread {

namespace detail {

/// The least ½κy² + cy over [lower, upper]; −∞ where there is none.
template <class T>
[[nodiscard]] T least(const T& kappa, const T& c, const T& lower, const T& upper) {
  const T infinity = std::numeric_limits<T>::infinity();
  const auto at = [&](const T& y) {
    if (is_finite(y)) return T(y * fused(T(0.5) * kappa, y, c));
    const T lead = kappa != T(0) ? kappa : (y > T(0) ? c : T(-c));
    return lead > T(0) ? infinity : lead < T(0) ? T(-infinity) : T(0);
  };
  T best = smaller(at(lower), at(upper));
  if (kappa > T(0)) best = smaller(best, at(smaller(larger(T(-c / kappa), lower), upper)));
  return best;
}

/// (3) for hinge j.
template <class T>
[[nodiscard]] T most_given(const HingeTerms<T>& hinge, bool engaged, const T& angle) {
  const T infinity = std::numeric_limits<T>::infinity();
  const T y = hinge.sense * (angle - hinge.latched); // < 0 before the latch
  const LinearLaw<T> open = linear_law(hinge, engaged);
  const LinearLaw<T> beyond = linear_law(hinge, engaged || hinge.has_latch);
  const T drive = hinge.sense * open.drive, tau = hinge.kinetic_friction;
  // the least P + τ|y' − y|, over y' behind y, between y and the latch, and beyond the latch
  T best = least(open.stiffness, T(-drive - tau), T(-infinity), y) + tau * y;
  const T gate = larger(y, T(0));
  if (y < T(0)) best = smaller(best, T(least(open.stiffness, T(tau - drive), y, T(0)) - tau * y));
  best = smaller(best, T(least(beyond.stiffness, T(tau - drive), gate, infinity) - tau * y));
  return potential(open, angle) - best;
}

/// g_i of (2), J: what the spring of hinge i gives on the way to the latch, less friction. The latched angle has P = 0.
template <class T> [[nodiscard]] T given_to_latch(const HingeTerms<T>& hinge, const T& angle) {
  using std::abs;
  return potential(linear_law(hinge, false), angle) -
         hinge.kinetic_friction * abs(angle - hinge.latched);
}

/// Whether the springs alone pay for the way of an open hinge to its latch: (1) holds with T = 0.
template <class AnySystem, class T>
[[nodiscard]] bool springs_reach_a_latch(const AnySystem& system, const State<T>& x) {
  const Layout& at = system.layout();
  T all(0);
  for (int i = 1; i <= at.bodies; ++i)
    if (!system.is_held(i))
      all = all + most_given(system.wing().hinges[i], system.work().engaged[i], x[at.angle(i)]);
  for (int i = 1; i <= at.bodies; ++i) {
    const HingeTerms<T>& hinge = system.wing().hinges[i];
    if (!hinge.has_latch || system.work().engaged[i] || system.is_held(i)) continue;
    const T &angle = x[at.angle(i)], others = all - most_given(hinge, false, angle);
    if (!(others + given_to_latch(hinge, angle) < T(0))) return true;
  }
  return false;
}

} // namespace detail

/// Whether (1) is necessary for a latch to engage on this wing now. It is not with a driven base, smoothed latches,
/// real hinges, loops, motors, elastic holds, or plates on a free base: these may add energy.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] bool energy_bound_holds(const System<T, Topology, M>& system) {
  if (M == BaseMotion::prescribed || system.layout().smoothed || system.wing().is_real())
    return false;
  for (int i = 1; i <= system.layout().bodies; ++i)
    if (system.is_restrained(i)) return false;
  return M != BaseMotion::free || system.wing().plates.empty();
}

/// Proves by (1) that no open hinge will latch while holds keep theirs. Cost O(n).
/// @return the least energy that an open hinge lacks to reach its latch, J, > 0. None without a proof:
///         a hinge may reach its latch, none is open, or energy_bound_holds is false
template <class T, class Topology, BaseMotion M>
[[nodiscard]] std::optional<T> energy_missing(System<T, Topology, M>& system, const State<T>& x,
                                              const T& t) {
  const Layout& at = system.layout();
  if (!energy_bound_holds(system)) return std::nullopt;
  if (detail::springs_reach_a_latch(system, x)) return std::nullopt; // most attempts end here
  using std::abs;
  const TotalMotion<T> now = total_motion(system, x, t);
  T budget = M == BaseMotion::free ? now.central_kinetic() : now.kinetic;
  T scale = now.kinetic;
  for (int i = 1; i <= at.bodies; ++i) {
    if (system.is_held(i)) continue;
    const T given =
        detail::most_given(system.wing().hinges[i], system.work().engaged[i], x[at.angle(i)]);
    budget = budget + given;
    scale = scale + abs(given);
  }
  if (!is_finite(budget)) return std::nullopt;
  std::optional<T> least;
  for (int i = 1; i <= at.bodies; ++i) {
    const HingeTerms<T>& hinge = system.wing().hinges[i];
    if (!hinge.has_latch || system.work().engaged[i] || system.is_held(i)) continue;
    const T own = detail::most_given(hinge, false, x[at.angle(i)]);
    const T to_latch = detail::given_to_latch(hinge, x[at.angle(i)]);
    const T missing = -(budget - own + to_latch);
    const T rounding = T(1e-9) * (scale + abs(to_latch)); // far more than O(n) operations lose
    if (!(missing > rounding)) return std::nullopt;
    least = least ? smaller(*least, missing) : missing;
  }
  return least;
}

} // namespace wingspread
