// Overtravel without rows: which hinges turn back through their stowed angle, in how many runs, and how far.
#include "montecarlo/results/streaming/streaming_summary.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <array>
#include <vector>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE(
    "without rows the hinges that turn back through their stowed angle are those of the rows") {
  Json json = quick_campaign(10);
  json["outputs"] = {"latch_time", "overtravel"};
  json["scene"]["hinges"][2]["stop"] = parse_json(R"({ "stiffness": 100, "dissipation": 0 })");
  const Campaign campaign = campaign_of(json);
  const ResultNames names = RunPlan(campaign).names();
  constexpr double degree = 0.017453292519943295;
  Results rows(names);
  StreamingStatistics statistics(campaign, names, rows);
  const std::array<double, 6> root{-0.3, 2 * degree, 40 * degree, degree, undefined, 3 * degree};
  for (std::size_t k = 0; k < root.size(); ++k) {
    ResultRow row{static_cast<long>(k),
                  Status::deployed,
                  std::vector<double>(names.draws.size(), 1.0),
                  std::vector<double>(names.outputs.size(), 0.0),
                  "root>mid>tip",
                  ""};
    for (std::size_t i = 0; i < names.outputs.size(); ++i) {
      if (names.outputs[i] == "root.overtravel") row.outputs[i] = root[k];
      if (names.outputs[i] == "tip.overtravel") row.outputs[i] = 9 * degree; // it has a stop
    }
    (void)statistics.add(row, {});
  }
  const Summary found =
      streaming_summary({"r", campaign, stamp_of(campaign, {})}, statistics, campaign.statistics);
  REQUIRE(found.overtravels.size() == 1);
  CHECK(found.overtravels[0].hinge == "root");
  CHECK(found.overtravels[0].runs == 3);
  CHECK(found.overtravels[0].largest == 40 * degree);
}
