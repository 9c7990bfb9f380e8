#include "montecarlo/formats/json.hpp"
#include "montecarlo/sensitivity/saltelli.hpp"
#include "montecarlo/sensitivity/sobol_report.hpp"
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
  const SobolSensitivity all =
      sobol_sensitivity(rows_of(plan, {0, runs}), 12, "random", {.resamples = 50});
  CHECK(all.idle() == std::vector<std::string>{"none"});
  CHECK(warnings(all) == std::vector<std::string>{"no output of any run changes with \"none\""});
  const Json read = parse_json(json_text(sensitivity_json(all, {})));
  CHECK(read["samples"] == 12);
  CHECK(read["runs"] == runs);
  CHECK(read["partial"] == false);
  CHECK(read["moves_nothing"] == Json::array({"none"}));
  const Json& effects = read["outputs"]["root.latch_time"]["dispersions"];
  CHECK(effects["none"]["total"]["value"] == 0);
  CHECK(effects["root_spring"]["total"]["value"] > effects["none"]["total"]["value"]);
  CHECK(sensitivity_csv(all).starts_with(
      "output,dispersion,rows,left_out,first,first_lower,first_upper,"
      "total,total_lower,total_upper\nroot.latch_time,root_spring,12,0,"));
  CHECK(sensitivity_table(all, "title").find("sum of the first-order") != std::string::npos);
}
