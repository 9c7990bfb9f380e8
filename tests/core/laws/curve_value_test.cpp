#include "core/laws/curve_value.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

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

TEST_CASE("a slope's range over an interval holds its values there, and no more") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Draws draws(seed);
    std::vector<double> x{0}, y;
    for (int k = 0; k < 5; ++k) x.push_back(x.back() + draws.log_uniform(0.05, 1));
    for (std::size_t k = 0; k < x.size(); ++k) y.push_back(draws.uniform(-1, 1));
    const Curve curve(x, y, seed % 3 == 0 ? Interpolation::linear : Interpolation::monotone,
                      seed % 2 == 0 ? Beyond::constant : Beyond::straight);
    const double a = draws.uniform(-0.5, x.back()), b = a + draws.log_uniform(1e-3, 2);
    const ValueRange<double> range = range_of_slope(curve, ValueRange<double>{a, b});
    double least = 1e300, most = -1e300;
    for (int k = 0; k <= 4000; ++k) {
      const double there = slope(curve, a + (b - a) * k / 4000);
      least = std::min(least, there), most = std::max(most, there);
    }
    CAPTURE(seed, a, b, range.low, range.high, least, most);
    CHECK(least >= range.low - 1e-12);
    CHECK(most <= range.high + 1e-12);
    CHECK(range.high - range.low <= (most - least) * 1.02 + 1e-2); // knots are not sampled
  }
}

TEST_CASE("no slope of a curve is further from a given one than the most change of it, and one is "
          "as far") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Draws draws(seed);
    std::vector<double> x{0}, y;
    for (int k = 0; k < 5; ++k) x.push_back(x.back() + draws.log_uniform(0.05, 1));
    for (std::size_t k = 0; k < x.size(); ++k)
      y.push_back(seed % 4 == 0 && k > 0 ? y.back() + draws.uniform(-1, 0) : draws.uniform(-1, 1));
    const Curve curve(x, y, seed % 3 == 0 ? Interpolation::linear : Interpolation::monotone,
                      seed % 2 == 0 ? Beyond::constant : Beyond::straight);
    for (const double here : {0.0, slope(curve, draws.uniform(0, x.back())), -20.0, 20.0}) {
      double most = 0;
      for (int k = -10; k <= 4010; ++k)
        most = std::max(most, std::abs(slope(curve, x.back() * k / 4000) - here));
      const double allowed = most_change_of_slope(curve, here);
      CAPTURE(seed, here, most, allowed);
      CHECK(most <= allowed * (1 + 1e-12));
      CHECK(allowed <= most * 1.02 + 1e-2); // knots are not sampled
    }
  }
}

TEST_CASE("in all lanes a curve has the piece of each") {
  Draws draws(5);
  for (const int knots : {2, 6, 12, 13, 40}) { // more than a dozen are looked up lane by lane
    std::vector<double> x{0}, y{0};
    for (int k = 1; k < knots; ++k)
      x.push_back(x.back() + draws.log_uniform(0.05, 1)), y.push_back(draws.uniform(-1, 1));
    const Curve curve(x, y, Interpolation::monotone);
    for (int k = 0; k < 200; ++k) {
      Pack<4> at;
      for (int lane = 0; lane < 4; ++lane) at.v[lane] = draws.uniform(-1, x.back() + 1);
      at.v[k % 4] = x[k % x.size()]; // a knot itself
      if (k == 7) at.v[2] = std::numeric_limits<double>::quiet_NaN();
      const PieceAt<Pack<4>> found = piece_at(curve, at);
      for (int lane = 0; lane < 4; ++lane) {
        const PieceAt<double> alone = piece_at(curve, double(at.v[lane]));
        CAPTURE(knots, k, lane);
        CHECK((found.u.v[lane] == alone.u || k == 7));
        CHECK(found.integral.v[lane] == alone.integral);
        for (int c = 0; c < 4; ++c) CHECK(found.c[c].v[lane] == alone.c[c]);
      }
    }
  }
}
