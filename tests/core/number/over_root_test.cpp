#include "core/number/over_root.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE(
    "1/√x is good to the last place, from what lies far below a slip rate to far above a rate") {
  oracle::Draws draws(5);
  double worst = 0;
  const auto off = [](double x) {
    const long double exact = 1 / std::sqrt(static_cast<long double>(x));
    return static_cast<double>(std::abs(over_root(1.0, x) / exact - 1));
  };
  for (int trial = 0; trial < 300'000; ++trial) {
    worst = std::max(worst, off(draws.log_uniform(1e-300, 1e300)));
    worst = std::max(worst, off(draws.uniform(1, 4))); // every mantissa, both parities of exponent
  }
  for (const double x :
       {1.0, 4.0, 0.25, 1e-300, std::nextafter(1.0, 0.0), std::nextafter(4.0, 0.0)})
    worst = std::max(worst, off(x));
  INFO(worst);
  CHECK(worst < 0x1p-52);
  CHECK(over_root(0.0, 2.0) == 0);
  CHECK(std::isnan(over_root(1.0, std::nan(""))));
  CHECK(std::abs(over_root(2.0L, 3.0L) - 2 / std::sqrt(3.0L)) < 1e-19L);
}

TEST_CASE("1/√x has a double's bits in every lane") {
  oracle::Draws draws(6);
  for (int trial = 0; trial < 20'000; ++trial) {
    Pack<2> n, x;
    for (int lane = 0; lane < 2; ++lane)
      n.v[lane] = draws.uniform(-9, 9), x.v[lane] = draws.log_uniform(1e-300, 1e300);
    const Pack<2> root = over_root(n, x);
    for (int lane = 0; lane < 2; ++lane) CHECK(root.v[lane] == over_root(n.v[lane], x.v[lane]));
  }
}
