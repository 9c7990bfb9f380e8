#include "montecarlo/engine/runs/run_cost.hpp"
#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <omp.h>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// So many threads for the tests' runs, until it ends.
class Threads {
public:
  explicit Threads(int count) { omp_set_num_threads(count); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;
  ~Threads() { omp_set_num_threads(before_); }

private:
  int before_ = omp_get_max_threads();
};

} // namespace

TEST_CASE("the time of many runs is that of one, times their number, over the threads") {
  NominalRuns nominal;
  nominal.seconds = 0.5;
  for (const int threads : {1, 3, 8}) {
    const Threads some(threads);
    CAPTURE(threads);
    CHECK(time_of_runs(nominal, threads) == "about 0.5 s");
    CHECK(time_of_runs(nominal, 80 * threads) == "about 40 s");
    CHECK(time_of_runs(nominal, 240 * threads) == "about 2 min");
    CHECK(time_of_runs(nominal, 180 * threads) == "about 90 s");
    CHECK(time_of_runs(nominal, 1800 * threads) == "about 15 min");
    CHECK(time_of_runs(nominal, 11'880 * threads) == "about 99 min");
    CHECK(time_of_runs(nominal, 12'600 * threads) == "about 2 h");
    CHECK(time_of_runs(nominal, 36000 * threads) == "about 5 h");
    nominal.seconds = 0.04;
    CHECK(time_of_runs(nominal, threads) == "about 40 ms");
    nominal.seconds = 0.5;
  }
}

TEST_CASE("the cost of a campaign names its runs, its threads, and the nominal run's evaluations") {
  const Campaign campaign = campaign_of(quick_campaign(30));
  Goal goal = goal_of(campaign.outputs);
  goal.audit = goal.end_state = false;
  const Outcome alone = Deployment().run(nominal_scene(campaign), campaign.integration, goal);
  for (const int threads : {1, 3}) {
    const Threads some(threads);
    const NominalRuns tried = try_nominal(campaign);
    CHECK(tried.notes.empty());
    CHECK(tried.seconds > 0);
    CHECK_THAT(tried.cost, Catch::StartsWith(fmt::format("the nominal run takes {} evaluations, ",
                                                         alone.work.rhs_evaluations)));
    CHECK_THAT(tried.cost, Catch::EndsWith(fmt::format("; 30 runs: {} on {}, less in packs",
                                                       time_of_runs(tried, 30),
                                                       counted(threads, "thread", "threads"))));
  }
}

TEST_CASE("the cost of a campaign has the time of its draws") {
  Json json = quick_campaign(30);
  for (int i = 0; i < 3000; ++i) // beta laws, whose quantiles take longest
    json["dispersions"].push_back(
        {{"name", "d" + std::to_string(i)},
         {"distribution",
          {{"type", "beta"}, {"alpha", 2.5}, {"beta", 3.5}, {"lower", 0}, {"upper", 1e-9}}},
         {"apply", "add"},
         {"to", {"bodies.panel_1.mass"}}});
  const Campaign campaign = campaign_of(json);
  const RunPlan plan(campaign);
  std::vector<double> draws(campaign.dispersions.size());
  double shortest = 1e9; // of a processor: other programs may run
  for (long run = 0; run < 20; ++run) {
    const std::clock_t start = std::clock();
    plan.draw(run, draws);
    shortest = std::min(shortest, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  const NominalRuns tried = try_nominal(campaign);
  CHECK(tried.seconds > 0.8 * shortest);
  CHECK_THAT(tried.cost, Catch::Contains("; the draws of a run take "));
  CHECK_THAT(try_nominal(campaign_of(quick_campaign(30))).cost, !Catch::Contains("draws"));
}

TEST_CASE("the cost of a campaign is that of all its cases") {
  Json json = quick_campaign(30);
  json["cases"] = parse_json(R"([ { "name": "cold" }, { "name": "hot" } ])");
  const NominalRuns tried = try_nominal(campaign_of(json));
  CHECK_THAT(tried.cost, Catch::Contains("; 60 runs in 2 cases: " + time_of_runs(tried, 60)));
}

TEST_CASE("a nominal wing that does not deploy is said, with its status") {
  Json json = quick_campaign(3);
  json["integration"]["t_end"] = 0.5;
  const NominalRuns tried = try_nominal(campaign_of(json));
  REQUIRE(tried.notes.size() == 1);
  CHECK_THAT(tried.notes[0], Catch::StartsWith("the nominal wing does not deploy: timed out"));
}

TEST_CASE("a nominal run that fails is said to fail, not to take longer") {
  Json json = quick_campaign(3);
  json["integration"] = {{"method", "runge_kutta4"}, {"step", 0.5}, {"t_end", 20}};
  const NominalRuns tried = try_nominal(campaign_of(json));
  CHECK_THAT(tried.cost, !Catch::Contains("more than"));
  REQUIRE(tried.notes.size() == 1);
  CHECK_THAT(
      tried.notes[0],
      Catch::StartsWith("the nominal wing does not deploy: failed (the fixed step of 0.5 s "));
}

TEST_CASE("a nominal run that is given up bounds the cost from below") {
  Json json = quick_campaign(3);
  json["integration"] = {{"method", "runge_kutta4"}, {"step", 1e-6}, {"t_end", 20}};
  const NominalRuns tried = try_nominal(campaign_of(json));
  REQUIRE(tried.notes.size() == 1);
  CHECK_THAT(tried.notes[0],
             Catch::StartsWith("the nominal wing was followed for 50000 trial steps only"));
  CHECK_THAT(tried.cost, Catch::StartsWith("the nominal run takes more than ") &&
                             Catch::Contains("; 3 runs: more than "));
}

TEST_CASE("a nominal run that its campaign's own max_steps ends has failed, and is not given up") {
  for (const long most : {1, 10, 40}) {
    Json json = quick_campaign(3);
    json["integration"]["max_steps"] = most;
    const NominalRuns tried = try_nominal(campaign_of(json));
    CAPTURE(most);
    CHECK_THAT(tried.cost, !Catch::Contains("more than"));
    CHECK_FALSE(tried.at_least);
    REQUIRE(tried.notes.size() == 1);
    CHECK_THAT(tried.notes[0],
               Catch::Contains("does not deploy: failed") && Catch::Contains("max_steps"));
  }
}
