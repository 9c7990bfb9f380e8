#include "montecarlo/foundation/statistics/replicate_bounds.hpp"
#include "tests/montecarlo/sample_support.hpp"
#include "tests/support/random_cases.hpp"

#include <catch2/catch.hpp>

#include <array>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// `replicates` stratified samples of n points each on [0, 1): one point in each n-th, at random.
std::vector<ReplicateValue> stratified(int replicates, int n, std::mt19937_64& random) {
  std::vector<ReplicateValue> values;
  for (int r = 0; r < replicates; ++r)
    for (int i = 0; i < n; ++i) values.push_back({(i + uniform(random)) / n, r});
  std::ranges::sort(values, {}, &ReplicateValue::value);
  return values;
}

std::vector<ReplicateValue> independent(int replicates, int n, std::mt19937_64& random) {
  std::vector<ReplicateValue> values;
  for (int i = 0; i < replicates * n; ++i) values.push_back({uniform(random), i % replicates});
  std::ranges::sort(values, {}, &ReplicateValue::value);
  return values;
}

} // namespace

TEST_CASE("replicate quantile bounds cover about as often as they say, on either side", "[long]") {
  const int trials = random_cases(4000, 1000);
  std::mt19937_64 random(44);
  for (const auto& [replicates, p] : {std::pair{2, 0.5}, {4, 0.9}, {16, 0.9}, {16, 0.98}}) {
    CAPTURE(replicates, p);
    int above = 0, below = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const auto values = independent(replicates, 1024 / replicates, random);
      const Bounds bounds = replicate_quantile_bounds(values, replicates, p, 0.95);
      if (bounds.lower && *bounds.lower > p) ++above;
      if (bounds.upper && *bounds.upper < p) ++below;
    }
    // Student's t on counts is an approximation: half a point on top of the binomial band.
    const double most = 0.025 + 0.005 + band(0.025, trials);
    CHECK((above < most * trials && below < most * trials));
  }
}

TEST_CASE("replicate quantile bounds are not there where so few values lie beyond") {
  std::mt19937_64 random(46);
  const auto values = independent(16, 64, random);
  const Bounds high = replicate_quantile_bounds(values, 16, 0.999, 0.95);
  CHECK((high.lower && !high.upper));
  const Bounds low = replicate_quantile_bounds(values, 16, 0.001, 0.95);
  CHECK((!low.lower && low.upper));
}

TEST_CASE("replicate quantile bounds with missing values: infinite ones in their place") {
  std::mt19937_64 random(47);
  int lost = 0, kept = 0;
  for (int trial = 0; trial < 300; ++trial) {
    constexpr int replicates = 4;
    const bool below = trial % 2 == 0;
    const double in_place = std::numeric_limits<double>::infinity() * (below ? -1 : 1);
    std::vector<ReplicateValue> all = independent(replicates, 25, random), present;
    std::vector<long> missing(replicates, 0);
    const double share = 0.4 * uniform(random);
    for (ReplicateValue& each : all)
      if (uniform(random) < share) {
        ++missing[static_cast<std::size_t>(each.replicate)];
        each.value = in_place;
      } else {
        each.value = std::round(30 * each.value); // ties
        present.push_back(each);
      }
    std::ranges::stable_sort(all, {}, &ReplicateValue::value);
    const double p = 0.02 + 0.96 * uniform(random);
    const Bounds wanted = replicate_quantile_bounds(all, replicates, p, 0.8),
                 found = replicate_quantile_bounds(
                     present, replicates, p, 0.8,
                     {missing, below ? MissingRank::below : MissingRank::above});
    const auto at = [&](MissingRank end) {
      return replicate_quantile_bounds(present, replicates, p, 0.8, {missing, end});
    };
    REQUIRE(at(MissingRank::either).lower == at(MissingRank::below).lower);
    REQUIRE(at(MissingRank::either).upper == at(MissingRank::above).upper);
    for (const auto end : {&Bounds::lower, &Bounds::upper}) {
      const auto value = wanted.*end;
      const bool exists = value && std::isfinite(*value);
      REQUIRE(found.*end == (exists ? value : std::nullopt));
      if (value) ++(exists ? kept : lost);
    }
  }
  CHECK((lost > 30 && kept > 200));
}

