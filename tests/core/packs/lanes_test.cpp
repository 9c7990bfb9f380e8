#include "core/deployment.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cstring>
#include <map>
#include <string>

using namespace wingspread;

namespace {

/// All of an outcome, in a form in which equal means equal bits.
std::string bits_of(const Outcome& outcome) {
  std::string all = std::string(to_string(outcome.status)) + outcome.reason;
  const auto add = [&](double x) {
    std::array<char, sizeof x> bytes{};
    std::memcpy(bytes.data(), &x, sizeof x);
    all.append(bytes.data(), bytes.size());
  };
  for (const LatchEvent& latch : outcome.latches) {
    add(latch.hinge), add(latch.time);
    for (const double rate : latch.rates) add(rate);
  }
  for (const auto* peaks : {&outcome.peak_moment, &outcome.peak_force})
    for (const Peak& peak : *peaks) add(peak.value), add(peak.time);
  for (const Phase& phase : outcome.phases) all += phase.method, add(phase.from), add(phase.to);
  for (const auto* v : {&outcome.final.angles, &outcome.final.rates})
    for (const double x : *v) add(x);
  add(outcome.final.base_angle), add(outcome.final.base_rate);
  add(outcome.t_end), add(outcome.energy.final);
  add(static_cast<double>(outcome.work.steps)), add(static_cast<double>(outcome.work.rejected));
  add(static_cast<double>(outcome.work.rhs_evaluations));
  return all;
}

/// `count` units of a wing: springs, masses and latches vary.
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

/// The outcomes by name, through the lanes.
std::map<long, std::string> in_lanes(InstructionSet set, const std::vector<Scene>& scenes,
                                     const Integration& how, const Goal& goal) {
  std::map<long, std::string> outcomes;
  long next = 0;
  DeploymentPack pack(set, how, goal);
  pack.run(
      scenes.front(),
      [&](Scene& scene) -> std::optional<long> {
        if (next == std::ssize(scenes)) return std::nullopt;
        scene = scenes[next];
        return next++;
      },
      [&](long name, Outcome&& outcome) {
        REQUIRE(outcomes.emplace(name, bits_of(outcome)).second);
      });
  return outcomes;
}

/// Every run through the lanes of every instruction set is the run alone.
void require_equal_bits(const std::vector<Scene>& scenes, const Integration& how,
                        const Goal& goal) {
  std::map<long, std::string> alone;
  Deployment deployment;
  for (std::size_t k = 0; k < scenes.size(); ++k)
    alone[static_cast<long>(k)] = bits_of(deployment.run(scenes[k], how, goal));
  for (const InstructionSet set : instruction_sets()) {
    CAPTURE(to_string(set));
    REQUIRE((in_lanes(set, scenes, how, goal) == alone));
  }
}

const Goal all{.audit = false};
const Goal latches{.peak_moment = false, .peak_force = false, .audit = false};
const Goal moments_to_the_end{.peak_force = false, .audit = false, .to_t_end = true};

} // namespace

TEST_CASE("a run in a lane has the bits of the run alone: the seed wing") {
  for (const char* method : {"auto", "dopri5", "dop853"})
    for (const double rtol : {1e-3, 1e-6, 1e-9})
      for (const Goal& goal : {all, latches, moments_to_the_end}) {
        CAPTURE(method, rtol, goal.peak_force, goal.to_t_end);
        Integration how;
        how.method = method, how.rtol = rtol, how.atol = 1e-2 * rtol;
        if (goal.to_t_end) how.t_end = 8;
        require_equal_bits(units(oracle::seed_scene(), 19), how, goal);
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
    require_equal_bits(units(oracle::random_scene(500 + k, options), 10), how, all);
  }
}

TEST_CASE(
    "a run in a lane has the bits of the run alone: those that need other methods, end at once "
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
  require_equal_bits(scenes, how, all);
  require_equal_bits(scenes, how, latches);
  how.max_steps = 100;
  require_equal_bits(scenes, how, all);
}

TEST_CASE("lanes stay full: each takes the next run at once") {
  const std::vector<Scene> scenes = units(oracle::seed_scene(), 400);
  for (const InstructionSet set : instruction_sets()) {
    if (set == InstructionSet::scalar) continue;
    CAPTURE(to_string(set));
    long next = 0;
    DeploymentPack pack(set, {}, latches);
    const Occupancy lanes = pack.run(
        scenes.front(),
        [&](Scene& scene) -> std::optional<long> {
          if (next == std::ssize(scenes)) return std::nullopt;
          scene = scenes[next];
          return next++;
        },
        [](long, Outcome&&) {});
    REQUIRE(static_cast<double>(lanes.busy) > 0.97 * static_cast<double>(lanes.tries));
  }
}
