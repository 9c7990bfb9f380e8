#include "distributions/truncated_law.hpp"
#include "tests/distributions/reference_laws.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <vector>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr double round_off = std::numeric_limits<double>::epsilon();

struct Case {
  ContinuousLaw law;
  Truncation interval;
};

// Far tails on both sides, and intervals across the median.
std::vector<Case> cases() {
  return {{Normal{0, 1}, {8, 9}},
          {Normal{0, 1}, {-9, -8}},
          {Normal{0, 1}, {-38, -37}},
          {Normal{0, 1}, {37, 38}},
          {Normal{1, 0.05}, {0.9, 1.2}},
          {Normal{0, 1}, {-1, 20}},
          {Uniform{-1, 2}, {1.9, 1.95}},
          {Triangular{0, 0, 1}, {0.999, 0.9999}},
          {Triangular{1, 2, 2}, {1.001, 1.002}},
          {Lognormal{0, 0.1}, {2, 3}},
          {Lognormal{0, 0.1}, {0.3, 0.5}},
          {Weibull{3.5, 1.2}, {4, 5}},
          {Weibull{2, 1}, {1e-6, 1e-5}},
          {Gamma{4, 0.5}, {50, 60}},
          {Gamma{4, 0.5}, {1e-4, 1e-3}},
          {Beta{2, 3, -1, 4}, {3.99, 3.999}},
          {Beta{30, 4, 10, 20}, {11, 12}},
          {Exponential{1}, {100, 101}}};
}

} // namespace

// Doubles cannot do better than t·round_off where a tail falls like exp(−t), and t is up to 722 here.
TEST_CASE("probabilities in far tails are right to 1e-12") {
  for (const auto& [law, interval] : cases()) {
    const TruncatedLaw t = truncated(law, interval);
    const Long mass = probability(law, interval.lower, interval.upper);
    CAPTURE(law.index(), interval.lower, interval.upper);
    CHECK(std::abs(t.mass / mass - 1) < 1e-12);
    const double grain = 2 * std::numeric_limits<double>::denorm_min() / t.mass; // 1e-24 at worst
    for (const double share : {0.1, 0.5, 0.9}) {
      const double x = interval.lower + share * (interval.upper - interval.lower);
      const Long below = probability(law, interval.lower, x) / mass;
      const Long above = probability(law, x, interval.upper) / mass;
      CHECK(std::abs(cdf(t, x) - below) < 1e-12 * below + grain);
      CHECK(std::abs(cdf_complement(t, x) - above) < 1e-12 * above + grain);
    }
  }
}

TEST_CASE("a truncated quantile has the probability asked for below it") {
  for (const auto& [law, interval] : cases()) {
    const TruncatedLaw t = truncated(law, interval);
    const Long mass = probability(law, interval.lower, interval.upper);
    for (const double u : {1e-6, 0.01, 0.3, 0.5, 0.9, 0.999}) {
      CAPTURE(law.index(), interval.lower, interval.upper, u);
      const double x = quantile(t, u);
      const double y = quantile_complement(t, u);
      // what 4 ulp of the point are worth in probability
      const auto slack = [&](double at) {
        return 4 * round_off * std::abs(at) * density(law, at) / mass;
      };
      CHECK(std::abs(probability(law, interval.lower, x) / mass - u) < 1e-12 * u + slack(x));
      CHECK(std::abs(probability(law, y, interval.upper) / mass - u) < 1e-12 * u + slack(y));
    }
  }
}

TEST_CASE("truncated values rise with u and never leave the interval") {
  for (const auto& [law, interval] : cases()) {
    const TruncatedLaw t = truncated(law, interval);
    CAPTURE(law.index(), interval.lower, interval.upper);
    CHECK(quantile(t, 0) == interval.lower);
    CHECK(quantile(t, 1) == interval.upper);
    CHECK(quantile_complement(t, 0) == interval.upper);
    CHECK(quantile_complement(t, 1) == interval.lower);
    double last = interval.lower;
    for (const double u : {0x1p-53, 1e-9, 0.1, 0.4, 0.6, 0.9, 1 - 1e-9, 1 - 0x1p-53}) {
      const double x = quantile(t, u);
      CHECK(last <= x);
      CHECK(x <= interval.upper);
      last = x;
    }
  }
}

TEST_CASE("beyond the interval there is no probability") {
  const TruncatedLaw t = truncated(Normal{0, 1}, {-1, 2});
  CHECK(cdf(t, -5) == 0);
  CHECK(cdf_complement(t, -5) == 1);
  CHECK(cdf(t, 5) == 1);
  CHECK(cdf_complement(t, 5) == 0);
}

TEST_CASE("an interval as wide as the law changes nothing") {
  for (const ContinuousLaw& law : reference_laws()) {
    const TruncatedLaw t = truncated(law, {});
    CHECK(t.mass == 1);
    for (const double u : {0x1p-53, 0.1, 0.5, 0.7, 1 - 0x1p-53})
      CHECK(quantile(t, u) == inverse(law, {u, 1 - u}));
  }
}

TEST_CASE("an interval wider than the support ends where the support does") {
  const TruncatedLaw t = truncated(Weibull{2, 1}, {-1, 0.5});
  CHECK(t.bounds.lower == 0);
  CHECK(quantile(t, 0) == 0);
  CHECK(quantile(t, 0.5) > 0);
  CHECK(t.mass == Approx(-std::expm1(-0.25)).epsilon(4 * round_off));
}

TEST_CASE("without probability there is no mass") {
  CHECK_FALSE(truncated(Uniform{0, 1}, {2, 3}).mass > 0);
  CHECK_FALSE(truncated(Normal{0, 1}, {40, 41}).mass > 0);
  CHECK_FALSE(truncated(Exponential{1}, {-3, -2}).mass > 0);
}
