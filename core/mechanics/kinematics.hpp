/// Kinematics: frames of all bodies from the state [Yudintsev, eq. 2]. No forces. Also the sums of all bodies' masses and
/// motions, and the projection that keeps the momenta of a system on a free base.
///
/// | symbol | meaning                                        | shape | unit        |
/// |--------|------------------------------------------------|-------|-------------|
/// | φ, φ̇   | relative angle and rate of a hinge             |       | rad, rad/s  |
/// | θ, ω   | absolute angle and rate: θ_p + φ, ω_p + φ̇      |       | rad, rad/s  |
/// | l      | from the parent's hinge to the body's own      | 2     | m           |
/// | m g    | mass times the way to the centre of mass       | 2     | kg·m        |
/// | r, v   | position and velocity of a centre of mass      | 2     | m, m/s      |
/// | p, L   | momentum Σ m v; angular Σ (m r × v + J ω)       |       | kg·m/s, kg·m²/s |
/// | T      | kinetic energy ½ Σ (m v² + J ω²)               |       | J           |
#pragma once

#include "core/mechanics/layout.hpp"
#include "core/mechanics/recursion.hpp"

#include <vector>

namespace wingspread {

/// Number of the base's coordinates in q; the hinges' angles follow.
template <BaseMotion M> inline constexpr int base_freedoms = M == BaseMotion::free ? 3 : 0;

/// Sets the base's angle, rate and rotation at (x, t), and the accelerations of a prescribed base.
/// @param piece the table's piece at t; unused without a table
template <BaseMotion M, class T>
[[gnu::always_inline]] inline void place_base(const Wing<T>& wing, const Layout& at,
                                              const DrivenPiece<T>& piece, BodyFrame<T>& base,
                                              const State<T>& x, const T& t) {
  if constexpr (M == BaseMotion::fixed) {
    base.angle = base.rate = base.minus_rate_squared = base.angular_acceleration = T(0);
    base.acceleration = {T(0), T(0)};
    base.rotation = {T(0), T(1)};
    return;
  }
  if constexpr (M == BaseMotion::prescribed) {
    const Drive<T> drive = drive_at(wing.base, piece, t);
    base.rate = drive.rate;
    base.angle = drive.angle;
    base.acceleration = drive.felt;
    base.angular_acceleration = drive.angular_acceleration;
  }
  if constexpr (M == BaseMotion::free) {
    base.angle = x[2];
    base.rate = x[at.freedoms() + 2];
    base.moment = T(0);
    base.mass_moment = {T(0), T(0)};
  }
  base.minus_rate_squared = -(base.rate * base.rate);
  base.rotation = sine_cosine(base.angle);
}

/// Places all other bodies. @pre the base has been placed. Frames: any array of BodyFrame<T>, 0 … n.
template <BaseMotion M, class T, class Topology, class Frames>
[[gnu::always_inline]] inline void place_bodies(const Wing<T>& wing, const Topology& tree,
                                                Frames& frames, const State<T>& x) {
  const T* const angles = x.data() + base_freedoms<M>;
  const T* const rates = angles + base_freedoms<M> + tree.bodies();
  tree.outward([&](int i) __attribute__((always_inline)) {
    turn<M>(tree, frames, i, angles[i - 1], rates[i - 1]);
  });
  tree.outward([&](int i) __attribute__((always_inline)) { place<M>(wing, tree, frames, i); });
}

/// Updates the rates of placed frames on a free base: cheaper than placing them again, if only rates of x have changed.
template <class T, class Topology, class Frames>
[[gnu::always_inline]] inline void set_rates(const Layout& at, const Topology& tree, Frames& frames,
                                             const State<T>& x) {
  frames[0].rate = x[at.freedoms() + 2];
  frames[0].minus_rate_squared = -(frames[0].rate * frames[0].rate);
  tree.outward([&](int i) __attribute__((always_inline)) {
    BodyFrame<T>& own = frames[i];
    own.rate = frames[tree.parent_of(i)].rate + x[at.rate(i)];
    own.minus_rate_squared = -(own.rate * own.rate);
  });
}

/// Mass properties and motion of all bodies in inertial axes, relative to the base's origin. The base's own position
/// and velocity are left out, so that a distant or fast spacecraft loses no digits.
template <class T> struct TotalMotion {
  T kinetic = T(0);                 ///< T, J
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

/// Mass properties and motion of all placed bodies, and of a free base. Cost O(n).
template <BaseMotion M, class T, class Topology>
[[nodiscard]] TotalMotion<T> total_motion_of(const Wing<T>& wing, const Topology& tree,
                                             const std::vector<BodyFrame<T>>& frames) {
  const Vec2<T> origin{T(0), T(0)};
  TotalMotion<T> sum;
  if constexpr (M == BaseMotion::free) {
    const BodyTerms<T>& base = wing.bodies[0];
    sum.add(base.mass, base.central_inertia, origin, origin, frames[0].rate);
  }
  add_outward(wing, tree, frames, 0, origin, origin, sum);
  return sum;
}

/// Invariants of a free system.
template <class T> struct Conserved {
  Vec2<T> start;    ///< the common centre of mass at the start, m
  Vec2<T> velocity; ///< its velocity at the start, m/s
  T spin;           ///< angular momentum about it, kg·m²/s
};

/// Restores a free system's invariants at time t: moves the whole system as one rigid body, so that its centre of mass
/// falls freely and the angular momentum about it is conserved. Relative angles and rates stay. The change is as small
/// as the step's own error, so the method keeps its order [projection onto invariants: Hairer, Lubich & Wanner,
/// Geometric Numerical Integration, IV.4].
/// @param now total motion at x @param gravity m/s²
template <class T>
void keep_momenta(const Conserved<T>& kept, const TotalMotion<T>& now, const Vec2<T>& gravity,
                  const T& t, const Layout& at, State<T>& x) {
  const Vec2<T> center = now.center();
  const T rate = (kept.spin - now.spin()) / now.central_inertia();
  const Vec2<T> linear = scaled(T(1) / now.mass, now.linear);
  const Vec2<T> fall = scaled(t, gravity);
  const Vec2<T> position = fused(t, fused(T(0.5), fall, kept.velocity), kept.start) - center;
  const Vec2<T> velocity = (kept.velocity + fall - linear) - scaled(rate, turned(center));
  const int v = at.freedoms();
  x[0] = position.x, x[1] = position.y;
  x[v] = velocity.x, x[v + 1] = velocity.y, x[v + 2] = x[v + 2] + rate;
}

} // namespace wingspread
