/// Energy and momentum of a wing: audits of a run, and the projection that keeps a free base's momenta.
///
/// | symbol  | meaning                                              | unit      |
/// |---------|------------------------------------------------------|-----------|
/// | r, v    | position and velocity of a centre of mass            | m, m/s    |
/// | T, P    | kinetic energy, potential                            | J         |
/// | p, L    | momentum Σ m v; angular momentum Σ (m r × v + J ω)    | kg·m/s, kg·m²/s |
///
///     T = ½ Σ (m v² + J ω²)                                                                    (1)
///     P = Σ hinges + Σ loops − Σ m g·r                                                         (2)
#pragma once

#include "core/mechanics/system.hpp"

namespace wingspread {

/// Mass properties and motion of all bodies in inertial axes, relative to the base's origin. The base's own position
/// and velocity are left out, so that a distant or fast spacecraft loses no digits.
template <class T> struct TotalMotion {
  T kinetic = T(0);                 ///< (1), J
  T mass = T(0);                    ///< Σ m, kg
  Vec2<T> first_moment{T(0), T(0)}; ///< Σ m r, kg·m
  T second_moment = T(0);           ///< Σ (m r² + J), kg·m²
  Vec2<T> linear{T(0), T(0)};       ///< Σ m v, kg·m/s
  T angular = T(0);                 ///< Σ (m r × v + J ω), kg·m²/s

  void add(const T& m, const T& inertia, const Vec2<T>& r, const Vec2<T>& v, const T& rate) {
    kinetic = kinetic + T(0.5) * fused(m, dot(v, v), inertia * rate * rate);
    mass = mass + m;
    first_moment = fused(m, r, first_moment);
    second_moment = second_moment + fused(m, dot(r, r), inertia);
    linear = fused(m, v, linear);
    angular = angular + fused(m, dot(turned(r), v), inertia * rate);
  }

  [[nodiscard]] Vec2<T> center() const { return scaled(T(1) / mass, first_moment); }
  /// About the common centre of mass.
  [[nodiscard]] T spin() const { return angular - dot(turned(center()), linear); }
  [[nodiscard]] T central_inertia() const { return second_moment - dot(center(), first_moment); }
  [[nodiscard]] T central_kinetic() const { return kinetic - T(0.5) * dot(linear, linear) / mass; }
};

/// Adds all bodies outward of `parent` to the sum. @param point, velocity of the parent's hinge point
template <class T, class Topology>
void add_outward(const Wing<T>& wing, const Topology& tree, const std::vector<BodyFrame<T>>& frames,
                 int parent, const Vec2<T>& point, const Vec2<T>& velocity, TotalMotion<T>& sum) {
  tree.for_each_child(parent, [&](int i) {
    const BodyFrame<T>& own = frames[i];
    const Vec2<T> hinge = point + own.arm;
    const Vec2<T> hinge_velocity = fused(frames[parent].rate, turned(own.arm), velocity);
    const Vec2<T> g = rotated(own.rotation, wing.bodies[i].center);
    sum.add(wing.bodies[i].mass, wing.bodies[i].central_inertia, hinge + g,
            fused(own.rate, turned(g), hinge_velocity), own.rate);
    add_outward(wing, tree, frames, i, hinge, hinge_velocity, sum);
  });
}

/// Motion of all bodies at (x, t) relative to the base's origin. Places the system. Cost O(n).
template <class T, class Topology, BaseMotion M>
[[nodiscard]] TotalMotion<T> total_motion(System<T, Topology, M>& system, const State<T>& x,
                                          const T& t) {
  system.place_all(x, t);
  const auto& frames = system.work().frames;
  const Vec2<T> origin{T(0), T(0)};
  TotalMotion<T> sum;
  if constexpr (M == BaseMotion::free) {
    const BodyTerms<T>& base = system.wing().bodies[0];
    sum.add(base.mass, base.central_inertia, origin, origin, frames[0].rate);
  }
  add_outward(system.wing(), system.topology(), frames, 0, origin, origin, sum);
  return sum;
}

/// (1) in inertial axes, J.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] T kinetic_energy(System<T, Topology, M>& system, const State<T>& x, const T& t) {
  const TotalMotion<T> now = total_motion(system, x, t);
  const Vec2<T> v = system.base_velocity(x, t);
  return now.kinetic + dot(v, now.linear) + T(0.5) * now.mass * dot(v, v);
}

/// Potential of hinge i, J: spring and harness, zero at the latched angle, stop, engaged latch and
/// elastic hold.
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

/// Invariants of a free system.
template <class T> struct Conserved {
  Vec2<T> start;    ///< the common centre of mass at the start, m
  Vec2<T> velocity; ///< its velocity at the start, m/s
  T spin;           ///< angular momentum about it, kg·m²/s
};

template <class T, class Topology>
[[nodiscard]] Conserved<T> conserved(System<T, Topology, BaseMotion::free>& system,
                                     const State<T>& x, const T& t) {
  const TotalMotion<T> now = total_motion(system, x, t);
  return {Vec2<T>{x[0], x[1]} + now.center(),
          system.base_velocity(x, t) + scaled(T(1) / now.mass, now.linear), now.spin()};
}

/// Restores a free system's invariants at time t: moves the whole system as one rigid body, so that its centre of mass
/// falls freely and the angular momentum about it is conserved. Relative angles and rates stay. The change is as small
/// as the step's own error, so the method keeps its order [projection onto invariants: Hairer, Lubich & Wanner,
/// Geometric Numerical Integration, IV.4].
template <class T, class Topology>
void keep_momentum(System<T, Topology, BaseMotion::free>& system, const Conserved<T>& kept,
                   State<T>& x, const T& t) {
  const TotalMotion<T> now = total_motion(system, x, t);
  const Vec2<T> center = now.center();
  const T rate = (kept.spin - now.spin()) / now.central_inertia();
  const Vec2<T> linear = scaled(T(1) / now.mass, now.linear);
  const Vec2<T> fall = scaled(t, system.wing().base.gravity);
  const Vec2<T> position = fused(t, fused(T(0.5), fall, kept.velocity), kept.start) - center;
  const Vec2<T> velocity = (kept.velocity + fall - linear) - scaled(rate, turned(center));
  const int v = system.layout().freedoms();
  x[0] = position.x, x[1] = position.y;
  x[v] = velocity.x, x[v + 1] = velocity.y, x[v + 2] = x[v + 2] + rate;
}

} // namespace wingspread
