/// Kinematics: frames of all bodies from the state [Yudintsev, eq. 2]. No forces.
///
/// | symbol | meaning                                        | shape | unit        |
/// |--------|------------------------------------------------|-------|-------------|
/// | φ, φ̇   | relative angle and rate of a hinge             |       | rad, rad/s  |
/// | θ, ω   | absolute angle and rate: θ_p + φ, ω_p + φ̇      |       | rad, rad/s  |
/// | l      | from the parent's hinge to the body's own      | 2     | m           |
/// | m g    | mass times the way to the centre of mass       | 2     | kg·m        |
#pragma once

#include "core/mechanics/layout.hpp"
#include "core/mechanics/recursion.hpp"

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

} // namespace wingspread