TEST_CASE("replicate quantile bounds see what stratification gains, and still cover", "[long]") {
  constexpr int trials = 2000;
  std::mt19937_64 random(45);
  int covered = 0;
  double width = 0, independent_width = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const Bounds bounds = replicate_quantile_bounds(stratified(16, 51, random), 16, 0.5, 0.95);
    if (*bounds.lower <= 0.5 && 0.5 <= *bounds.upper) ++covered;
    width += *bounds.upper - *bounds.lower;
    const Bounds loose = replicate_quantile_bounds(independent(16, 51, random), 16, 0.5, 0.95);
    independent_width += *loose.upper - *loose.lower;
  }
  CHECK(static_cast<double>(covered) / trials == Approx(0.95).margin(0.03 + band(0.95, trials)));
  CHECK(width < 0.3 * independent_width);
}

TEST_CASE("replicate quantile bounds judge tied values together") {
  // 1 in half of the first replicate and in three quarters of the second, 2 in the rest: F is 5/8
  // up to 1 and has the error √(2/1 · 2 · 4²)/8² = 1/8; t of one degree of freedom is 1 at 50 %.
  const std::vector<ReplicateValue> tied{{1, 0}, {1, 0}, {1, 1}, {1, 1},
                                         {1, 1}, {2, 0}, {2, 0}, {2, 1}};
  const auto bounds = [&](double p) { return replicate_quantile_bounds(tied, 2, p, 0.5); };
  CHECK((bounds(0.4).lower == 1 && bounds(0.4).upper == 1));
  CHECK((bounds(0.6).lower == 1 && bounds(0.6).upper == 2));
  CHECK((bounds(0.8).lower == 2 && bounds(0.8).upper == 2));
  CHECK((bounds(0.9).lower == 2 && !bounds(0.9).upper));
}

// scipy 1.10.1: shares 1/4, 2/4, 0/4 have mean 1/4 and standard error 1/4/√3, so nine draws' worth
// less (t_11/t_2)²; beta.ppf(q, x, n − x + 1) and (x + 1, n − x) with x = n/4.
TEST_CASE("replicate proportions: worked by hand") {
  const std::array<long, 3> hits{1, 2, 0}, sizes{4, 4, 4};
  const Bounds wide = replicate_proportion_bounds(hits, sizes, 0.95);
  CHECK(wide.lower.value() == Approx(0.0006096481163780891).epsilon(1e-9));
  CHECK(wide.upper.value() == Approx(0.9136044550442545).epsilon(1e-9));
  const Bounds narrow = replicate_proportion_bounds(hits, sizes, 0.5);
  CHECK(narrow.lower.value() == Approx(0.10683927104434382).epsilon(1e-9));
  CHECK(narrow.upper.value() == Approx(0.45982656264883065).epsilon(1e-9));
}

// By hand: 1 of 4, 2 of 5 and 0 of 3 are 1/4 in all, with an error of √(3/2 · (0 + 0.75² + 0.75²))/12, so 16 draws'
// worth less (t_11/t_2)²; mpmath 1.2.1 as above.
TEST_CASE("replicate proportions of replicates that differ in size: worked by hand") {
  const std::array<long, 3> hits{1, 2, 0}, sizes{4, 5, 3};
  const Bounds wide = replicate_proportion_bounds(hits, sizes, 0.95);
  CHECK(wide.lower.value() == Approx(0.0073014880160256065).epsilon(1e-8));
  CHECK(wide.upper.value() == Approx(0.79556021022363307).epsilon(1e-8));
  const Bounds narrow = replicate_proportion_bounds(hits, sizes, 0.5);
  CHECK(narrow.lower.value() == Approx(0.14427990185073421).epsilon(1e-8));
  CHECK(narrow.upper.value() == Approx(0.39140357539485563).epsilon(1e-8));
}

