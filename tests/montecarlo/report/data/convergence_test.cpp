#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/report/data/convergence.hpp"
#include "tests/montecarlo/report/data/page_support.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("runs of a convergence are even in the logarithm and end with all", "[page]") {
  CHECK(convergence_runs(1000, 3) == std::vector<long>{10, 100, 1000});
  CHECK(convergence_runs(1, 40) == std::vector<long>{1});
  CHECK(convergence_runs(4, 40) == std::vector<long>{4});
  CHECK(convergence_runs(1'000'000, 40).size() == 40);
}

TEST_CASE("a convergence is of the first runs, by hand", "[page]") {
  const Column column = column_of("x", {4, nothing, 2, 6, 8, 1, 3, 5, 7, 9, 11, 13});
  const SortedWithConvergence sorted_column = sort_with_convergence(column, 0.5, 0.95, {}, 3);
  const auto& points = sorted_column.convergence.points; // after 10, 11 and 12 runs
  REQUIRE(points.size() == 3);
  CHECK(points[0].runs == 10);
  CHECK(points[0].mean == 5); // 1 … 9
  CHECK(points[0].quantile == 5);
  const double error = std::sqrt(7.5 / 9); // variance of 1 … 9 is 7.5
  CHECK(*points[0].mean_bounds.upper ==
        Approx(5 + 2.306004135204166 * error).epsilon(1e-12)); // t of 8
  CHECK(points[2].mean == Approx(69.0 / 11));
  CHECK(sorted_column.sorted == std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 13});
  const PartialRanks with_missing{11, 1};
  CHECK(points[2].quantile_bounds.lower ==
        quantile_bounds(sorted_column.sorted, with_missing, 0.5, 0.95).lower);
  CHECK(points[2].quantile == 6); // the sixth of twelve, the missing one the last
  CHECK(sort_with_convergence(column, 0.5, 0.95, {}, 3, MissingRank::below)
            .convergence.points[2]
            .quantile == 5);
  CHECK(
      std::isnan(sort_with_convergence(column, 0.95, 0.95, {}, 3).convergence.points[2].quantile));
}

TEST_CASE("a convergence ends where the summary stands, of replicates too", "[page]") {
  std::mt19937_64 random(5);
  std::vector<double> values(2000);
  for (double& value : values) value = uniform(random) < 0.1 ? nothing : uniform(random);
  const Column column = column_of("x", values);
  Replication replication{4, {}};
  for (int row = 0; row < 2000; ++row) replication.of_row.push_back(row / 500);
  Results results(ResultNames{{}, {"x"}, false});
  for (int row = 0; row < 2000; ++row)
    results.append({row, Status::deployed, {}, {values[static_cast<std::size_t>(row)]}, "a", ""});
  const double p = 0.8;
  const OutputSummary summary = summarize(results, {.quantiles = {p}}, replication).outputs[0];
  const SortedWithConvergence sorted_column =
      sort_with_convergence(column, p, 0.95, replication, 20);
  const ConvergencePoint& last = sorted_column.convergence.points.back();
  CHECK(last.mean == summary.moments.mean);
  CHECK(last.quantile == summary.quantiles[0].all.value);
  CHECK(last.quantile_bounds.lower == summary.quantiles[0].all.bounds.lower);
  CHECK(*last.mean_bounds.upper - last.mean ==
        Approx(3.182446305284263 * summary.mean_error));              // t of 3
  CHECK(!sorted_column.convergence.points.front().mean_bounds.lower); // one replicate tells nothing
  CHECK(sorted_column.replicated.size() == sorted_column.sorted.size());
}
