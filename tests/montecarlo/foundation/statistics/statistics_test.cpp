#include "montecarlo/foundation/statistics/statistics.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <random>

using namespace wingspread;
using namespace wingspread::test;

namespace {

using Quad = boost::multiprecision::cpp_bin_float_quad;

/// NIST's NumAcc: `centre`, then centre − 0.1 and centre + 0.1 alternating, 1001 values.
std::vector<double> numacc(double centre, double below, double above) {
  std::vector<double> values{centre};
  for (int i = 0; i < 500; ++i) values.insert(values.end(), {below, above});
  return values;
}

} // namespace

TEST_CASE("the compensated sum keeps what a plain one loses") {
  Sum sum;
  for (const double term : {1.0, 1e100, 1.0, -1e100}) sum.add(term); // Neumaier's own example
  CHECK(sum.value() == 2);
}

// NIST Statistical Reference Datasets, univariate summary statistics, certified values
// (itl.nist.gov/div898/strd/univ): exact for the decimal data. The data as doubles are off by half
// a unit in the last place of their mean, which limits the standard deviation.
TEST_CASE("moments: NIST's certified mean and standard deviation") {
  const auto check = [](const std::vector<double>& values, double mean, double std) {
    const Moments m = moments(values);
    CHECK(m.mean == within(mean, 4 * epsilon));
    CHECK(m.std == within(std, 4 * epsilon * (1 + std::abs(mean) / std)));
  };
  check({10000001, 10000003, 10000002}, 10000002, 1);                 // NumAcc1
  check(numacc(1.2, 1.1, 1.3), 1.2, 0.1);                             // NumAcc2
  check(numacc(1000000.2, 1000000.1, 1000000.3), 1000000.2, 0.1);     // NumAcc3
  check(numacc(10000000.2, 10000000.1, 10000000.3), 10000000.2, 0.1); // NumAcc4
}

TEST_CASE("moments: small noise on a mean of 1e9 costs nothing") {
  std::vector<double> noise, values;
  for (const double u : uniforms(3, 10000)) {
    noise.push_back(std::round(u * 1024) / 1024); // 1e9 + noise is exact
    values.push_back(1e9 + noise.back());
  }
  const Moments m = moments(values), expected = moments(noise);
  CHECK(m.mean == within(1e9 + expected.mean, epsilon));
  CHECK(m.std == within(expected.std, 8 * epsilon));
  CHECK(m.skewness == Approx(expected.skewness).margin(1e-12));
  CHECK(m.kurtosis == within(expected.kurtosis, 1e-12));
}

