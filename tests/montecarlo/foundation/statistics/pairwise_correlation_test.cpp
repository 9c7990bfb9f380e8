#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/foundation/statistics/pairwise_correlation.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <unordered_map>

using namespace wingspread;
using namespace wingspread::test;

namespace {

using Columns = std::vector<Spilled<double>>;

std::vector<RankedColumn> ranked(const Columns& columns, int threads = 1) {
  std::vector<const Spilled<double>*> values;
  for (const Spilled<double>& column : columns) values.push_back(&column);
  return rank_columns(values, threads);
}

Correlation of_pair(const std::vector<double>& x, const std::vector<double>& y) {
  return pairwise_correlations(ranked({x}), ranked({y})).front();
}

/// Columns with ties, of which some lack values: every third row, say, is missing in the third.
Columns with_gaps(std::uint64_t seed, std::size_t rows, const std::vector<std::size_t>& gaps) {
  std::mt19937_64 random(seed);
  Columns columns;
  for (const std::size_t gap : gaps) {
    Spilled<double> column;
    for (std::size_t row = 0; row < rows; ++row)
      column.push_back(gap > 0 && row % gap == 0 ? none : std::floor(1000 * uniform(random)));
    columns.push_back(std::move(column));
  }
  return columns;
}

/// Mid-ranks by the definition: (values below) + (1 + values that are the same)/2.
std::vector<double> ranks_of(const std::vector<double>& values) {
  const std::vector<double> sorted = sorted_present(values);
  std::unordered_map<double, double> rank_of;
  for (std::size_t first = 0, end = 0; first < sorted.size(); first = end) {
    while (end < sorted.size() && sorted[end] == sorted[first]) ++end;
    rank_of[sorted[first]] = static_cast<double>(first + end + 1) / 2;
  }
  std::vector<double> ranks;
  for (const double value : values) ranks.push_back(rank_of.at(value));
  return ranks;
}

/// A pair's correlations, row by row.
Correlation expected(const Spilled<double>& x, const Spilled<double>& y) {
  std::vector<double> x_both, y_both;
  for (std::size_t row = 0; row < x.size(); ++row) {
    if (std::isnan(x[row]) || std::isnan(y[row])) continue;
    x_both.push_back(x[row]);
    y_both.push_back(y[row]);
  }
  return {std::ssize(x_both), pearson(x_both, y_both), pearson(ranks_of(x_both), ranks_of(y_both))};
}

bool same_bits(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) ||
         std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same(const Correlation& a, const Correlation& b) {
  return a.count == b.count && same_bits(a.pearson, b.pearson) && same_bits(a.spearman, b.spearman);
}

} // namespace

// scipy 1.10.1: pearsonr and spearmanr (mid-ranks) of these values.
TEST_CASE("correlations with ties: published values") {
  const std::vector<double> x{3, 1, 4, 1, 5, 9, 2, 6, 5, 3, 5}, y{2, 7, 1, 8, 2, 8, 1, 8, 2, 8, 4};
  const Correlation c = of_pair(x, y);
  CHECK(c.count == 11);
  CHECK(c.pearson == within(0.09422924859889797, 16 * epsilon));
  CHECK(c.spearman == within(0.1384567651467695, 16 * epsilon));
  const Spilled<double> column(y);
  CHECK(RankedColumn(column).ranks() ==
        std::vector<double>{4, 7, 1.5, 9.5, 4, 9.5, 1.5, 9.5, 4, 9.5, 6});
}

TEST_CASE("correlations: monotone, linear, constant, too few") {
  const std::vector<double> x = uniforms(6, 200);
  std::vector<double> linear, cubed, falling;
  for (const double value : x) {
    linear.push_back(1e9 + 1024 * value);
    cubed.push_back(value * value * value);
    falling.push_back(-value);
  }
  CHECK(of_pair(x, linear).pearson == Approx(1).epsilon(1e-12));
  CHECK(of_pair(x, cubed).spearman == Approx(1).epsilon(4 * epsilon));
  CHECK(of_pair(x, cubed).pearson < 0.95);
  CHECK(of_pair(x, falling).pearson == Approx(-1).epsilon(4 * epsilon));
  const std::vector<double> constant(200, 0.1);
  const Correlation c = of_pair(x, constant);
  CHECK((c.count == 200 && std::isnan(c.pearson) && std::isnan(c.spearman)));
  const std::vector<double> single{1};
  CHECK(std::isnan(of_pair(single, single).pearson));
}

TEST_CASE("correlations are over the rows in which both happened") {
  std::mt19937_64 random(8);
  std::vector<double> x, y, x_both, y_both;
  for (int i = 0; i < 300; ++i) {
    x.push_back(random() % 5 == 0 ? none : std::floor(20 * uniform(random)));
    y.push_back(random() % 4 == 0 ? none : std::floor(20 * uniform(random)) + x.back());
    if (std::isnan(x.back()) || std::isnan(y.back())) continue;
    x_both.push_back(x.back());
    y_both.push_back(y.back());
  }
  const Correlation c = of_pair(x, y);
  const Correlation expected = of_pair(x_both, y_both);
  CHECK(c.count == static_cast<long>(x_both.size()));
  CHECK(c.pearson == expected.pearson);
  CHECK(c.spearman == expected.spearman);
}

TEST_CASE("many columns at once have each pair's bits, on any number of threads", "[parallel]") {
  for (const std::size_t rows : {0, 1, 700, 70'000}) { // the last are in files
    Columns x = with_gaps(21, rows, {0, 0, 3, 0, 1}), y = with_gaps(22, rows, {0, 5, 0, 5, 7, 1});
    x.emplace_back(rows, 0.25);
    std::vector<Correlation> each;
    for (const auto& one : x)
      for (const auto& other : y) each.push_back(expected(one, other));
    for (const int threads : {1, 2, 5}) {
      const auto found = pairwise_correlations(ranked(x, threads), ranked(y, threads), threads);
      REQUIRE(found.size() == each.size());
      bool all = true;
      for (std::size_t pair = 0; pair < found.size(); ++pair)
        all = all && same(found[pair], each[pair]);
      CHECK(all);
    }
  }
}

TEST_CASE("where there is work for a team it has the bits of one thread", "[parallel]") {
  const std::size_t enough = 1 + static_cast<std::size_t>(operations_worth_threads) / (2 * 3 * 3);
  for (const std::size_t rows : {enough - 2, enough}) { // below and above, of the complete pairs
    const Columns x = with_gaps(21, rows, {0, 3, 0, 0}), y = with_gaps(22, rows, {0, 0, 5, 0});
    const auto alone = pairwise_correlations(ranked(x), ranked(y));
    for (const int threads : {2, 5}) {
      const auto found = pairwise_correlations(ranked(x, threads), ranked(y, threads), threads);
      CHECK(std::ranges::equal(found, alone, same));
    }
  }
}

TEST_CASE("no columns have no correlations") {
  CHECK(pairwise_correlations({}, ranked({{1, 2}})).empty());
  CHECK(pairwise_correlations(ranked({{1, 2}}), {}).empty());
}
