#include "core/laws/curve_value.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using oracle::Draws;

TEST_CASE("a curve's range over an interval holds its values there, sums of curves too") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Draws draws(seed);
    std::vector<double> x{0}, out, back;
    for (int k = 0; k < 6; ++k) x.push_back(x.back() + draws.log_uniform(0.05, 1));
    for (std::size_t k = 0; k < x.size(); ++k)
      out.push_back(draws.uniform(0, 1)), back.push_back(out.back() + draws.uniform(0, 0.2));
    const TorqueTable table(x, out, back, Interpolation::monotone);
    const double a = draws.uniform(-0.5, x.back()), b = a + draws.uniform(0, 2);
    for (const Curve* curve : {&table.drive(), &table.friction()}) {
      const ValueRange<double> range = range_of(*curve, ValueRange<double>{a, b});
      CAPTURE(seed, curve == &table.drive(), range.low, range.high);
      for (int k = 0; k <= 400; ++k) {
        const double y = value(*curve, a + (b - a) * k / 400);
        REQUIRE((y > range.low - 1e-14 && y < range.high + 1e-14));
      }
    }
  }
}
