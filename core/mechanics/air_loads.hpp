/// What the air does to a wing of plates: as moments at the hinges that give the same motion, and as
/// forces that the hinges need not bring up.
///
/// The air's loads on body i and on all outward of it come to a force F_i and a moment L_i about
/// hinge i. By d'Alembert and Lagrange a moment L_i at every hinge i moves the wing as the loads do;
/// the hinge's force is then that of the motion, less F_i.
#pragma once

#include "core/mechanics/workspace.hpp"

namespace wingspread {

/// Sets `air_moments` and `air_forces` of the workspace, of the base as a whole in [0]. The bodies'
/// frames have been placed. Cost O(n).
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
    const PlateLoad<T> load = plate_load(v0, v1);
    work.air_forces[i] = scaled(T(-plate.strength * load.force), normal);
    // about the hinge: through the first edge, and what is further along
    work.air_moments[i] = dot(turned(from), work.air_forces[i]) -
                          plate.strength * load.moment * dot(turned(along), normal);
  });
  tree.inward([&](int i) {
    const int p = tree.parent_of(i);
    work.air_forces[p] = work.air_forces[p] + work.air_forces[i];
    work.air_moments[p] =
        work.air_moments[p] + work.air_moments[i] + dot(turned(frames[i].arm), work.air_forces[i]);
  });
}

} // namespace wingspread
