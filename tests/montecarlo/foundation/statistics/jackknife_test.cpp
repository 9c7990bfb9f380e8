#include "montecarlo/foundation/statistics/jackknife.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/foundation/statistics/two_sided.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <vector>

using namespace wingspread;

// By hand: of 1, 2 and 3 the squares of the deviations sum to 2, s² = 2/3 · 2 = 4/3; Student's t of
// two degrees of freedom is c √(2/(1 − c²)).
TEST_CASE("the jackknife's bounds: worked by hand") {
  const double c = 0.95, reach = c * std::sqrt(2 / (1 - c * c)) * std::sqrt(4.0 / 3);
  const Bounds bounds = jackknife_bounds(2.5, std::vector<double>{1, 2, 3}, c);
  CHECK(*bounds.lower == Approx(2.5 - reach).epsilon(1e-12));
  CHECK(*bounds.upper == Approx(2.5 + reach).epsilon(1e-12));
  const Bounds of_r = jackknife_correlation_bounds(
      0.3, std::vector<double>{std::tanh(0.1), std::tanh(0.2), std::tanh(0.3)}, c);
  CHECK(*of_r.lower == Approx(std::tanh(std::atanh(0.3) - reach / 10)).epsilon(1e-12));
  CHECK(*of_r.upper == Approx(std::tanh(std::atanh(0.3) + reach / 10)).epsilon(1e-12));
}

TEST_CASE("a mean's jackknife error is its standard error") {
  const std::vector<double> values{3, -1, 4, 1, -5, 9, 2, 6};
  const Moments all = moments(values);
  std::vector<double> without;
  for (const double value : values) without.push_back((8 * all.mean - value) / 7);
  const Bounds bounds = jackknife_bounds(all.mean, without, 0.9);
  CHECK((*bounds.upper - *bounds.lower) / 2 ==
        Approx(two_sided_student(7, 0.9) * all.std / std::sqrt(8.0)).epsilon(1e-12));
}

TEST_CASE("no jackknife bounds without a spread to judge from") {
  CHECK_FALSE(jackknife_bounds(1, {}, 0.95).lower);
  CHECK_FALSE(jackknife_bounds(1, std::vector<double>{1}, 0.95).lower);
  CHECK_FALSE(jackknife_bounds(1, std::vector<double>{2, 2, 2}, 0.95).lower);
  CHECK_FALSE(jackknife_bounds(1, std::vector<double>{2, NAN, 3}, 0.95).upper);
  CHECK_FALSE(jackknife_bounds(NAN, std::vector<double>{2, 3}, 0.95).upper);
  CHECK_FALSE(jackknife_correlation_bounds(1, std::vector<double>{1, 1, 1}, 0.95).upper);
}
