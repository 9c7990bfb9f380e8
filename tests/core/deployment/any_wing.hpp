/// A random wing with anything that a scene may have.
#pragma once

#include "tests/support/closed_forms.hpp"
#include "tests/support/real_scenes.hpp"

namespace wingspread::oracle {

/// A wing of one of two trees with three bodies each. Everything else is drawn: what its hinges and pairs of hinges
/// have, its base, air and gravity.
inline Scene any_wing(std::uint64_t seed) {
  Draws draws(seed);
  RandomScene options;
  options.bodies = 3, options.reach = 0.5;
  Scene scene = random_scene(draws.chance(0.8) ? 40 : 41, options);
  scene.base = {};
  scene.base.motion = static_cast<BaseMotion>(draws.below(3));
  if (scene.base.motion == BaseMotion::free) scene.base.mass = 200, scene.base.inertia = 50;
  if (scene.base.motion == BaseMotion::prescribed) scene.base.rate = 0.05;
  if (draws.chance(0.5)) {
    RealFeatures some;
    some.loops = draws.chance(0.5), some.air = draws.chance(0.5);
    scene = with_real_hinges(scene, seed, some);
  }
  if (scene.base.motion == BaseMotion::prescribed && draws.chance(0.5))
    scene = driven_by_table(scene, seed, 1);
  for (Hinge& hinge : scene.hinges) {
    if (draws.chance(0.1)) hinge.motor = Motor{.rate = 0.2, .gain = 5, .torque_limit = 3};
    if (draws.chance(0.1)) hinge.release = Release{.time = 0.2}, hinge.initial_rate = 0;
    if (draws.chance(0.2)) rub(hinge, 0.1);
    if (draws.chance(0.2)) hinge.latch.reset();
  }
  return scene;
}

} // namespace wingspread::oracle
