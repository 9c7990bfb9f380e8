// A Deployment keeps storage from run to run, and nothing else.
#include "core/deployment.hpp"
#include "tests/core/deployment/any_wing.hpp"
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

TEST_CASE("a run does not know which wing was run before it") {
  Deployment kept;
  Integration how;
  how.t_end = 1, how.rtol = 1e-5;
  for (int seed = 1; seed <= random_cases(2000, 120); ++seed) {
    const Scene scene = oracle::any_wing(seed);
    CAPTURE(seed);
    CHECK(oracle::bits_of(kept.run(scene, how, {})) ==
          oracle::bits_of(Deployment().run(scene, how, {})));
  }
}

namespace {

/// The wing with one more feature each; the last is the wing as it is. A draw may add or remove a backlash, the air and
/// gravity; the callers of Deployment may hand it any wing.
std::vector<Scene> with_each_feature(const Scene& plain) {
  std::vector<Scene> all;
  const auto add = [&](const auto& change) {
    all.push_back(plain);
    change(all.back(), all.back().hinges[0]);
  };
  add([](Scene&, Hinge& hinge) { hinge.latch->backlash = 1e-3; });
  add([](Scene&, Hinge& hinge) { hinge.latch->capture_rate = 100; });
  add([](Scene&, Hinge& hinge) { hinge.stop = Stop{.stiffness = 100}; });
  add([](Scene&, Hinge& hinge) { hinge.damper.emplace().coefficient = 0.1; });
  add([](Scene&, Hinge& hinge) { oracle::rub(hinge, 0.01); });
  add([](Scene&, Hinge& hinge) {
    hinge.motor = Motor{.rate = 0.1, .gain = 0.1, .torque_limit = 0.1};
  });
  add([](Scene&, Hinge& hinge) { hinge.release = Release{.time = 0.2}, hinge.initial_rate = 0; });
  add([](Scene& scene, Hinge&) { scene.environment.gravity = {0, -0.01}; });
  add([](Scene& scene, Hinge&) {
    scene.environment.air_density = 0.1;
    scene.bodies[0].plate = Plate{{-0.1, 0}, {0.1, 0}, 0.1, 1.2};
  });
  all.push_back(plain);
  return all;
}

} // namespace

TEST_CASE("a run does not know which features the wing before it had, alone or in lanes") {
  const Goal goal{.audit = false};
  Integration how;
  how.rtol = 1e-5;
  // the panel is without friction: power series follow it, unless the wing has one of these features
  for (const Scene& plain : {oracle::seed_scene(), oracle::latching_panel()}) {
    const std::vector<Scene> wings = with_each_feature(plain);
    std::vector<std::string> alone;
    for (const Scene& wing : wings)
      alone.push_back(oracle::bits_of(Deployment().run(wing, how, goal)));
    for (std::size_t before = 0; before < wings.size(); ++before)
      for (std::size_t after = 0; after < wings.size(); ++after) {
        CAPTURE(before, after);
        Deployment kept;
        (void)kept.run(wings[before], how, goal);
        CHECK(oracle::bits_of(kept.run(wings[after], how, goal)) == alone[after]);
        for (const InstructionSet set : instruction_sets()) {
          CAPTURE(to_string(set));
          const auto bits = oracle::in_lanes(
              set, {wings[before], wings[after], wings[before], wings[after]}, how, goal);
          CHECK(bits.at(0) == alone[before]);
          CHECK(bits.at(3) == alone[after]);
        }
      }
  }
}
