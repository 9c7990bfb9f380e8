#include "montecarlo/statistics/rank_correlation.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;

// Python 3.11, math: tanh(atanh(r) ∓ 1.959963984540054 √((1 + r²/2)/(n − g − 3))).
TEST_CASE("bounds of a rank correlation: worked by hand") {
  const Bounds bounds = rank_correlation_bounds(0.5, 103, 0, 0.95);
  CHECK(*bounds.lower == Approx(0.32874503087588147).epsilon(1e-12));
  CHECK(*bounds.upper == Approx(0.6394198469997987).epsilon(1e-12));
  const Bounds held = rank_correlation_bounds(-0.5, 103, 60, 0.95);
  CHECK(*held.lower == Approx(-0.7054170141941147).epsilon(1e-12));
  CHECK(*held.upper == Approx(-0.21709957038485012).epsilon(1e-12));
}

TEST_CASE("few rows have no bounds, and a coefficient of 1 is its own") {
  CHECK(!rank_correlation_bounds(0.5, 10, 7, 0.95).lower);
  CHECK(rank_correlation_bounds(0.5, 11, 7, 0.95).lower);
  CHECK(*rank_correlation_bounds(1, 100, 0, 0.95).lower == 1);
}

// By hand: with C = [1 c; c 1], the textbook's r_0 = (a − c b)/√((1 − c²)(1 − b²)).
TEST_CASE("partial coefficients of two columns from their correlations") {
  const PartialCorrelations partial({{1, 2, 3, 4}, {2, 1, 4, 3}}); // c = 0.6
  CHECK((partial.varying() == 2 && !partial.entangled()));
  const std::vector<double> r = partial.given(std::vector{0.5, -0.2});
  CHECK(r[0] == Approx((0.5 + 0.6 * 0.2) / std::sqrt(0.64 * 0.96)).epsilon(1e-13));
  CHECK(r[1] == Approx((-0.2 - 0.6 * 0.5) / std::sqrt(0.64 * 0.75)).epsilon(1e-13));
}

TEST_CASE("a column that does not vary has no partial coefficient, and twins have none either") {
  const PartialCorrelations fixed({{1, 2, 3, 4}, {7, 7, 7, 7}});
  CHECK((fixed.varying() == 1 && !fixed.entangled()));
  CHECK(fixed.given(std::vector<double>{0.5, NAN})[0] == 0.5);
  CHECK(std::isnan(fixed.given(std::vector<double>{0.5, NAN})[1]));
  const PartialCorrelations twins({{1, 2, 3, 4}, {8, 6, 4, 2}});
  CHECK(twins.entangled());
  CHECK(std::isnan(twins.given(std::vector{0.5, -0.5})[0]));
}
