#include "montecarlo/analyses/sensitivity/saltelli.hpp"
#include "montecarlo/analyses/sensitivity/sobol_report.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("Sobol' indices as JSON, CSV and a table; what changes nothing is named", "[parallel]") {
  Json json = quick_campaign(1);
  json["dispersions"].push_back({{"name", "none"},
                                 {"distribution", {{"type", "constant"}, {"value", 1}}},
                                 {"apply", "scale"},
                                 {"to", {"hinges.tip.latch.damping"}}});
  const Campaign campaign = campaign_of(json);
  const RunPlan plan = saltelli_plan(campaign, 12);
  const long runs = saltelli_runs(12, campaign.dispersions.size());
  const SobolSensitivity all = sobol_sensitivity(rows_of(plan, {0, runs}), plan.coordinates().names,
                                                 12, "random", {.resamples = 50});
  CHECK(all.idle() == std::vector<std::string>{"none"});
  CHECK(warnings(all) == std::vector<std::string>{"no output of any run changes with \"none\""});
  const Json read = parse_json(json_text(sensitivity_json(all, {})));
  CHECK(read["samples"] == 12);
  CHECK(read["runs"] == runs);
  CHECK(read["partial"] == false);
  CHECK(read["moves_nothing"] == Json::array({"none"}));
  CHECK(read["warnings"] == Json(warnings(all)));
  const Json& effects = read["outputs"]["root.latch_time"]["dispersions"];
  CHECK(effects["none"]["total"]["value"] == 0);
  CHECK(effects["root_spring"]["total"]["value"] > effects["none"]["total"]["value"]);
  CHECK(sensitivity_csv(all).starts_with(
      "output,dispersion,rows,incomplete,first,first_lower,first_upper,"
      "total,total_lower,total_upper\nroot.latch_time,root_spring,12,0,"));
  CHECK(sensitivity_table(all, "title").find("sum of the first-order") != std::string::npos);
}

TEST_CASE("an output without indices, and bounds that there are not, are told of") {
  Json json = quick_campaign(1);
  json["integration"]["t_end"] = 6.75; // some do not come to it
  json["sampling"]["design"] = "sobol";
  const Campaign campaign = campaign_of(json);
  const RunPlan plan = saltelli_plan(campaign, 16);
  const long runs = saltelli_runs(16, campaign.dispersions.size());
  const SobolSensitivity all = sobol_sensitivity(rows_of(plan, {0, runs}), plan.coordinates().names,
                                                 16, "sobol", {.replicates = 1});
  const Json output = sensitivity_json(all, {})["outputs"]["deployment_time"];
  const long incomplete = output["incomplete"];
  CHECK((output["rows"] == 16 && 0 < incomplete && incomplete <= 16));
  CHECK(output["dispersions"]["root_spring"]["total"]["value"].is_null());
  CHECK(sensitivity_json(all, {})["definitions"]["bounds"] == one_replicate);
  CHECK_THAT(sensitivity_table(all, "title"),
             Catch::Contains("deployment_time, s · 16 rows · " + std::to_string(incomplete) +
                             " with a missing value: no indices"));
  const auto said = warnings(all);
  REQUIRE(said.size() >= 2);
  CHECK(said[0] == one_replicate);
  CHECK_THAT(said[1], Catch::Contains("\"deployment_time\"") && Catch::Contains("no indices"));
}

TEST_CASE("the short table has shares of the variance") {
  SobolSensitivity all;
  all.dispersions = {"a", "b", "c"};
  const auto effect = [](double total) { return SobolEffect{{0, {}}, {total, {}}, false}; };
  SobolIndices indices;
  indices.effects = {effect(0.1), effect(0.004), effect(0.7)};
  all.outputs.push_back({"root.latch_time", indices});
  CHECK(moved_by_table(all, "t") == "t\n\nOUTPUT                          moved by (share of the "
                                    "variance, interactions included)\n"
                                    "  root.latch_time               c 70 %\n");
}

TEST_CASE("indices of peaks that t_end cut are told to be those of the cut values") {
  const Campaign campaign = campaign_of(ringing_panel(1, 2.3, 0));
  const RunPlan plan = saltelli_plan(campaign, 8);
  const SobolSensitivity all = sobol_sensitivity(rows_of(plan, {0, 24}), plan.coordinates().names,
                                                 8, "random", {.resamples = 20});
  CHECK_THAT(warnings(all).at(0), Catch::StartsWith("in 24 of 24 runs t_end cut the peaks of "
                                                    "\"root.peak_moment\", \"root.peak_force\": "));
  CHECK(sensitivity_json(all, {})["outputs"]["root.peak_moment"]["cut"] == 24);
  CHECK_THAT(sensitivity_table(all, "t"), Catch::Contains(" · 24 cut by t_end\n"));
}
