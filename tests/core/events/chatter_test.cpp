// Overdamped latches under exact friction: their hinges creep to the load that friction just holds.
#include "core/deployment.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <numbers>
#include <string>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A free spacecraft with one to three panels in a row, from weak to strong latches and from hardly to overdamped ones.
Scene creeping_wing(std::uint64_t seed) {
  RandomScene options;
  options.bodies = 1 + static_cast<int>(seed % 3), options.branching = false;
  options.motion = BaseMotion::free, options.friction = false, options.reach = 0.5;
  options.mass_lower = 2, options.mass_upper = 20;
  Scene scene = random_scene(seed, options);
  Draws draws(seed + 100);
  if (draws.chance(0.5)) scene.base.rate = 0;
  for (Hinge& hinge : scene.hinges) {
    const double torque = draws.uniform(0.5, 3);
    hinge.spring = {torque, torque}, hinge.harness = {}, hinge.initial_rate = 0;
    hinge.latch = Latch{draws.log_uniform(1e4, 1e6), draws.log_uniform(1, 3000)};
    rub(hinge, draws.uniform(0.05, 0.4) * torque);
  }
  return scene;
}

/// The root's latch is so damped that the root creeps to |load| = 0.3 N·m, while the tip rings on.
Scene overdamped_root() {
  Scene scene;
  scene.base.motion = BaseMotion::free, scene.base.mass = 7.9, scene.base.inertia = 9.5;
  scene.bodies = {{"inner", 5.5, 0.13}, {"middle", 3.4, 0.062}, {"outer", 15, 1.4}};
  const Eigen::Vector2d parents[] = {{-0.25, 0.078}, {0.24, -0.01}, {0.23, 0.013}};
  const Eigen::Vector2d own[] = {{-0.24, 0.017}, {-0.23, -0.015}, {-0.51, -0.027}};
  const double stowed[] = {std::numbers::pi / 2, -std::numbers::pi, std::numbers::pi};
  const Latch latches[] = {{1.5e4, 830}, {3.2e5, 530}, {2.5e5, 3.4}};
  for (int i = 0; i < 3; ++i) {
    Hinge hinge;
    hinge.name = "hinge_" + std::to_string(i), hinge.parent = i == 0 ? base_index : i - 1;
    hinge.child = i, hinge.parent_point = parents[i], hinge.child_point = own[i];
    hinge.stowed = stowed[i], hinge.spring = {2, 2}, hinge.latch = latches[i];
    rub(hinge, 0.3);
    scene.hinges.push_back(hinge);
  }
  return scene;
}

/// Three panels in a row whose neighbours are tied by damped loops, the last one held for good: the others creep against
/// the loops until what they lack is what their friction holds.
Scene tied_wing(std::uint64_t seed) {
  RandomScene options;
  options.bodies = 3, options.branching = false;
  options.motion = seed % 3 == 0 ? BaseMotion::fixed : BaseMotion::free;
  options.friction = false, options.reach = 0.5;
  options.mass_lower = 0.1, options.mass_upper = 5;
  Scene scene = random_scene(seed, options);
  scene.base.rate = 0;
  Draws draws(seed + 200);
  for (Hinge& hinge : scene.hinges) {
    const double torque = draws.log_uniform(0.01, 1);
    hinge.spring = {torque, torque}, hinge.harness = {}, hinge.initial_rate = 0;
    hinge.latch = Latch{draws.log_uniform(1e3, 1e5), draws.log_uniform(0.1, 100)};
    rub(hinge, draws.log_uniform(0.02, 0.8) * torque);
  }
  scene.hinges.back().release = Release{.fails = 1};
  for (int i = 1; i < options.bodies; ++i) {
    Synchronisation loop;
    loop.name = std::to_string(i), loop.first = i - 1, loop.second = i;
    loop.ratio = i == 1 ? 2 : 1;
    loop.stiffness = draws.log_uniform(1, 1e3);
    loop.damping = loop.stiffness * draws.log_uniform(0.01, 1);
    scene.synchronisations.push_back(loop);
  }
  return scene;
}

/// The same wing, whose hinges stick well within their limits.
Scene held_firmly(Scene scene) {
  for (Hinge& hinge : scene.hinges) hinge.friction.static_level = 1.2 * hinge.friction.coulomb;
  return scene;
}

/// Checks that the wing needs at most 20 times the evaluations of the one that is held firmly.
void check_creep(const Scene& scene, double rtol, bool to_the_end) {
  Integration how;
  how.rtol = rtol, how.t_end = 8;
  Goal goal;
  goal.to_t_end = to_the_end;
  const Outcome out = Deployment().run(scene, how, goal);
  const Outcome firm = Deployment().run(held_firmly(scene), how, goal);
  CAPTURE(scene.name, rtol, out.reason);
  CHECK(out.status != Status::failed);
  CHECK(out.work.rhs_evaluations < 20 * firm.work.rhs_evaluations);
}

} // namespace

TEST_CASE("hinges that creep to the load that friction just holds come to rest") {
  const int wings = random_cases(2000, 20);
  for (const double rtol : {1e-8, 1e-6}) {
    for (const bool to_the_end : {false, true}) check_creep(overdamped_root(), rtol, to_the_end);
    for (int seed = 1; seed <= wings; ++seed) check_creep(creeping_wing(seed), rtol, seed % 2 == 0);
  }
}

TEST_CASE("hinges that creep against a loop to the load that friction just holds come to rest") {
  const int wings = random_cases(2000, 60);
  for (const double rtol : {1e-8, 1e-6})
    for (int seed = 1; seed <= wings; ++seed) check_creep(tied_wing(seed), rtol, seed % 2 == 0);
}

TEST_CASE("a hinge that is not released for an excess below the tolerance stands within it") {
  Integration how;
  how.t_end = 8;
  const Outcome loose = Deployment().run(overdamped_root(), how, {});
  how.rtol = 1e-11, how.atol = 1e-13;
  const Outcome tight = Deployment().run(overdamped_root(), how, {});
  REQUIRE(loose.latches.size() == 3);
  REQUIRE(tight.latches.size() == 3);
  for (int i = 0; i < 3; ++i) {
    CHECK(loose.latches[i].time == Approx(tight.latches[i].time).epsilon(1e-8));
    CHECK(loose.peak_moment[i].value == Approx(tight.peak_moment[i].value).epsilon(1e-6));
  }
}
