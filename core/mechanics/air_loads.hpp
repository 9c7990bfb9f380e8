/// Loads of the air on a wing of plates, as equivalent moments at the hinges and as forces.
///
/// | symbol | meaning                                                     | unit |
/// |--------|-------------------------------------------------------------|------|
/// | F_i    | the air's force on body i and all bodies outward of it      | N    |
/// | L_i    | the moment of these loads about hinge i                     | N·m  |
/// | l_c    | from hinge i to the child hinge c                           | m    |
/// | v      | normal velocity along a plate (core/laws/air.hpp)           | m/s  |
///
///     F_i = own plate + Σ F_c        L_i = own plate + Σ (L_c + l_c × F_c)                     (1)
///
/// By d'Alembert and Lagrange, moments L_i at all hinges move the wing as the loads do. The hinge's force is then
/// the force of the motion less F_i.
#pragma once

#include "core/mechanics/workspace.hpp"

namespace wingspread {

/// Sets `air_moments` and `air_forces` of the workspace by (1); [0] has the sums over the whole wing. Cost O(n).
/// @pre the frames have been placed
/// @param velocity of the base's origin, m/s
template <class T, class Topology>
[[gnu::noinline]] void find_air_loads(const Wing<T>& wing, const Topology& tree,
                                      const BodyFrame<T>* frames, const Vec2<T>& velocity,
                                      Workspace<T>& work) {
  work.velocities[0] = velocity;
  work.air_forces[0] = {T(0), T(0)};
  work.air_moments[0] = T(0);
  tree.outward([&](int i) {
    const int p = tree.parent_of(i);
    const BodyFrame<T>& own = frames[i];
    work.velocities[i] = fused(frames[p].rate, turned(own.arm), work.velocities[p]);
    const PlateTerms<T>& plate = wing.plates[i];
    const Vec2<T> from = rotated(own.rotation, plate.from);
    const Vec2<T> along = rotated(own.rotation, plate.along);
    const Vec2<T> normal = rotated(own.rotation, plate.normal);
    const T v0 = dot(normal, fused(own.rate, turned(from), work.velocities[i]));
    const T v1 = v0 + own.rate * dot(normal, turned(along));
    const PlateIntegrals<T> integrals = plate_integrals(v0, v1);
    work.air_forces[i] = scaled(T(-plate.strength * integrals.first), normal);
    // about the hinge: the force at the first edge, plus its moment along the plate
    work.air_moments[i] = dot(turned(from), work.air_forces[i]) -
                          plate.strength * integrals.second * dot(turned(along), normal);
  });
  tree.inward([&](int i) {
    const int p = tree.parent_of(i);
    work.air_forces[p] = work.air_forces[p] + work.air_forces[i];
    work.air_moments[p] =
        work.air_moments[p] + work.air_moments[i] + dot(turned(frames[i].arm), work.air_forces[i]);
  });
}

} // namespace wingspread
