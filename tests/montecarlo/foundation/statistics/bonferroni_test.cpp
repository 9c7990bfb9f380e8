#include "montecarlo/foundation/statistics/bonferroni.hpp"

#include <catch2/catch.hpp>

#include <vector>

using namespace wingspread;

TEST_CASE("several statements share a risk out among them") {
  CHECK(at_each_of(.95, 0) == .95);
  CHECK(at_each_of(.95, 1) == .95);
  CHECK(at_each_of(.95, 2) == Approx(.975).epsilon(1e-12));
  CHECK(at_each_of(.95, 5) == Approx(.99).epsilon(1e-12));
}

TEST_CASE("statements that hold each by itself hold together with what their risks leave") {
  CHECK(joint_confidence(std::span<const double>()) == 1);
  CHECK(joint_confidence(std::vector<double>{0.9}) == Approx(0.9).epsilon(1e-14));
  CHECK(joint_confidence(std::vector<double>{0.9, 0.95, 0.99}) == Approx(0.84).epsilon(1e-14));
  CHECK(joint_confidence(std::vector<double>{0.4, 0.5}) == 0);
  for (const std::size_t count : {10, 20, 100}) // risks that add up to 1, in numbers just below it
    CHECK(joint_confidence(std::vector<double>(count, 1 - 1.0 / static_cast<double>(count))) == 0);
  CHECK(joint_confidence(std::vector<double>(1, 1e-9)) == Approx(1e-9).epsilon(1e-6));
}
