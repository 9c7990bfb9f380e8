#include "montecarlo/statistics/bonferroni.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("several statements share a risk out among them") {
  CHECK(at_each_of(.95, 0) == .95);
  CHECK(at_each_of(.95, 1) == .95);
  CHECK(at_each_of(.95, 5) == Approx(.99).epsilon(1e-12));
}
