// A Deployment keeps storage from run to run, and nothing else.
#include "core/deployment.hpp"
#include "tests/core/packs/same_bits.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("a run does not know that the one before it ended with every hinge stuck") {
  Scene held = oracle::seed_scene(), loose = oracle::seed_scene();
  for (Hinge& hinge : held.hinges) oracle::rub(hinge, 1e3);
  for (Hinge& hinge : loose.hinges) oracle::rub(hinge, 0.01);
  Deployment kept;
  REQUIRE(kept.run(held, {}, {}).status == Status::stalled);
  const Outcome after = kept.run(loose, {}, {}), alone = Deployment().run(loose, {}, {});
  CHECK(after.status == Status::deployed);
  CHECK(after.t_end == alone.t_end);
  CHECK(after.work.rhs_evaluations == alone.work.rhs_evaluations);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(after.peak_moment[i].value == alone.peak_moment[i].value);
}

namespace {

/// A wing of one of two trees with three bodies each. Everything else is drawn: what its hinges and pairs of hinges
/// have, its base, air and gravity.
Scene any_wing(std::uint64_t seed) {
  oracle::Draws draws(seed);
  oracle::RandomScene options;
  options.bodies = 3, options.reach = 0.5;
  Scene scene = oracle::random_scene(draws.chance(0.8) ? 40 : 41, options);
  scene.base = {};
  scene.base.motion = static_cast<BaseMotion>(draws.below(3));
  if (scene.base.motion == BaseMotion::free) scene.base.mass = 200, scene.base.inertia = 50;
  if (scene.base.motion == BaseMotion::prescribed) scene.base.rate = 0.05;
  if (draws.chance(0.5)) {
    oracle::RealFeatures some;
    some.loops = draws.chance(0.5), some.air = draws.chance(0.5);
    scene = oracle::with_real_hinges(scene, seed, some);
  }
  if (scene.base.motion == BaseMotion::prescribed && draws.chance(0.5))
    scene = oracle::driven_by_table(scene, seed, 1);
  for (Hinge& hinge : scene.hinges) {
    if (draws.chance(0.1)) hinge.motor = Motor{.rate = 0.2, .gain = 5, .torque_limit = 3};
    if (draws.chance(0.1)) hinge.release = Release{.time = 0.2};
    if (draws.chance(0.2)) oracle::rub(hinge, 0.1);
    if (draws.chance(0.2)) hinge.latch.reset();
  }
  return scene;
}

} // namespace

TEST_CASE("a run does not know which wing was run before it") {
  Deployment kept;
  Integration how;
  how.t_end = 1, how.rtol = 1e-5;
  for (int seed = 1; seed <= random_cases(2000, 120); ++seed) {
    const Scene scene = any_wing(seed);
    CAPTURE(seed);
    CHECK(oracle::bits_of(kept.run(scene, how, {})) ==
          oracle::bits_of(Deployment().run(scene, how, {})));
  }
}
