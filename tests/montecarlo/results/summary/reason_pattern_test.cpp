#include "montecarlo/results/summary/reason_pattern.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

using Strings = std::vector<std::string>;

std::string widened(const char* one, const char* other) {
  ReasonPattern pattern = pattern_of(one);
  widen(pattern, pattern_of(other));
  return to_string(pattern);
}

} // namespace

TEST_CASE("a reason is cut at its numbers, and not within names") {
  const ReasonPattern pattern = pattern_of("panel_1, point.0 is -1.5e-3, 2-fold at x2y 3");
  CHECK(pattern.words == Strings{"panel_1, point.0 is ", ", ", "-fold at x2y ", ""});
  CHECK(pattern.numbers == Strings{"-1.5e-3", "2", "3"});
  CHECK(pattern_of("").words == Strings{""});
  CHECK(pattern_of("7").numbers == Strings{"7"});
  CHECK(pattern_of("3D - no number, nan, inf, 1e999x").numbers.empty());
}

TEST_CASE("a pattern is its reason until it has to take in another") {
  const char* reason =
      GENERATE("", "3", "friction holds root", "the limit of 10 steps was reached, at t = 1.25 s",
               "bodies.panel_1.mass is -2, expected > 0", "-", "1 2 3");
  CHECK(to_string(pattern_of(reason)) == reason);
  CHECK(widened(reason, reason) == reason);
}

TEST_CASE("the numbers in which reasons differ are left out, and the others kept") {
  CHECK(widened("mass is -2, expected > 0", "mass is -0.5, expected > 0") ==
        "mass is …, expected > 0");
  CHECK(widened("10 steps, at t = 1 s", "10 steps, at t = 2 s") == "10 steps, at t = … s");
}
