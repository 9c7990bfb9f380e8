#include "montecarlo/analyses/sensitivity/saltelli.hpp"
#include "montecarlo/analyses/sensitivity/sobol_indices.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <set>

using namespace wingspread;
using namespace wingspread::test;

namespace {

std::vector<double> draws(const RunPlan& plan, long run) {
  std::vector<double> values(plan.names().draws.size());
  plan.draw(run, values);
  return values;
}

} // namespace

TEST_CASE("AB_i is A with one coordinate of B, by every design") {
  for (const char* design : {"random", "latin_hypercube", "sobol"}) {
    Json json = quick_campaign(32);
    json["sampling"]["design"] = design;
    const Campaign campaign = campaign_of(json);
    const RunPlan plan = saltelli_plan(campaign, 32), own(campaign);
    const std::size_t d = campaign.dispersions.size();
    std::set<double> seen;
    for (long row = 0; row < 32; ++row) {
      const long first = row * static_cast<long>(d + 2);
      const std::vector<double> a = draws(plan, first), b = draws(plan, first + 1);
      for (std::size_t i = 0; i < d; ++i) {
        seen.insert({a[i], b[i]});
        std::vector<double> expected = a;
        expected[i] = b[i];
        CHECK(draws(plan, first + 2 + static_cast<long>(i)) == expected);
      }
      if (design == std::string("random")) CHECK(a == draws(own, row));
    }
    CHECK(seen.size() == 32 * 2 * d); // no draw twice
  }
}

TEST_CASE("a point says which row it is of") {
  CHECK(saltelli_point(0, 3).row == 0);
  CHECK(saltelli_point(4, 3).place == 4);
  CHECK(saltelli_point(5, 3).row == 1);
  CHECK(saltelli_runs(100, 3) == 500);
  CHECK_THROWS_WITH(saltelli_runs(std::numeric_limits<long>::max() / 2, 3),
                    Catch::Contains("--samples") && Catch::Contains("each takes 5 runs"));
}

TEST_CASE("nothing to vary, and what varies together, is refused") {
  Json json = quick_campaign(10);
  json["correlations"] = {{{"between", {"root_spring", "mass.panel_1"}}, {"spearman", 0.5}}};
  const Campaign correlated = campaign_of(json);
  CHECK_THROWS_WITH(saltelli_plan(correlated, 8),
                    Catch::Contains("/correlations: found 1 of them, expected independent"));
  json.erase("correlations");
  for (Json& dispersion : json["dispersions"])
    dispersion["distribution"] = parse_json(R"({ "type": "constant", "value": 1 })");
  CHECK_THROWS_WITH(saltelli_plan(campaign_of(json), 8), Catch::Contains("a single value only"));
  json.erase("dispersions");
  const Campaign bare = campaign_of(json);
  CHECK_THROWS_WITH(saltelli_plan(bare, 8), Catch::Contains("/dispersions: found none"));
}

TEST_CASE("the columns of rows are one coordinate of the design") {
  Json json = quick_campaign(1);
  json["dispersions"].push_back(parse_json(R"({ "name": "fitted",
    "rows": { "values": { "a": [1, 2, 3], "b": [4, 5, 6] }, "apply": "add",
              "columns": { "a": "hinges.root.friction.coulomb", "b": "hinges.mid.friction.coulomb" } } })"));
  const Campaign campaign = campaign_of(json);
  const RunPlan plan = saltelli_plan(campaign, 8);
  REQUIRE(plan.coordinates().names.size() == 5);
  std::vector<double> a(6), changed(6);
  for (long row = 0; row < 8; ++row) {
    plan.draw(row * 7, a);
    for (long i = 0; i < 5; ++i) {
      plan.draw(row * 7 + 2 + i, changed);
      CHECK(changed[5] == changed[4] + 3); // always one row
      for (std::size_t k = 0; k < 4; ++k)
        CHECK((changed[k] == a[k]) == (static_cast<std::size_t>(i) != k));
    }
  }
}

TEST_CASE("Sobol' points have two coordinates for each dispersion, so half of them may be drawn") {
  Json json = quick_campaign(10);
  json["sampling"]["design"] = "sobol";
  Campaign campaign = campaign_of(json);
  const Dispersion one = campaign.dispersions.front();
  for (const std::size_t more : {1, 2, 1000}) {
    const std::size_t count = most_sobol_dimensions / 2 + more;
    campaign.dispersions.assign(count, one);
    CHECK_THROWS_WITH(saltelli_plan(campaign, 8),
                      Catch::Contains("/dispersions: found " + std::to_string(count)) &&
                          Catch::Contains("at most " + std::to_string(most_sobol_dimensions / 2)));
  }
}

TEST_CASE("Sobol' points count all columns of a rows as one dispersion") {
  Json json = quick_campaign(10);
  json["sampling"]["design"] = "sobol";
  json["dispersions"] = Json::array();
  Json rows = parse_json(R"({ "name": "fitted", "rows": { "apply": "scale" } })");
  const std::size_t columns = most_sobol_dimensions / 2 + 1;
  for (std::size_t k = 0; k < columns; ++k) {
    const std::string name = "c" + std::to_string(k);
    rows["rows"]["values"][name] = {1, 1.01};
    rows["rows"]["columns"][name] = "hinges.root.spring.scale";
  }
  json["dispersions"].push_back(rows);
  const Campaign campaign = campaign_of(json);
  REQUIRE(campaign.dispersions.size() == columns);
  CHECK(saltelli_plan(campaign, 8).coordinates().names.size() == 1);
}
