#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/engine/runs/sampled_motion.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

#include <set>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a motion between its samples has the closed form's angle and rate") {
  Campaign campaign = campaign_of(panel_campaign());
  campaign.integration.rtol = 1e-10, campaign.integration.atol = 1e-12;
  const SampledColumns columns{{1, 2}, 0.02, 2}; // root.angle, root.rate
  const RunPlan plan(
      campaign,
      [](long, std::span<Tails> u) {
        std::ranges::fill(u, Tails{.5, .5});
      },
      columns);
  const std::vector<double> samples = Runner(plan).run(0).outputs;
  REQUIRE(samples.size() == 101UL * 4);
  const SampledMotion motion(campaign.scene, columns);
  REQUIRE(motion.is_whole(samples));
  for (double t = 0.001; t < 1.9; t += 0.0137) {
    CHECK(motion.at(samples, 0, t) == Approx(panel_angle(t, 1, 1)).margin(1e-8));
    // while the rate is below its regularization, 1e-6 rad/s, friction is less: some 1e-7 rad/s in all
    CHECK(motion.at(samples, 1, t) == Approx(-(2 - 0.3) / panel_inertia * t).margin(3e-7));
  }
  CHECK(motion.at(samples, 0, -1) == motion.at(samples, 0, 0)); // before the release
}

TEST_CASE("a plan's samples are the same alone and in lanes; a run that fails has none") {
  Campaign campaign = campaign_of(panel_campaign());
  for (const std::size_t column : {1, 3}) { // an angle; a moment
    const RunPlan plan(campaign, {}, SampledColumns{{column}, 0.05, 3});
    std::map<long, std::vector<double>> found;
    for (const InstructionSet set : instruction_sets()) {
      ThreadEvaluator evaluator({2, set}, never);
      const auto keep = [&](const Batch& batch) {
        for (const ResultRow& row : batch.rows) found[row.run] = row.outputs;
      };
      REQUIRE(evaluator.make(plan, {0, 20}, {keep}) == 20);
      for (long k = 0; k < 20; ++k) REQUIRE(found[k] == Runner(plan).run(k).outputs);
      CHECK(found[3].size() == 2 * 61);
      CHECK(found[3] != found[4]);
    }
  }
  campaign.integration.max_steps = 3;
  const RunPlan plan(campaign, {}, SampledColumns{{1}, 0.05, 3});
  CHECK(Runner(plan).run(0).outputs.empty());
}

TEST_CASE("the grid is as coarse as the recording allows") {
  const auto every = [](double step, int count) {
    std::vector<double> times;
    for (int k = 0; k < count; ++k) times.push_back(step * k);
    return times;
  };
  CHECK(grid_interval(every(0.001, 8001)) == 0.01);
  CHECK(grid_interval(every(0.015, 1001)) == Approx(0.015));
  CHECK(grid_interval(every(0.1, 601)) == 0.02);
  CHECK(grid_interval(every(0.01, 51)) == Approx(0.005)); // a short one: 100 intervals
}

TEST_CASE("each column sampled alone has the values that it has beside all others") {
  const Campaign campaign = campaign_of(panel_campaign());
  const std::vector<std::string> names = trajectory_columns(campaign.scene);
  std::vector<std::size_t> all;
  for (std::size_t column = 1; column < names.size(); ++column) all.push_back(column);
  REQUIRE(all.size() >= 6); // angle, rate, moment, three energies
  const auto samples_of = [&](std::vector<std::size_t> columns) {
    const RunPlan plan(campaign, {}, SampledColumns{std::move(columns), 0.1, 3});
    return Runner(plan).run(0).outputs;
  };
  const std::vector<double> together = samples_of(all);
  for (std::size_t k = 0; k < all.size(); ++k) {
    CAPTURE(names[all[k]]);
    const std::vector<double> alone = samples_of({all[k]});
    REQUIRE(alone.size() * all.size() == together.size());
    std::set<double> different;
    for (std::size_t sample = 0; 2 * sample < alone.size(); ++sample) {
      CHECK(alone[2 * sample] == together[2 * (sample * all.size() + k)]);
      different.insert(alone[2 * sample]);
    }
    CHECK(different.size() > 5); // it moves
  }
}
