#include "core/number/power.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("powers are good to what step control needs") {
  oracle::Draws draws(3);
  double worst_log = 0, worst_exp = 0;
  for (int trial = 0; trial < 200'000; ++trial) {
    const double x = draws.log_uniform(1e-300, 1e300), y = draws.uniform(-1000, 1000);
    worst_log = std::max(worst_log, std::abs(log2_roughly(x) - std::log2(x)));
    worst_exp = std::max(worst_exp, std::abs(exp2_roughly(y) / std::exp2(y) - 1));
  }
  CHECK(worst_log < 6e-8);
  CHECK(worst_exp < 2e-7);
  for (const double x : {1.0, 2.0, 0.5, 1024.0}) CHECK(exp2_roughly(log2_roughly(x)) == x);
}
