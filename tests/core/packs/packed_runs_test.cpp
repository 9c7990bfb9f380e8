#include "core/deployment.hpp"
#include "tests/core/packs/same_bits.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <optional>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;
using oracle::require_equal_bits;

namespace {

/// `count` wings whose springs, masses and latches vary.
std::vector<Scene> units(const Scene& drawing, int count) {
  std::vector<Scene> scenes;
  for (int k = 0; k < count; ++k) {
    oracle::Draws draws(100 + k);
    Scene scene = drawing;
    for (Hinge& hinge : scene.hinges) {
      const double spring = draws.uniform(0.9, 1.1);
      hinge.spring.torque_stowed *= spring, hinge.spring.torque_latched *= spring;
      if (hinge.latch) hinge.latch->stiffness *= draws.uniform(0.8, 1.2);
      hinge.friction.coulomb *= draws.uniform(0.5, 2);
    }
    for (Body& body : scene.bodies) body.mass *= draws.uniform(0.95, 1.05);
    scenes.push_back(scene);
  }
  return scenes;
}

const Goal first_latch{.peak_moment = false,
                       .peak_force = false,
                       .overtravel = false,
                       .audit = false,
                       .end_state = false,
                       .first_latch_only = true};
const Goal moments_to_the_end{.peak_force = false, .audit = false, .to_t_end = true};

} // namespace

TEST_CASE("a run in a lane has the bits of the run alone: the seed wing") {
  for (const char* method : {"auto", "dopri5", "dop853", "taylor"})
    for (const double rtol : {1e-3, 1e-6, 1e-9})
      for (const Goal& goal : {every_peak, latches_alone, first_latch, moments_to_the_end}) {
        CAPTURE(method, rtol, goal.peak_force, goal.to_t_end);
        Integration how;
        how.method = method, how.rtol = rtol, how.atol = 1e-2 * rtol;
        if (goal.to_t_end) how.t_end = 8;
        require_equal_bits(units(oracle::seed_scene(), 19), how, goal);
      }
}

TEST_CASE("a run by series in a lane has the bits of the run alone: chains, and "
          "in turn with runs that have none") {
  for (int k = 0; k < 16; ++k) {
    oracle::RandomScene options;
    options.bodies = 1 + k % 4, options.branching = false, options.motion = BaseMotion::fixed;
    options.friction = false;
    CAPTURE(k, options.bodies);
    Integration how;
    how.method = "taylor", how.t_end = 10;
    how.rtol = k % 3 == 0 ? 1e-6 : 1e-10, how.atol = 1e-2 * how.rtol;
    require_equal_bits(units(oracle::random_scene(900 + k, options), 11), how, every_peak);
  }
  std::vector<Scene> mixed =
      units(oracle::seed_scene(), 240); // more of each kind than the queue takes
  for (std::size_t k = 0; k < mixed.size(); k += k < 120 ? 3 : 1)
    mixed[k].hinges[0].friction.coulomb = 0.1;
  for (std::size_t k = 0; k < 100; ++k) std::swap(mixed[2 * k], mixed[2 * k + 1]);
  for (const std::size_t without : {0, 1}) { // the first run has series, or has none
    if (without == 1) std::swap(mixed[0], mixed[1]);
    Integration how;
    how.rtol = 1e-9, how.atol = 1e-11;
    require_equal_bits(mixed, how, every_peak);
  }
}

TEST_CASE("an audited run in a lane has the bits of the run alone, energy drift included") {
  const Goal audited{.peak_moment = false, .peak_force = false, .audit = true};
  const std::vector<Scene> scenes = units(oracle::seed_scene(), 19);
  REQUIRE(Deployment().run(scenes[0], {}, audited).energy.drift_before_first_latch > 0);
  for (const double rtol : {1e-3, 1e-6, 1e-9}) {
    Integration how;
    how.rtol = rtol, how.atol = 1e-2 * rtol;
    require_equal_bits(scenes, how, audited);
  }
}

TEST_CASE("a run in a lane has the bits of the run alone: random wings on every base") {
  for (int k = 0; k < 24; ++k) {
    oracle::RandomScene options;
    options.bodies = 1 + k % 7;
    options.branching = k % 3 != 0;
    options.motion = static_cast<BaseMotion>(k % 3);
    CAPTURE(k, options.bodies, options.branching, k % 3);
    Integration how;
    how.rtol = 1e-6, how.atol = 1e-8, how.t_end = 2;
    how.max_steps = 3000;
    require_equal_bits(units(oracle::random_scene(500 + k, options), 10), how, every_peak);
  }
}

TEST_CASE(
    "a run in a lane has the bits of the run alone: runs that need other methods, end at once "
    "or fail") {
  std::vector<Scene> scenes = units(oracle::seed_scene(), 12);
  for (Hinge& hinge : scenes[1].hinges) hinge.latch->damping = 1e5, hinge.latch->stiffness = 1e7;
  for (Hinge& hinge : scenes[3].hinges) { // sticks for ever
    hinge.friction.model = FrictionModel::exact;
    hinge.friction.coulomb = 100;
  }
  for (Hinge& hinge : scenes[4].hinges) { // slides and sticks
    hinge.friction.model = FrictionModel::exact;
    hinge.friction.coulomb = 0.1;
  }
  scenes[5].bodies[1].mass = -1;               // invalid
  scenes[7].hinges[0].spring = {1e300, 1e300}; // overflows
  scenes[8].hinges[2].latched = scenes[8].hinges[2].stowed + 1e-9;
  Integration how;
  how.rtol = 1e-6, how.atol = 1e-8;
  require_equal_bits(scenes, how, every_peak);
  require_equal_bits(scenes, how, latches_alone);
  require_equal_bits(scenes, how, first_latch);
  how.max_steps = 100;
  require_equal_bits(scenes, how, every_peak);
}

