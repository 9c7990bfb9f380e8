#include "core/number/power.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("rough powers have the errors that power.hpp states") {
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

TEST_CASE("powers of laws are good to round-off") {
  oracle::Draws draws(4);
  double worst = 0; // error over the one that power.hpp states
  const auto look = [&](double x, double y) {
    const long double exact = std::pow(static_cast<long double>(x), static_cast<long double>(y));
    if (exact < 1e-290L || exact > 1e290L) return;
    const auto off = static_cast<double>(std::abs(power_precisely(x, y) / exact - 1));
    worst = std::max(worst, off / ((4 + 2 * std::abs(y)) * 0x1p-53));
  };
  for (int trial = 0; trial < 100'000; ++trial) {
    look(draws.log_uniform(1e-6, 1e2), draws.uniform(-1, 3)); // rates and exponents of dampers
    look(draws.uniform(0.5, 2), draws.uniform(-1, 3));
    look(draws.log_uniform(1e-300, 1e300), draws.uniform(-20, 20));
  }
  INFO(worst);
  CHECK(worst < 1);
  CHECK(power_precisely(1.0, 0.45) == 1);
  CHECK(power_precisely(4.0, 0.5) == 2);
  CHECK(power_precisely(10.0, 1e9) > 1e300);
  CHECK(power_precisely(0.1, 1e9) < 1e-300);
  CHECK(std::isnan(power_precisely(std::nan(""), 0.45)));
  CHECK(std::isnan(power_precisely(HUGE_VAL, 0.45)));
  CHECK(std::abs(power_precisely(2.0L, 0.5L) - std::sqrt(2.0L)) < 1e-18L);
}

TEST_CASE("powers of laws have a double's bits in every lane") {
  oracle::Draws draws(5);
  for (int trial = 0; trial < 20'000; ++trial) {
    Pack<2> x, y;
    for (int lane = 0; lane < 2; ++lane)
      x.v[lane] = draws.log_uniform(1e-20, 1e20), y.v[lane] = draws.uniform(-1, 3);
    const Pack<2> result = power_precisely(x, y);
    for (int lane = 0; lane < 2; ++lane)
      CHECK(result.v[lane] == power_precisely(x.v[lane], y.v[lane]));
  }
}
