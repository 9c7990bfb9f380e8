/// Proof that no peak can be exceeded any more, so that a run may stop.
///
/// After the last latch every hinge is a spring and a damper about its own rest, and the energy
///
///     E = T + Σ ½ κ_i (y_i − y*_i)²,    y* = drive/κ (1)
///
/// never grows on a base that is fixed or free (for a free one T is taken about the common centre
/// of mass, whose energy is constant). With T ≥ ½ Σ J ω² alone, by Cauchy and Schwarz,
///
///     φ̇_i² ≤ 2 T σ_i,    σ_i = 1/J_i + 1/J_p  (1/J_p = 0 on a fixed base) (2) |M_i| ≤ √(2E) √(κ_i
///     + δ_i² σ_i) + τ_s                                                    (3)
///
/// For the reaction, Gauss's principle: the true accelerations minimise Σ m r̈² + Σ J (ω̇ − L/J)²
/// over those that the hinges allow, L the net hinge moment on each body; comparing with φ̈ = 0,
/// whose r̈ = γ is centripetal,
///
///     Σ m r̈² ≤ Z := Σ m γ² + Σ L²/J,    |Y_i| ≤ √(m outward of i) √Z                          (4)
///
/// γ being bounded along each path with ω² ≤ 2E/J, and L by (3). All hold at every angle.
#pragma once

#include "core/energy.hpp"

#include <optional>
#include <vector>

namespace wingspread {

/// Energy (1) above rest. None where the proof does not apply: a base that is driven, a hinge
/// without an engaged latch, or a latch softer than its spring is steep.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] std::optional<T> energy_above_rest(System<T, Topology, M>& system, const State<T>& x,
                                                 const T& t) {
  if constexpr (M == BaseMotion::prescribed) return std::nullopt;
  const Layout& at = system.layout();
  T energy(0);
  for (int i = 1; i <= at.bodies; ++i) {
    const LinearLaw<T> law = linear_law(system.wing().hinges[i], true);
    const bool holds = system.wing().hinges[i].has_latch && system.work().engaged[i] &&
                       law.stiffness > T(0) && (!at.smoothed || x[at.latch(i)] >= system.epsilon());
    if (!holds) return std::nullopt;
    const T y = x[at.angle(i)] - law.latched - law.drive / law.stiffness;
    energy = energy + T(0.5) * law.stiffness * y * y;
  }
  const Motion<T> now = motion(system, x, t);
  energy = energy + (M == BaseMotion::free ? now.central_kinetic() : now.kinetic);
  return energy + T(64 * epsilon_of<T>) * now.kinetic; // what the difference may have lost
}

/// Bounds on what every hinge will see from now on.
template <class T> struct Bounds {
  std::vector<T> moment;                         ///< 1 … n, N·m
  std::vector<T> force;                          ///< 1 … n, N
  std::vector<T> net, hinge_gamma, outward_mass; ///< scratch
};

/// (2)-(4) for an energy above rest. Cost O(n).
template <class T, class Topology, BaseMotion M>
void bound_peaks(const System<T, Topology, M>& system, const T& energy, Bounds<T>& bounds) {
  using std::sqrt;
  const Wing<T>& wing = system.wing();
  const int n = system.layout().bodies;
  bounds.moment.assign(n + 1, T(0));
  bounds.force.assign(n + 1, T(0));
  std::vector<T>&moment = bounds.moment, &force = bounds.force;
  std::vector<T>&net = bounds.net, &hinge_gamma = bounds.hinge_gamma,
  &outward_mass = bounds.outward_mass;
  for (std::vector<T>* v : {&net, &hinge_gamma, &outward_mass}) v->assign(n + 1, T(0));
  T Z(0);
  const auto spin = [&](int i) { // bound on ω_i²
    return i == 0 && M == BaseMotion::fixed ? T(0) : T(2) * energy / wing.bodies[i].central_inertia;
  };
  for (int i = 1; i <= n; ++i) {
    const int p = wing.tree.parent_of(i);
    const LinearLaw<T> law = linear_law(wing.hinges[i], true);
    T sigma = T(1) / wing.bodies[i].central_inertia;
    if (p != 0 || M == BaseMotion::free) sigma = sigma + T(1) / wing.bodies[p].central_inertia;
    moment[i] = sqrt(T(2) * energy * fused(law.damping * law.damping, sigma, law.stiffness)) +
                wing.hinges[i].coulomb + wing.hinges[i].limit;
    // what y* adds: the moment at rest is zero by (1), so nothing
    net[i] = net[i] + moment[i];
    net[p] = net[p] + moment[i];
    hinge_gamma[i] = hinge_gamma[p] + spin(p) * sqrt(dot(wing.bodies[i].arm, wing.bodies[i].arm));
    const Vec2<T>& g = wing.bodies[i].center;
    const T gamma = hinge_gamma[i] + spin(i) * sqrt(dot(g, g));
    Z = fused(wing.bodies[i].mass, gamma * gamma, Z);
  }
  for (int i = n; i >= 1; --i) {
    outward_mass[i] = outward_mass[i] + wing.bodies[i].mass;
    outward_mass[wing.tree.parent_of(i)] = outward_mass[wing.tree.parent_of(i)] + outward_mass[i];
    Z = Z + net[i] * net[i] / wing.bodies[i].central_inertia;
  }
  if (M == BaseMotion::free) Z = Z + net[0] * net[0] / wing.bodies[0].central_inertia;
  for (int i = 1; i <= n; ++i) force[i] = sqrt(outward_mass[i] * Z);
}

} // namespace wingspread
