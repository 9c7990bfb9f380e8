#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/foundation/statistics/wilks.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>

using namespace wingspread;
using namespace wingspread::test;

namespace {

using Binomial = boost::math::binomial_distribution<double>;
constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

// scipy 1.10.1, stats.binom.cdf, n found by bisection; 59, 93 and 124 are Wilks' own.
TEST_CASE("Wilks' sample sizes, one-sided and two-sided") {
  struct Case {
    double p, c;
    std::array<long, 3> one_sided, two_sided;
  };
  for (const Case& wilks : {Case{.95, .95, {59, 93, 124}, {93, 153, 208}},
                            {.99, .90, {230, 388, 531}, {388, 667, 926}},
                            {.9973, .90, {852, 1440, 1970}, {1440, 2473, 3433}},
                            {.99865, .95, {2218, 3513, 4662}, {3513, 5742, 7785}}})
    for (long r = 1; r <= 3; ++r) {
      CAPTURE(wilks.p, wilks.c, r);
      const auto i = static_cast<std::size_t>(r - 1);
      CHECK(runs_to_show(wilks.p, wilks.c, r - 1) == wilks.one_sided[i]);
      CHECK(runs_to_show(wilks.p, wilks.c, 2 * r - 1) == wilks.two_sided[i]);
    }
  CHECK(runs_to_show(.9, .95, 9) == 154);
  CHECK(runs_to_show(.9973, .9, 19) == 9591);
  CHECK(runs_to_show(.999999, .9, 0) == 2302584);
  CHECK(runs_to_show(.5, .5, 0) == 1);
  CHECK(runs_to_show(.9, .1, 0) == 1); // 0.9 ≤ 1 − 0.1, but for round-off
  CHECK(runs_to_show(.1, .9, 0) == 1);
  CHECK_FALSE(runs_to_show(1 - 1e-15, .9, 0));
}

// scipy 1.10.1, stats.binom.cdf.
TEST_CASE("how many runs may break a requirement") {
  CHECK(allowed_failures(10000, .99, .90) == 86);
  CHECK(allowed_failures(10000, .9973, .90) == 19);
  CHECK(allowed_failures(1000, .99865, .90) == std::nullopt);
  CHECK(allowed_failures(1704, .99865, .90) == std::nullopt);
  CHECK(allowed_failures(1705, .99865, .90) == 0);
  CHECK(allowed_failures(58, .95, .95) == std::nullopt);
  CHECK(allowed_failures(59, .95, .95) == 0);
  CHECK(allowed_failures(1'000'000, .99865, .95) == 1289);
  CHECK(allowed_failures(100, .3, .9) == 63);
  CHECK(allowed_failures(0, .5, .5) == std::nullopt);
}

TEST_CASE("sizes and allowed failures say the same, and agree with Clopper and Pearson") {
  for (const double p : {.6, .9, .99})
    for (const double c : {.5, .9, .999})
      for (const long k : {0L, 1L, 7L, 40L}) {
        CAPTURE(p, c, k);
        const long n = runs_to_show(p, c, k).value();
        CHECK(allowed_failures(n, p, c) == k);
        CHECK(allowed_failures(n - 1, p, c).value_or(-1) == k - 1);
        CHECK(clopper_pearson_lower(n - k, n, c) >= p - 1e-9);
        CHECK(clopper_pearson_lower(n - k - 1, n, c) < p);
      }
}

// scipy 1.10.1, stats.beta.ppf with hits that need not be whole, every n tried in turn.
TEST_CASE("runs that make a share's interval narrow enough") {
  CHECK(runs_for_width(.1, .95, .5) == 402);
  CHECK(runs_for_width(.01, .95, .02) == 3221);
  CHECK(runs_for_width(.01, .95, 0) == 368);
  CHECK(runs_for_width(.01, .95, 1) == 368);
  CHECK(runs_for_width(.2, .9, .1) == 33);
  CHECK_FALSE(runs_for_width(1e-9, .95, .5));
  const Interval at_402 = clopper_pearson(201, 402, .95), at_400 = clopper_pearson(200, 400, .95);
  CHECK((at_402.upper - at_402.lower <= .1 && at_400.upper - at_400.lower > .1));
}

TEST_CASE("tolerance limits are the order statistics that the table says") {
  std::vector<double> values(124);
  for (int i = 0; i < 124; ++i) values[static_cast<std::size_t>(i)] = i + 1;
  const auto limits = [&](std::size_t n, Side side) {
    return tolerance_limits(std::span(values).first(n), side, .95, .95);
  };
  CHECK_FALSE(limits(58, Side::upper).upper);
  CHECK(limits(59, Side::upper).upper == 59);
  CHECK(limits(93, Side::upper).upper == 92);
  CHECK(limits(124, Side::upper).upper == 122);
  CHECK_FALSE(limits(124, Side::upper).lower);
  CHECK((limits(124, Side::lower).lower == 3 && !limits(124, Side::lower).upper));
  CHECK_FALSE(limits(92, Side::both).upper);
  CHECK((limits(93, Side::both).lower == 1 && limits(93, Side::both).upper == 93));
  values[122] = values[123] = infinity;
  CHECK(limits(124, Side::upper).upper == 122);
  values[121] = infinity;
  CHECK_FALSE(limits(124, Side::upper).upper);
  CHECK((limits(124, Side::both).lower == 1 && !limits(124, Side::both).upper));
}

TEST_CASE("tolerance limits contain their share as often as the binomial law says") {
  constexpr int trials = 4000, n = 160; // 4 may lie above .95; of .9, 4 on either side
  std::mt19937_64 random(51);
  int above = 0, below = 0, within = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const std::vector<double> sample = sorted_sample(n, random);
    if (*tolerance_limits(sample, Side::upper, .95, .9).upper >= .95) ++above;
    if (*tolerance_limits(sample, Side::lower, .95, .9).lower <= .05) ++below;
    const Bounds both = tolerance_limits(sample, Side::both, .9, .9);
    if (*both.upper - *both.lower >= .9) ++within;
  }
  const auto law = [&](double p, long k) {
    return 1 - cdf(Binomial(n, 1 - p), static_cast<double>(k));
  };
  const double one = law(.95, *allowed_failures(n, .95, .9));
  const long both = (*allowed_failures(n, .9, .9) + 1) / 2;
  const double two = law(.9, 2 * both - 1);
  REQUIRE((one >= .9 && two >= .9));
  CHECK(static_cast<double>(above) / trials == Approx(one).margin(band(one, trials)));
  CHECK(static_cast<double>(below) / trials == Approx(one).margin(band(one, trials)));
  CHECK(static_cast<double>(within) / trials == Approx(two).margin(band(two, trials)));
}

// Where P(Bin(n, 1 - p) = 0) = pⁿ is the risk itself: 1 - c, as doubles have it, lies on either side of it.
TEST_CASE("round-off keeps no number of runs from showing what it just shows") {
  for (const double p : {0.3, 0.6, 0.7, 0.8, 0.9, 0.95})
    for (const long n : {1L, 2L, 3L, 5L, 8L}) {
      const double c = 1 - std::pow(p, static_cast<double>(n));
      CAPTURE(p, n);
      CHECK(runs_to_show(p, c, 0) == n);
      CHECK(allowed_failures(n, p, c) == 0);
    }
}
