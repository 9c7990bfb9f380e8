#include "core/methods/steppers.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;

// Roughness grows at least as h³ (roughness.hpp): the next step, or trial step, of factor·h stays below 1.
TEST_CASE("a step is refused for its roughness beyond 1, and the next one keeps to it") {
  for (const double rough : {0.0, 0.05, 0.5, 0.999, 1.0, std::nextafter(1.0, 2.0), 1.5, 8.0, 1e4}) {
    CAPTURE(rough);
    StepVerdict verdict{0.25, 1.75};
    limit_roughness(rough, verdict);
    CHECK(verdict.accepted() == (rough <= 1));
    if (verdict.accepted()) CHECK(verdict.error == 0.25);
    CHECK(verdict.factor > 0);
    CHECK(verdict.factor <= (rough <= 1 ? 1.75 : 0.9));
    if (rough < 100) CHECK(rough * std::pow(verdict.factor, 3) < 1); // beyond, a fifth at a time
  }
  for (const double rough : {0.0, 0.05}) { // far from it, the method's own factor stands
    StepVerdict verdict{0.25, 1.75};
    limit_roughness(rough, verdict);
    CHECK(verdict.factor == 1.75);
  }
}

// The interpolant through a step's ends is of order 5, so that it follows the formulas of order 5 and below.
TEST_CASE(
    "methods of an order above the interpolant's keep to its roughness, the others need not") {
  using enum Method;
  for (const Method method :
       {fehlberg78, dop853, bulirsch_stoer, adams_bashforth_moulton, seulex, taylor})
    CHECK(takes_long_steps(method));
  for (const Method method : {runge_kutta4, cash_karp54, dopri5})
    CHECK_FALSE(takes_long_steps(method));
}