// Deviations from the smallest value would leave the mean an error of 2e-12.
TEST_CASE("moments: a sorted sample and its mirror image have the digits of quad sums") {
  std::vector<double> values = uniforms(8, 20'001);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = i < 3 ? -1e4 * (1 + values[i]) : i % 2 == 0 ? 1.1 : 1.3;
  for (const double sign : {1.0, -1.0}) {
    CAPTURE(sign);
    std::vector<double> sorted;
    for (const double value : values) sorted.push_back(sign * value);
    sort_values(sorted);
    const auto n = static_cast<Quad>(sorted.size());
    Quad mean = 0, m2 = 0, m3 = 0, m4 = 0;
    for (const double value : sorted) mean += value / n;
    for (const double value : sorted) {
      const Quad d = value - mean;
      m2 += d * d / n, m3 += d * d * d / n, m4 += d * d * d * d / n;
    }
    const Moments found = moments(sorted);
    const auto expected = [&](const Quad& value) {
      return within(static_cast<double>(value), 1e-14);
    };
    CHECK(found.mean == expected(mean));
    CHECK(found.std == expected(sqrt(m2 * n / (n - 1))));
    CHECK(found.skewness == expected(m3 / (m2 * sqrt(m2)) * sqrt(n * (n - 1)) / (n - 2)));
    CHECK(found.kurtosis ==
          expected((n - 1) / ((n - 2) * (n - 3)) * ((n + 1) * (m4 / (m2 * m2) - 3) + 6)));
  }
}

// Microsoft's documentation of Excel's SKEW and KURT prints 0.359543 and −0.151799637; the digits
// beyond are scipy 1.10.1's, skew(x, bias=False) and kurtosis(x, bias=False).
TEST_CASE("moments: published skewness and kurtosis") {
  const Moments m = moments(std::vector<double>{3, 4, 5, 2, 3, 4, 5, 6, 4, 7});
  CHECK(m.count == 10);
  CHECK(m.skewness == within(0.35954307140679753, 16 * epsilon));
  CHECK(m.kurtosis == within(-0.15179963720841405, 64 * epsilon));
  CHECK((m.min == 2 && m.max == 7));
  const Moments pi = moments(std::vector<double>{3, 1, 4, 1, 5, 9, 2, 6, 5, 3, 5}); // scipy 1.10.1
  CHECK(pi.mean == 4);
  CHECK(pi.std == within(std::sqrt(5.6), 4 * epsilon));
  CHECK(pi.skewness == within(0.664049771572406, 16 * epsilon));
  CHECK(pi.kurtosis == within(0.6505102040816322, 64 * epsilon));
}

TEST_CASE("moments: what a sample does not define is NaN") {
  CHECK(std::isnan(moments(std::span<const double>{}).mean));
  CHECK(moments(std::span<const double>{}).count == 0);
  const Moments one = moments(std::vector{5.0});
  CHECK((one.mean == 5 && one.min == 5 && one.max == 5));
  CHECK((std::isnan(one.std) && std::isnan(one.skewness) && std::isnan(one.kurtosis)));
  const Moments two = moments(std::vector{5.0, 7.0});
  CHECK(two.std == within(std::sqrt(2.0), epsilon));
  CHECK((std::isnan(two.skewness) && std::isnan(two.kurtosis)));
  CHECK(std::isnan(moments(std::vector{5.0, 7.0, 8.0}).kurtosis));
  const Moments constant = moments(std::vector(7, 0.1));
  CHECK((constant.mean == 0.1 && constant.std == 0));
  CHECK((std::isnan(constant.skewness) && std::isnan(constant.kurtosis)));
}

TEST_CASE("moments follow an affine map, over all magnitudes") {
  std::vector<double> values = uniforms(4, 999);
  for (double& value : values) value *= value;
  const Moments m = moments(values);
  for (const double scale : {1e-200, 1e-3, -2.0, 1e150}) {
    std::vector<double> mapped;
    for (const double value : values) mapped.push_back(scale * value);
    const Moments after = moments(mapped);
    CHECK(after.mean == within(scale * m.mean, 8 * epsilon));
    CHECK(after.std == within(std::abs(scale) * m.std, 8 * epsilon));
    CHECK(after.skewness == within(std::copysign(m.skewness, scale * m.skewness), 1e-12));
    CHECK(after.kurtosis == within(m.kurtosis, 1e-12));
  }
}

TEST_CASE("quantile ranks are ⌈np⌉ whatever round-off does to np") {
  for (long n = 1; n <= 400; ++n)
    for (long percent = 0; percent <= 100; ++percent)
      REQUIRE(quantile_rank(n, static_cast<double>(percent) / 100) ==
              std::max(1L, (n * percent + 99) / 100));
  CHECK(quantile_rank(1'000'000, 0.99865) == 998650);
  CHECK(quantile_rank(10, std::nextafter(0.3, 1) + 1e-12) == 4);
}

TEST_CASE("quantiles invert the empirical distribution function") {
  std::vector<double> sorted = uniforms(5, 101);
  for (double& value : sorted) value = std::round(20 * value); // ties
  std::ranges::sort(sorted);
  for (const double p : {0.001, 0.1, 0.25, 0.5, 0.77, 0.999}) {
    const double q = quantile(sorted, p);
    const auto share = [&](auto end) { return static_cast<double>(end - sorted.begin()) / 101; };
    CHECK(share(std::ranges::upper_bound(sorted, q)) >= p);
    CHECK(share(std::ranges::lower_bound(sorted, q)) < p);
  }
  CHECK(quantile(std::vector{1.0, 2.0, 3.0, 4.0}, 0.5) == 2);
  CHECK(std::isnan(quantile(std::span<const double>(), 0.5)));
}

TEST_CASE("a quantile with missing values is that with infinite ones in their place") {
  std::mt19937_64 random(91);
  int existing = 0, absent = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const PartialRanks ranks{static_cast<long>(1 + random() % 30), static_cast<long>(random() % 9),
                             random() % 2 == 0 ? MissingRank::below : MissingRank::above};
    const bool below = ranks.end == MissingRank::below;
    const std::vector<double> present = sorted_sample(static_cast<int>(ranks.present), random);
    std::vector<double> all = present;
    const double in_place = std::numeric_limits<double>::infinity() * (below ? -1 : 1);
    all.insert(below ? all.begin() : all.end(), static_cast<std::size_t>(ranks.missing), in_place);
    const double p = trial % 5 == 0 ? static_cast<double>(random() % 11) / 10 : uniform(random);
    const double found = quantile(present, ranks, p), wanted = quantile(all, p);
    REQUIRE((std::isinf(wanted) ? std::isnan(found) : found == wanted));
    ++(std::isinf(wanted) ? absent : existing);
  }
  CHECK((existing > 500 && absent > 100));
  CHECK(std::isnan(quantile({}, PartialRanks{0, 3}, 0.5)));
  const std::vector<double> ten{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  CHECK(quantile(ten, {10, 0, MissingRank::either}, 0.5) == 5); // nothing is missing
  CHECK(quantile(ten, {10, 1, MissingRank::either}, 0.5) == quantile(ten, {10, 1}, 0.5));
}

TEST_CASE("sorted_present leaves NaN out") {
  CHECK(sorted_present(std::vector{3.0, none, -1.0, none}) == std::vector{-1.0, 3.0});
}

TEST_CASE("values of every size and sign are sorted, −0 before 0") {
  std::mt19937_64 random(11);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const std::size_t n : {0u, 1u, 2u, 30u, 5000u}) {
    std::vector<double> values(n);
    for (double& value : values) {
      const double size = std::exp(1400 * (uniform(random) - 0.5)); // 1e-304 … 1e304
      const double kind = uniform(random);
      value = kind < 0.1 ? 0.0 : kind < 0.2 ? -0.0 : kind < 0.6 ? size : -size;
    }
    if (n > 2) values[0] = infinity, values[1] = -infinity, values[2] = 5e-324;
    std::vector<double> expected = values;
    std::ranges::sort(expected, [](double a, double b) { return std::strong_order(a, b) < 0; });
    sort_values(values);
    CAPTURE(n);
    CHECK(std::ranges::equal(values, expected, [](double a, double b) {
      return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
    }));
  }
}
