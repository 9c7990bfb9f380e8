#include "distributions/math_policy.hpp"
#include "montecarlo/foundation/statistics/two_sided.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numbers>

using namespace wingspread;

TEST_CASE("the normal law's two-sided quantile is the inverse of erf") {
  for (const double confidence : {0.01, 0.5, 0.95, 0.999999})
    CHECK(std::erf(two_sided_normal(confidence) / std::numbers::sqrt2) ==
          Approx(confidence).epsilon(1e-14));
}

// With one degree of freedom the law is Cauchy's; with two, its quantile is c √(2/(1 − c²)); with
// many it tends to the normal law's as z + (z³ + z)/4ν (Fisher's expansion).
TEST_CASE("Student's two-sided quantile in closed form") {
  for (const double c : {0.05, 0.5, 0.95, 0.9999}) {
    CHECK(two_sided_student(1, c) == Approx(std::tan(std::numbers::pi * c / 2)).epsilon(1e-11));
    CHECK(two_sided_student(2, c) == Approx(c * std::sqrt(2 / (1 - c * c))).epsilon(1e-11));
    const double z = two_sided_normal(c);
    CHECK(two_sided_student(1'000'000, c) ==
          Approx(z + (z * z * z + z) / 4e6).epsilon(1e-10)); // the next term is of 1/ν²
  }
}

// The bits are those of an evaluation in double, which every machine has, and not of one in long double.
TEST_CASE("two-sided quantiles are evaluated in double") {
  long differing = 0;
  for (long degrees = 1; degrees <= 200; ++degrees) {
    const boost::math::students_t_distribution<double, MathPolicy> in_double(
        static_cast<double>(degrees));
    const boost::math::students_t in_long_double(static_cast<double>(degrees));
    const double tail = (1 - 0.95) / 2;
    CHECK(two_sided_student(degrees, 0.95) == quantile(complement(in_double, tail)));
    differing +=
        quantile(complement(in_double, tail)) != quantile(complement(in_long_double, tail));
  }
  if (std::numeric_limits<long double>::digits > std::numeric_limits<double>::digits)
    CHECK(differing > 0); // or this test could not fail
}
