#include "montecarlo/analyses/margin/margin_result.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;

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
