/// Energy and momentum of a wing: audits of a run. The sums over bodies are those of kinematics.hpp.
///
/// | symbol  | meaning                                              | unit      |
/// |---------|------------------------------------------------------|-----------|
/// | r, v    | position and velocity of a centre of mass            | m, m/s    |
/// | T, P    | kinetic energy, potential                            | J         |
///
///     T = ½ Σ (m v² + J ω²)                                                                    (1)
///     P = Σ hinges + Σ loops − Σ m g·r                                                         (2)
#pragma once

#include "core/mechanics/system.hpp"

namespace wingspread {

/// Motion of all bodies at (x, t) relative to the base's origin. Places the system. Cost O(n).
template <class T, class Topology, BaseMotion M>
[[nodiscard]] TotalMotion<T> total_motion(System<T, Topology, M>& system, const State<T>& x,
                                          const T& t) {
  system.place_all(x, t);
  return total_motion_of<M>(system.wing(), system.topology(), system.work().frames);
}

/// (1) in inertial axes, J.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] T kinetic_energy(System<T, Topology, M>& system, const State<T>& x, const T& t) {
  const TotalMotion<T> now = total_motion(system, x, t);
  const Vec2<T> v = system.base_velocity(x, t);
  return now.kinetic + dot(v, now.linear) + T(0.5) * now.mass * dot(v, v);
}

/// Potential of hinge i, J: that of spring and harness, which is zero at the latched angle, and those of stop, engaged
/// latch and elastic hold.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] T hinge_potential(const System<T, Topology, M>& system, const State<T>& x, int i) {
  const T& angle = x[system.layout().angle(i)];
  const Wing<T>& wing = system.wing();
  const LinearLaw<T> open = linear_law(wing.hinges[i], false);
  const T held = system.hold_energy(x, i);
  if (wing.real.empty()) return potential(system.law_without_friction(i), angle) + held;
  const T own = potential(open, angle) +
                real_potential(wing.real[i], wing.hinges[i].latched, angle, system.work().modes[i]);
  return own + system.latch_energy(x, i) + held;
}

/// Energy of a smoothed latch of hinge i at full weight, J; 0 for an event latch.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] T smoothed_latch_energy(const System<T, Topology, M>& system, const State<T>& x,
                                      int i) {
  if (!system.layout().smoothed) return T(0);
  return full_latch_energy(system.wing().hinges[i], x[system.layout().angle(i)]);
}

/// Potential of all loops, J.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] T loops_energy(const System<T, Topology, M>& system, const State<T>& x) {
  T sum(0);
  for (const LoopTerms<T>& loop : system.wing().loops)
    sum = sum + loop_energy(loop, system.state_of(loop, x).elastic);
  return sum;
}

/// −Σ m g·r of all bodies, J; r from the base's origin, or from the inertial origin with a free base. Places the
/// system.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] T gravity_energy(System<T, Topology, M>& system, const State<T>& x, const T& t) {
  const Vec2<T>& g = system.wing().base.gravity;
  if (g.x == T(0) && g.y == T(0)) return T(0);
  const TotalMotion<T> now = total_motion(system, x, t);
  if constexpr (M == BaseMotion::free)
    return -dot(g, fused(now.mass, Vec2<T>{x[0], x[1]}, now.first_moment));
  return -dot(g, now.first_moment);
}

/// (2), J. A smoothed latch counts with its present weight.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] T potential_energy(System<T, Topology, M>& system, const State<T>& x, const T& t) {
  const Layout& at = system.layout();
  T sum = loops_energy(system, x) + gravity_energy(system, x, t);
  for (int i = 1; i <= at.bodies; ++i) {
    sum = sum + hinge_potential(system, x, i);
    if (at.smoothed)
      sum = sum +
            smoothed_latch_energy(system, x, i) * smooth_step(x[at.latch(i)] / system.epsilon());
  }
  return sum;
}

template <class T, class Topology>
[[nodiscard]] Conserved<T> conserved(System<T, Topology, BaseMotion::free>& system,
                                     const State<T>& x, const T& t) {
  const TotalMotion<T> now = total_motion(system, x, t);
  return {Vec2<T>{x[0], x[1]} + now.center(),
          system.base_velocity(x, t) + scaled(T(1) / now.mass, now.linear), now.spin()};
}

} // namespace wingspread
