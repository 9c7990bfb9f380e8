// The samples of runs in lanes.
#include "tests/core/packs/same_bits.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The bits of all samples of each run, by the scene's index; then those of its outcome.
using Samples = std::map<long, std::string>;

void add_bits(std::string& all, const Sample& sample) {
  const auto add = [&](double x) {
    std::array<char, sizeof x> bytes{};
    std::memcpy(bytes.data(), &x, sizeof x);
    all.append(bytes.data(), bytes.size());
  };
  for (const auto* v : {&sample.angles, &sample.rates, &sample.moments})
    for (const double x : *v) add(x);
  for (const double x : {sample.t, sample.kinetic, sample.potential, sample.base_position[0],
                         sample.base_position[1], sample.base_angle, sample.base_rate})
    add(x);
}

Samples alone(const std::vector<Scene>& scenes, const Integration& how, const Goal& goal) {
  Samples samples;
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    std::string& all = samples[static_cast<long>(k)];
    const Outcome outcome = Deployment().run(scenes[k], how, goal,
                                             [&](const Sample& sample) { add_bits(all, sample); });
    all += bits_of(outcome);
  }
  return samples;
}

/// Checks samples and outcomes in the lanes of every instruction set.
void require_equal_samples(const std::vector<Scene>& scenes, const Integration& how,
                           const Goal& goal) {
  const Samples expected = alone(scenes, how, goal);
  REQUIRE_FALSE(expected.empty());
  for (const InstructionSet set : instruction_sets()) {
    CAPTURE(to_string(set));
    Samples found;
    long next = 0;
    const auto next_scene = [&](Scene& scene) -> std::optional<long> {
      if (next == std::ssize(scenes)) return std::nullopt;
      scene = scenes[static_cast<std::size_t>(next)];
      return next++;
    };
    DeploymentPack(set, how, goal)
        .run(
            scenes.front(), next_scene,
            [&](long name, Outcome&& outcome) { found[name] += bits_of(outcome); },
            [&](long name, const Sample& sample) { add_bits(found[name], sample); });
    REQUIRE((found == expected));
  }
}

std::vector<Scene> varied(const Scene& drawing, int count) {
  std::vector<Scene> scenes;
  for (int k = 0; k < count; ++k) {
    Draws draws(700 + k);
    scenes.push_back(drawing);
    for (Body& body : scenes.back().bodies) body.mass *= draws.uniform(0.9, 1.1);
    for (Hinge& hinge : scenes.back().hinges) hinge.friction.coulomb *= draws.uniform(0.5, 2);
  }
  return scenes;
}

Goal sampled(double interval, bool motion_only, bool peaks) {
  Goal goal;
  goal.peak_moment = goal.peak_force = peaks;
  goal.audit = false;
  goal.to_t_end = true;
  goal.sample_interval = interval;
  goal.sample_motion_only = motion_only;
  return goal;
}

} // namespace

TEST_CASE("samples of runs in lanes have the bits of those alone: the seed wing") {
  Scene rubbing = seed_scene();
  for (Hinge& hinge : rubbing.hinges) hinge.friction.coulomb = 0.05;
  Scene sticking = rubbing;
  for (Hinge& hinge : sticking.hinges) hinge.friction.model = FrictionModel::exact;
  Integration how;
  how.t_end = 8;
  for (const Scene& scene : {seed_scene(), rubbing, sticking})
    for (const double interval : {0.0, 0.02})
      for (const bool motion_only : {false, true}) {
        CAPTURE(interval, motion_only);
        require_equal_samples(varied(scene, 11), how, sampled(interval, motion_only, !motion_only));
      }
}

TEST_CASE("samples of runs in lanes have the bits of those alone: random wings on every base") {
  for (int k = 0; k < 12; ++k) {
    RandomScene options;
    options.bodies = 1 + k % 5;
    options.branching = k % 2 == 1;
    options.motion = static_cast<BaseMotion>(k % 3);
    CAPTURE(k);
    Integration how;
    how.rtol = 1e-6, how.atol = 1e-8, how.t_end = 2;
    how.max_steps = 3000;
    require_equal_samples(varied(random_scene(800 + k, options), 7), how,
                          sampled(0.01, k < 6, true));
  }
}

TEST_CASE("samples of motion alone have the motion of whole samples, and no loads") {
  const Scene scene = seed_scene();
  Integration how;
  how.t_end = 4;
  std::vector<Sample> whole, motion;
  for (auto* samples : {&whole, &motion})
    (void)Deployment().run(scene, how, sampled(0.05, samples == &motion, false),
                           [&](const Sample& sample) { samples->push_back(sample); });
  REQUIRE(whole.size() == 81);
  REQUIRE(motion.size() == whole.size());
  for (std::size_t k = 0; k < whole.size(); ++k) {
    CHECK(motion[k].t == whole[k].t);
    CHECK(motion[k].angles == whole[k].angles);
    CHECK(motion[k].rates == whole[k].rates);
    CHECK(motion[k].moments == std::vector<double>(scene.hinges.size(), 0.0));
    CHECK(motion[k].potential == 0);
  }
  CHECK(whole[1].potential != 0);
}