// By hand: 1, 3, 4, 8 of one replicate, 2, 5 of the next and 6, 7, 9 of the third. Up to 5, the median of the nine,
// are 3 of 4, 2 of 2 and none of 3: F = 5/9, h − F n = 7/9, 8/9, −15/9; below it 3, 1, 0: F = 4/9, 11/9, 1/9, −12/9.
// The larger error is √(3/2 · 338)/81 = 0.27799; t_2 is √(2/3) = 0.8165 at 50 %: 0.5 ∓ 0.22698 are ranks 3 and 7.
TEST_CASE("replicate quantile bounds of replicates that differ in size: worked by hand") {
  std::vector<ReplicateValue> values{{1, 0}, {3, 0}, {4, 0}, {8, 0}, {2, 1},
                                     {5, 1}, {6, 2}, {7, 2}, {9, 2}};
  std::ranges::sort(values, {}, &ReplicateValue::value);
  const Bounds bounds = replicate_quantile_bounds(values, 3, 0.5, 0.5);
  CHECK((bounds.lower == 3 && bounds.upper == 7));
  // At 80 % t_2 = 1.8856, and the reach 0.52419 is more than there is on either side.
  const Bounds wide = replicate_quantile_bounds(values, 3, 0.5, 0.8);
  CHECK((!wide.lower && !wide.upper));
}

TEST_CASE("replicate proportions cover, few hits or many") {
  constexpr int trials = 4000;
  std::mt19937_64 random(47);
  for (const auto& [replicates, p] : {std::pair{2, 0.3}, {16, 0.003}, {16, 0.01}, {16, 0.3}}) {
    CAPTURE(replicates, p);
    const std::vector<long> sizes(static_cast<std::size_t>(replicates), 1024 / replicates);
    int above = 0, below = 0;
    for (int trial = 0; trial < trials; ++trial) {
      std::vector<long> hits(sizes.size(), 0);
      for (int run = 0; run < 1024; ++run)
        if (uniform(random) < p) ++hits[static_cast<std::size_t>(run % replicates)];
      const Bounds bounds = replicate_proportion_bounds(hits, sizes, 0.95);
      if (bounds.lower && *bounds.lower > p) ++above;
      if (bounds.upper && *bounds.upper < p) ++below;
    }
    const double most = 0.025 + 0.005 + band(0.025, trials);
    CHECK((above < most * trials && below < most * trials));
  }
}

TEST_CASE("replicates that agree do so whatever round-off says, and however many there are") {
  for (const long size : {3L, 7L, 1'000'003L}) {
    const std::vector<long> hits(5, 1), sizes(5, size);
    CHECK_FALSE(replicate_proportion_bounds(hits, sizes, 0.95).lower);
  }
  // All agree but for one hit: worth some 10¹¹ independent draws.
  std::vector<long> hits(16, 31'250), sizes(16, 62'500);
  ++hits[0];
  const Bounds bounds = replicate_proportion_bounds(hits, sizes, 0.95);
  CHECK((*bounds.lower < 0.500001 && *bounds.upper > 0.5 && *bounds.upper < 0.50001));
}

// By hand: of replicates {1, 3}, {2}, {6} the mean is 3; the sums of deviations are −2, −1, 3,
// their squares' sum 14, and √(14 · 3/2)/4 = √21/4.
TEST_CASE("a mean's error from replicates: worked by hand") {
  const std::vector<ReplicateValue> values{{1, 0}, {2, 1}, {3, 0}, {6, 2}};
  CHECK(replicate_mean_error(values, 3, 3) == Approx(std::sqrt(21.0) / 4).epsilon(1e-15));
  CHECK(std::isnan(replicate_mean_error(values, 1, 3)));
  CHECK(std::isnan(replicate_mean_error({}, 3, 3)));
}

TEST_CASE("no replicate bounds without a spread to judge from") {
  const std::array<long, 2> hits{2, 2}, sizes{4, 4};
  CHECK_FALSE(replicate_proportion_bounds(hits, sizes, 0.95).lower);
  CHECK_FALSE(
      replicate_proportion_bounds(std::span(hits).first(1), std::span(sizes).first(1), 0.95).upper);
  const std::vector<ReplicateValue> one{{1.0, 0}, {2.0, 0}};
  CHECK_FALSE(replicate_quantile_bounds(one, 1, 0.5, 0.95).lower);
  CHECK_FALSE(replicate_quantile_bounds({}, 4, 0.5, 0.95).lower);
}
