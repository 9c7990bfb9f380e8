/// Energy and momentum of a wing: audits of a run, and the projection that keeps a free base's
/// momenta.
#pragma once

#include "core/system.hpp"

namespace wingspread {

/// Momentum of the whole system, inertial axes.
template <class T> struct Momentum {
  Vec2<T> linear; ///< kg·m/s
  T angular;      ///< about the inertial origin, kg·m²/s
};

/// Mass properties and motion of everything that moves, in inertial axes.
template <class T> struct Motion {
  T kinetic = T(0);                 ///< ½ Σ (m v² + J ω²), J
  T mass = T(0);                    ///< Σ m, kg
  Vec2<T> first_moment{T(0), T(0)}; ///< Σ m r, kg·m
  T second_moment = T(0);           ///< Σ (m r² + J) about the inertial origin, kg·m²
  Momentum<T> momentum{{T(0), T(0)}, T(0)};

  void add(const T& m, const T& inertia, const Vec2<T>& r, const Vec2<T>& v, const T& rate) {
    kinetic = kinetic + T(0.5) * fused(m, dot(v, v), inertia * rate * rate);
    mass = mass + m;
    first_moment = fused(m, r, first_moment);
    second_moment = second_moment + fused(m, dot(r, r), inertia);
    momentum.linear = fused(m, v, momentum.linear);
    momentum.angular = momentum.angular + fused(m, dot(turned(r), v), inertia * rate);
  }
};

/// Adds body i and everything outward of it, from the position and velocity of its parent's hinge
/// point.
template <class T, class Topology>
void add_outward(const Wing<T>& wing, const Topology& tree, const std::vector<BodyFrame<T>>& frames,
                 int parent, const Vec2<T>& point, const Vec2<T>& velocity, Motion<T>& sum) {
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

/// Motion of all bodies at (x, t); places the system there. Cost O(n). A prescribed base's origin
/// is taken to start at rest.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] Motion<T> motion(System<T, Topology, M>& system, const State<T>& x, const T& t) {
  system.place_all(x, t);
  const auto& frames = system.work().frames;
  Motion<T> sum;
  Vec2<T> point{T(0), T(0)}, velocity{T(0), T(0)};
  if constexpr (M == BaseMotion::prescribed) {
    velocity = scaled(t, system.wing().base.acceleration);
    point = scaled(T(0.5) * t, velocity);
  }
  if constexpr (M == BaseMotion::free) {
    const int v = system.layout().freedoms();
    point = {x[0], x[1]}, velocity = {x[v], x[v + 1]};
    sum.add(system.wing().bodies[0].mass, system.wing().bodies[0].central_inertia, point, velocity,
            x[v + 2]);
  }
  add_outward(system.wing(), system.topology(), frames, 0, point, velocity, sum);
  return sum;
}

/// Springs', harnesses' and engaged latches' potential, each zero at its latched angle, J. A
/// smoothed latch counts with the weight it has.
template <class T, class Topology, BaseMotion M>
[[nodiscard]] T potential_energy(const System<T, Topology, M>& system, const State<T>& x) {
  const Layout& at = system.layout();
  T sum(0);
  for (int i = 1; i <= at.bodies; ++i) {
    const T& angle = x[at.angle(i)];
    sum = sum + potential(system.work().laws[i], angle);
    if (at.smoothed) {
      const T y = angle - system.wing().hinges[i].latched;
      sum = sum + T(0.5) * system.wing().hinges[i].stiffness * y * y *
                      smooth_step(x[at.latch(i)] / system.epsilon());
    }
  }
  return sum;
}

/// Gives a free system exactly the momenta it had, by adding a rigid motion of the whole to the
/// base's velocity and rate; relative rates stay. Invariant manifold projection [Hairer, Lubich &
/// Wanner, Geometric Numerical Integration, IV.4]: its size is the step's own error, so the order
/// is kept.
template <class T, class Topology>
void keep_momentum(System<T, Topology, BaseMotion::free>& system, const Momentum<T>& kept,
                   State<T>& x, const T& t) {
  const Motion<T> now = motion(system, x, t);
  const Vec2<T> center = scaled(T(1) / now.mass, now.first_moment);
  const Vec2<T> missing = kept.linear - now.momentum.linear;
  const T missing_about_center =
      (kept.angular - now.momentum.angular) - dot(turned(center), missing);
  const T central_inertia = now.second_moment - now.mass * dot(center, center);
  const T rate = missing_about_center / central_inertia;
  const Vec2<T> from_center = Vec2<T>{x[0], x[1]} - center;
  const Vec2<T> velocity = fused(rate, turned(from_center), scaled(T(1) / now.mass, missing));
  const int v = system.layout().freedoms();
  x[v] = x[v] + velocity.x, x[v + 1] = x[v + 1] + velocity.y, x[v + 2] = x[v + 2] + rate;
}

} // namespace wingspread
