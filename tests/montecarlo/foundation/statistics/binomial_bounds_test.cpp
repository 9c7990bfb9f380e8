#include "distributions/math_policy.hpp"
#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <catch2/catch.hpp>

#include <array>
#include <limits>

using namespace wingspread;
using namespace wingspread::test;
using Binomial = boost::math::binomial_distribution<double>;

// scipy 1.10.1, special.betaincinv(k, n − k + 1, 0.025) and betaincinv(k + 1, n − k, 0.975). (Its
// proportion_ci stops its root search at 2e-12.)
TEST_CASE("Clopper–Pearson: values of the inverse beta function") {
  const auto check = [](long hits, long n, double lower, double upper, double tolerance) {
    const Interval interval = clopper_pearson(hits, n, 0.95);
    CHECK(interval.lower == Approx(lower).epsilon(tolerance).margin(0));
    CHECK(interval.upper == Approx(upper).epsilon(tolerance).margin(0));
  };
  check(3, 1000, 0.00061910, 0.00874202, 1e-5);
  check(3, 1000, 0.0006190999316494162, 0.008742023238479057, 1e-12);
  check(0, 1000, 0, 0.0036820838968666704, 1e-12);
  check(86, 10000, 0.006884481059510117, 0.010610182806286339, 1e-12);
  check(9998, 10000, 0.9992777199422757, 0.9999757781543596, 1e-12);
  check(10, 10, 0.6915028921812392, 1, 1e-12);
  check(1, 10, 0.0025285785444617848, 0.4450161170281953, 1e-12);
  check(0, 0, 0, 1, 0);
  CHECK(clopper_pearson_upper(0, 1000, 0.95) == Approx(0.00299125).epsilon(1e-5));
  CHECK(clopper_pearson_lower(1000, 1000, 0.95) == Approx(1 - 0.00299125).epsilon(1e-8));
}

TEST_CASE("Clopper–Pearson covers at least as often as it says, for every proportion") {
  for (const double confidence : {0.8, 0.95}) {
    for (double p = 0.01; p < 1; p += 0.01) {
      const Binomial hits(25, p);
      double covered = 0;
      for (long k = 0; k <= 25; ++k) {
        const Interval interval = clopper_pearson(k, 25, confidence);
        if (interval.lower <= p && p <= interval.upper)
          covered += pdf(hits, static_cast<double>(k));
      }
      CHECK(covered >= confidence - 1e-12);
    }
  }
}

// scipy 1.10.1: all ranks tried one by one against binom.cdf and binom.sf.
TEST_CASE("quantile ranks: values of an exhaustive search") {
  struct Case {
    long n;
    double p, confidence;
    long lower, upper;
  };
  for (const Case& c : {Case{10000, .01, .95, 81, 121},
                        {10000, .5, .95, 4902, 5099},
                        {10000, .99, .95, 9880, 9920},
                        {100, .5, .95, 40, 61},
                        {59, .95, .9, 53, 59},
                        {30, .5, .99, 8, 23},
                        {10, .5, .95, 2, 9}}) {
    const RankBounds ranks = quantile_rank_bounds(c.n, c.p, c.confidence);
    CHECK(ranks.lower.value() == c.lower);
    CHECK(ranks.upper.value() == c.upper);
  }
}

// scipy 1.10.1, stats.binom.cdf, n found by bisection: the r-th largest of so many, but not of one
// fewer, is an upper bound with one-sided confidence c; two-sided that is 2c − 1.
TEST_CASE("quantile ranks: Wilks' sample sizes") {
  struct Case {
    double p, c;
    std::array<long, 3> sizes;
  };
  for (const Case& wilks : {Case{.95, .95, {59, 93, 124}},
                            {.99, .90, {230, 388, 531}},
                            {.9973, .90, {852, 1440, 1970}},
                            {.99865, .95, {2218, 3513, 4662}}}) {
    for (long r = 1; r <= 3; ++r) {
      const long n = wilks.sizes[static_cast<std::size_t>(r - 1)];
      CHECK(quantile_rank_bounds(n, wilks.p, 2 * wilks.c - 1).upper == n + 1 - r);
      const auto with_one_fewer = quantile_rank_bounds(n - 1, wilks.p, 2 * wilks.c - 1).upper;
      CHECK(with_one_fewer == (r == 1 ? std::nullopt : std::optional(n + 1 - r)));
    }
  }
}

TEST_CASE("a sample too small for a bound has none") {
  CHECK_FALSE(quantile_rank_bounds(0, 0.5, 0.95).lower);
  CHECK_FALSE(quantile_rank_bounds(0, 0.5, 0.95).upper);
  const RankBounds high = quantile_rank_bounds(1000, 0.9973, 0.9);
  CHECK(high.lower == 994); // scipy, as above
  CHECK_FALSE(high.upper);
  const Bounds bounds = quantile_bounds(std::vector{1.0, 2.0, 3.0}, 0.5, 0.95);
  CHECK((!bounds.lower && !bounds.upper));
}

TEST_CASE("quantile bounds cover as often as the binomial law says", "[long]") {
  constexpr int trials = 20000, n = 60;
  std::mt19937_64 random(42);
  for (const double p : {0.1, 0.5, 0.9}) {
    const RankBounds ranks = quantile_rank_bounds(n, p, 0.9);
    const Binomial below(n, p);
    const double law = cdf(below, static_cast<double>(ranks.upper.value() - 1)) -
                       cdf(below, static_cast<double>(ranks.lower.value() - 1));
    REQUIRE(law >= 0.9);
    int covered = 0;
    for (int trial = 0; trial < trials; ++trial) {
      std::vector<double> sample(n);
      std::ranges::generate(sample, [&] { return uniform(random); });
      std::ranges::sort(sample);
      const Bounds bounds = quantile_bounds(sample, p, 0.9);
      if (*bounds.lower <= p && p <= *bounds.upper) ++covered;
    }
    CHECK(static_cast<double>(covered) / trials == Approx(law).margin(band(law, trials)));
  }
}