TEST_CASE("lanes stay full: each takes the next run at once") {
  const std::vector<Scene> scenes = units(oracle::seed_scene(), 400);
  for (const InstructionSet set : instruction_sets()) {
    if (set == InstructionSet::scalar) continue;
    CAPTURE(to_string(set));
    const Occupancy lanes = run_in_lanes(set, scenes, {}, latches_alone, [](long, Outcome&&) {});
    REQUIRE(static_cast<double>(lanes.busy) > 0.97 * static_cast<double>(lanes.trial_steps));
  }
}

TEST_CASE("what lanes make and what runs make outside them are all the runs' trial steps") {
  // their friction excludes series: half of them begin with another method, in batches of their own
  std::vector<Scene> scenes = units(oracle::seed_scene(), 40);
  for (std::size_t k = 0; k < scenes.size(); k += 2)
    for (Hinge& hinge : scenes[k].hinges) hinge.friction.coulomb = 0;
  for (const char* method : {"auto", "dopri5"})
    for (const InstructionSet set : instruction_sets()) {
      if (set == InstructionSet::scalar) continue;
      CAPTURE(method, to_string(set));
      Integration how = within(1e-6, 20);
      how.method = method;
      long made = 0;
      const Occupancy lanes = run_in_lanes(set, scenes, how, first_latch, [&](long, Outcome&& out) {
        made += out.work.steps + out.work.rejected;
      });
      CHECK(lanes.trial_steps % lanes_of(set) == 0);
      CHECK(lanes.busy <= lanes.trial_steps); // a lane may be idle in a step, and makes no other
      CHECK(lanes.returns <= lanes.busy);
      // a step is made again to end at its event, and counts once
      CHECK(lanes.busy + lanes.scalar >= made);
      CHECK(lanes.busy + lanes.scalar <= made + 2 * std::ssize(scenes));
    }
}

TEST_CASE("overtravel that is not asked for is not searched, and nothing else changes") {
  Scene swinging = oracle::seed_scene();
  swinging.hinges[1].initial_rate = -0.5; // turns beyond its stowed angle
  for (const Scene& scene : units(swinging, 5))
    for (const Goal& goal : {every_peak, latches_alone, moments_to_the_end}) {
      Goal less = goal;
      less.overtravel = false;
      Integration how;
      how.t_end = 12;
      Outcome watched = Deployment().run(scene, how, goal);
      const Outcome unwatched = Deployment().run(scene, how, less);
      CHECK(*std::ranges::max_element(watched.overtravel) > 0.01);
      CHECK(unwatched.overtravel.empty());
      watched.overtravel.clear();
      CHECK((oracle::bits_of(watched) == oracle::bits_of(unwatched)));
    }
  const auto returns = [](const Goal& goal) {
    const std::vector<Scene> scenes = units(oracle::seed_scene(), 64);
    long next = 0;
    Integration how;
    how.method = "dop853"; // with taylor steps end at turning points whatever the goal
    DeploymentPack pack(instruction_sets().back(), how, goal);
    return pack
        .run(
            scenes.front(),
            [&](Scene& scene) -> std::optional<long> {
              if (next == std::ssize(scenes)) return std::nullopt;
              scene = scenes[next];
              return next++;
            },
            [](long, Outcome&&) {})
        .returns;
  };
  if (instruction_sets().size() == 1) return; // no lanes
  CHECK(returns(first_latch) <= 2 * 64 + 8);  // the step that holds the latch, and the landing
  Goal watched = first_latch;
  watched.overtravel = true;
  CHECK(returns(watched) > returns(first_latch) + 16);
}

TEST_CASE("the time of runs in packs is counted by where it goes") {
  const InstructionSet set = instruction_sets().back();
  if (lanes_of(set) == 1) return;
  Scene rubbing = oracle::seed_scene();
  for (Hinge& hinge : rubbing.hinges) {
    hinge.friction.coulomb = 0.02;
    hinge.friction.model = FrictionModel::exact;
  }
  const std::vector<Scene> scenes = units(rubbing, 19);
  std::size_t next = 0;
  const Integration how = within(1e-8, 20);
  DeploymentPack pack(set, how, every_peak);
  const Occupancy count = pack.run(
      scenes.front(),
      [&](Scene& scene) -> std::optional<long> {
        if (next == scenes.size()) return std::nullopt;
        scene = scenes[next];
        return static_cast<long>(next++);
      },
      [](long, Outcome&&) {});
  const auto outside = [&](Cause cause) { return count.outside[static_cast<std::size_t>(cause)]; };
  CHECK(count.in_lanes > 0);
  for (const Cause cause :
       {Cause::start, Cause::limit, Cause::event, Cause::release, Cause::moment})
    CHECK(outside(cause) > 0);
  REQUIRE(count.scalar > 0); // where all hinges rest, the lane has nothing to do
  CHECK(outside(Cause::method) > 0);
  CHECK(outside(Cause::base) == 0); // it is fixed
  Occupancy twice = count;
  twice += count;
  CHECK(twice.in_lanes == 2 * count.in_lanes);
  CHECK(twice.outside[0] == 2 * count.outside[0]);
}
