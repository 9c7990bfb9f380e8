#include "montecarlo/analyses/margin/margin_report.hpp"
#include "montecarlo/analyses/margin/margin_result.hpp"
#include "tests/montecarlo/csv_support.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("draws that do not go with the others are counted at the edge where they are",
          "[margin]") {
  const auto scale_with = [](std::vector<long> broken) {
    Verdict verdict;
    verdict.broken = std::move(broken);
    return ScaleResult{CaseResult{{}, {verdict}}};
  };
  MarginSearch search;
  search.seen = {{0.5, scale_with({3, 1, 2})}, {0.6, scale_with({1, 2})}, {0.7, scale_with({4, 1})},
                 {0.8, scale_with({})},        {0.9, scale_with({5})},    {1.0, scale_with({})},
                 {1.1, scale_with({6, 7})}};
  const OutOfOrder found = out_of_order(search, {0, 0}, 0.8);
  CHECK(found.lower == 1);            // 4, which kept to it at 0.6
  CHECK(found.upper == 1);            // 5, which keeps to it at 1.0
  search.seen[0.8] = scale_with({9}); // on both sides of the middle
  const OutOfOrder there = out_of_order(search, {0, 0}, 0.8);
  CHECK((there.lower == 2 && there.upper == 2));
}

// Of 4 runs 3 deployed; Clopper and Pearson's bounds at 90 %: 4p³ − 3p⁴ = 0.05 and p⁴ = 0.95.
TEST_CASE("the share that deployed is of all of a case's runs", "[margin]") {
  CaseResult one;
  one.statuses[static_cast<std::size_t>(Status::deployed)] = 3;
  one.statuses[static_cast<std::size_t>(Status::timed_out)] = 1;
  const DeployedShare found = deployed_share(one, 0.9);
  CHECK((found.runs == 4 && found.share == 0.75));
  const double p = found.bounds.lower;
  CHECK(4 * p * p * p - 3 * p * p * p * p == Approx(0.05).epsilon(1e-12));
  CHECK(found.bounds.upper == Approx(std::pow(0.95, 0.25)).epsilon(1e-12));
  CHECK(std::isnan(deployed_share({}, 0.9).share));
}

TEST_CASE("margin.csv has each number of a verdict in the column of its name", "[margin]") {
  const Campaign campaign = campaign_of(one_panel_margin(100));
  MarginResult result;
  result.cases = {{"cold", {}}};
  CaseResult one;
  one.statuses[static_cast<std::size_t>(Status::deployed)] = 75;
  one.statuses[static_cast<std::size_t>(Status::stalled)] = 25;
  Verdict verdict;
  verdict.requirement = campaign.requirements.at(1);
  verdict.decision = Decision::fail;
  verdict.broken = {4, 9, 2};
  verdict.allowed = 7, verdict.share = 0.75, verdict.guaranteed_share = 0.625;
  verdict.observed = -0.875, verdict.guaranteed = -0.9375;
  one.verdicts = {verdict};
  MarginSearch& search = result.searches.emplace_back();
  search.name = "joint", search.seen = {{1.25, {one}}};
  const auto rows = rows_by_name(margin_csv(campaign, result));
  REQUIRE(rows.size() == 1);
  CsvRow found = rows.front();
  const DeployedShare deployed = deployed_share(one, campaign.statistics.confidence);
  CHECK(std::stod(found["deployed_lower"]) == deployed.bounds.lower);
  CHECK(std::stod(found["deployed_upper"]) == deployed.bounds.upper);
  for (const char* name : {"deployed_lower", "deployed_upper"}) found.erase(name);
  CHECK(found == CsvRow{{"search", "joint"},
                        {"scale", "1.25"},
                        {"case", "cold"},
                        {"runs", "100"},
                        {"deployed", "0.75"},
                        {"requirement", to_string(verdict.requirement)},
                        {"output", "root.latch_rate"},
                        {"limit", "-0.80000000000000004"},
                        {"probability", "0.96999999999999997"},
                        {"confidence", "0.90000000000000002"},
                        {"verdict", "fail"},
                        {"broken", "3"},
                        {"allowed", "7"},
                        {"share", "0.75"},
                        {"guaranteed_share", "0.625"},
                        {"observed", "-0.875"},
                        {"guaranteed", "-0.9375"}});
}
