#include "montecarlo/engine/runs/run_plan.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <utility>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a draw depends on seed, run and name alone") {
  const Campaign few = campaign_of(quick_campaign(10)), many = campaign_of(quick_campaign(1000));
  const RunPlan plan_few(few), plan_many(many);
  CHECK(plan_few.names().draws ==
        std::vector<std::string>{"root_spring", "mass.panel_1", "mass.panel_2", "mass.panel_3"});
  std::vector<double> one(4), other(4);
  for (const long k : {0L, 1L, 9L}) {
    plan_few.draw(k, one);
    plan_many.draw(k, other);
    CHECK(one == other);
    const double u = uniform(7, static_cast<std::uint64_t>(k), stream_name("mass.panel_2"));
    CHECK(one[2] == PreparedDistribution({Uniform{9, 11}, {}}).quantile(u));
  }
}

TEST_CASE("every design draws by the dispersions' names, not by their places") {
  for (const char* design : {"random", "latin_hypercube", "sobol"}) {
    Json json = quick_campaign(64);
    json["sampling"]["design"] = design;
    json["sampling"]["replicates"] = 4;
    json["correlations"] =
        parse_json(R"([{ "between": ["root_spring", "mass.panel_2"], "spearman": -0.5 }])");
    Json turned = json;
    std::reverse(turned["dispersions"].begin(), turned["dispersions"].end());
    const Campaign one = campaign_of(json), other = campaign_of(turned);
    const RunPlan plan(one), turned_plan(other);
    std::vector<double> here(4), there(4);
    for (long k = 0; k < 64; ++k) {
      plan.draw(k, here);
      turned_plan.draw(k, there);
      std::rotate(there.begin(), there.end() - 1, there.end()); // the spring has come last
      CHECK(here == there);
    }
  }
}

TEST_CASE("of a Latin hypercube no run is drawn beyond its last") {
  for (const int runs : {1, 7, 100})
    for (const char* design : {"latin_hypercube", "sobol", "random"}) {
      Json json = quick_campaign(runs);
      json["sampling"]["design"] = design;
      const Campaign campaign = campaign_of(json);
      const RunPlan plan(campaign);
      std::vector<double> draws(4);
      plan.draw(runs - 1, draws);
      if (campaign.sampling.design == DesignKind::latin_hypercube)
        CHECK_THROWS_AS(plan.draw(runs, draws), std::out_of_range);
      else
        CHECK_NOTHROW(plan.draw(runs, draws));
    }
}

// 1 − 1e-20 is 1 in any double: what is drawn so far out is known by its upper tail alone.
TEST_CASE("a point that is given by both of its tails is drawn by the smaller one") {
  Json json = quick_campaign(1);
  json["dispersions"].erase(1);
  const Campaign campaign = campaign_of(json);
  const double z = 9.262340089798408; // Φ(−z) = 1e-20
  std::vector<double> draw(1);
  for (const auto& [tails, score] : {std::pair{Tails{1e-20, 1}, -z}, {Tails{1, 1e-20}, z}}) {
    const RunPlan plan(campaign, [&](long, std::span<Tails> u) { u[0] = tails; });
    plan.draw(0, draw);
    CHECK(draw[0] == Approx(1 + 0.05 * score).epsilon(1e-12));
  }
}

TEST_CASE(
    "of rows the point takes the one in whose share of the interval it lies, from either end") {
  Json json = quick_campaign(1);
  json["dispersions"] = {parse_json(R"({ "name": "fitted",
    "rows": { "values": { "a": [7, 1, 5, 3, 9, 2, 8, 4, 6, 10] }, "apply": "add",
              "columns": { "a": "hinges.root.friction.coulomb" } } })")};
  const Campaign campaign = campaign_of(json);
  const std::vector<double> rows{7, 1, 5, 3, 9, 2, 8, 4, 6, 10};
  std::vector<double> draw(1);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double below = (static_cast<double>(k) + 0.3) / 10;
    const RunPlan plan(campaign, [&](long, std::span<Tails> u) { u[0] = Tails{below, 1 - below}; });
    plan.draw(0, draw);
    CHECK(draw[0] == rows[k]);
  }
  const RunPlan last(campaign, [](long, std::span<Tails> u) { u[0] = Tails{1, 1e-20}; });
  last.draw(0, draw);
  CHECK(draw[0] == 10);
}