TEST_CASE("quantile bounds with missing values are those with infinite ones in their place") {
  std::mt19937_64 random(92);
  int lost = 0, kept = 0;
  for (const bool below : {false, true})
    for (int trial = 0; trial < 300; ++trial) {
      const PartialRanks ranks{static_cast<long>(20 + random() % 60),
                               static_cast<long>(random() % 30),
                               below ? MissingRank::below : MissingRank::above};
      const std::vector<double> present = sorted_sample(static_cast<int>(ranks.present), random);
      std::vector<double> all = present;
      const double in_place = std::numeric_limits<double>::infinity() * (below ? -1 : 1);
      all.insert(below ? all.begin() : all.end(), static_cast<std::size_t>(ranks.missing),
                 in_place);
      const double p = 0.01 + 0.98 * uniform(random);
      const Bounds found = quantile_bounds(present, ranks, p, 0.9),
                   wanted = quantile_bounds(all, p, 0.9);
      for (const auto end : {&Bounds::lower, &Bounds::upper}) {
        const auto value = wanted.*end;
        const bool exists = value && std::isfinite(*value);
        REQUIRE(found.*end == (exists ? value : std::nullopt));
        if (value) ++(exists ? kept : lost);
      }
    }
  CHECK((lost > 50 && kept > 300));
}

TEST_CASE("quantile bounds hold at both ends where missing values may rank at either") {
  std::mt19937_64 random(93);
  int kept = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const long missing = static_cast<long>(random() % 10);
    const std::vector<double> present = sorted_sample(80, random);
    const double p = 0.01 + 0.98 * uniform(random);
    const auto at = [&](MissingRank end) {
      return quantile_bounds(present, {80, missing, end}, p, 0.9);
    };
    const Bounds found = at(MissingRank::either);
    CHECK(found.lower == at(MissingRank::below).lower);
    CHECK(found.upper == at(MissingRank::above).upper);
    if (found.lower && found.upper && missing > 0) ++kept;
  }
  CHECK(kept > 100);
}

TEST_CASE("quantile bounds still cover where values are tied") {
  constexpr int trials = 5000;
  std::mt19937_64 random(43);
  int covered = 0; // of a die, whose 0.4 quantile is 3
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> sample(50);
    std::ranges::generate(sample, [&] { return 1 + std::floor(6 * uniform(random)); });
    std::ranges::sort(sample);
    const Bounds bounds = quantile_bounds(sample, 0.4, 0.9);
    if (*bounds.lower <= 3 && 3 <= *bounds.upper) ++covered;
  }
  CHECK(static_cast<double>(covered) / trials >= 0.9 - band(0.9, trials));
}

TEST_CASE(
    "Clopper–Pearson intervals of simulated campaigns cover as often as the binomial law says") {
  constexpr int trials = 4000, n = 200;
  constexpr double p = 0.03;
  const Binomial hits(n, p);
  const auto covers = [&](long k) {
    const Interval interval = clopper_pearson(k, n, .9);
    return interval.lower <= p && p <= interval.upper;
  };
  double law = 0;
  for (long k = 0; k <= n; ++k)
    if (covers(k)) law += pdf(hits, static_cast<double>(k));
  REQUIRE(law >= .9);
  std::mt19937_64 random(52);
  int covered = 0;
  for (int trial = 0; trial < trials; ++trial) {
    long k = 0;
    for (int run = 0; run < n; ++run) k += uniform(random) < p ? 1 : 0;
    if (covers(k)) ++covered;
  }
  CHECK(static_cast<double>(covered) / trials == Approx(law).margin(band(law, trials)));
}

// As in two_sided_test.cpp.
TEST_CASE("proportions' bounds are evaluated in double") {
  using InDouble = boost::math::binomial_distribution<double, MathPolicy>;
  long differing = 0;
  for (long hits = 1; hits < 200; ++hits) {
    const auto k = static_cast<double>(hits);
    const double bound = InDouble::find_lower_bound_on_p(200, k, 0.05);
    CHECK(clopper_pearson_lower(hits, 200, 0.95) ==
          InDouble::find_lower_bound_on_p(200, k, 1 - 0.95));
    differing += bound != Binomial::find_lower_bound_on_p(200, k, 0.05);
  }
  if (std::numeric_limits<long double>::digits > std::numeric_limits<double>::digits)
    CHECK(differing > 0); // or this test could not fail
}

TEST_CASE(
    "bounds of a share are Clopper–Pearson's where it is one of whole hits, and rise between") {
  for (const double confidence : {0.8, 0.95}) {
    Interval before{-1, -1};
    for (long half = 0; half <= 80; ++half) {
      const Interval bounds =
          clopper_pearson_of_share(static_cast<double>(half) / 80, 40, confidence);
      CAPTURE(confidence, half);
      CHECK((bounds.lower > before.lower || half <= 1 || bounds.lower == 0));
      CHECK((bounds.upper > before.upper || bounds.upper == 1));
      before = bounds;
      if (half % 2 != 0) continue;
      const Interval whole = clopper_pearson(half / 2, 40, confidence);
      CHECK(bounds.lower == Approx(whole.lower).epsilon(1e-10));
      CHECK(bounds.upper == Approx(whole.upper).epsilon(1e-10));
    }
  }
}
