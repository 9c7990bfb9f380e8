// Curves against the oracle's own: Hermite's basis and Gauss's points.
#include "core/laws/curve_value.hpp"
#include "tests/support/hinge_laws.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// Knots 0.01 to 1 apart, values in [−2, 2], some of them equal to the one before.
struct RandomTable {
  std::vector<double> x, y;

  RandomTable(std::uint64_t seed, int count) {
    Draws draws(seed);
    double at = draws.uniform(-1, 1);
    for (int k = 0; k < count; ++k) {
      x.push_back(at);
      y.push_back(k > 0 && draws.chance(0.15) ? y.back() : draws.uniform(-2, 2));
      at += draws.log_uniform(0.01, 1);
    }
  }
  /// From before the first knot to beyond the last, every knot and both sides of it included.
  [[nodiscard]] std::vector<double> probes(int between) const {
    std::vector<double> all{x.front() - 0.7, x.back() + 0.3};
    for (std::size_t k = 0; k + 1 < x.size(); ++k)
      for (int j = 0; j < between; ++j) all.push_back(x[k] + (x[k + 1] - x[k]) * j / between);
    for (const double knot : x)
      for (const double to : {-10., 10.})
        all.push_back(knot), all.push_back(std::nextafter(knot, to));
    return all;
  }
};

constexpr double round_off = 1e-13; // values of 2, slopes up to 400 and their sums

template <class Check> void for_random_tables(const Check& check) {
  for (std::uint64_t seed = 0; seed < 60; ++seed)
    for (const Interpolation how : {Interpolation::monotone, Interpolation::linear})
      for (const Beyond beyond : {Beyond::constant, Beyond::straight}) {
        const RandomTable table(seed, 2 + static_cast<int>(seed % 7));
        CAPTURE(seed, static_cast<int>(how), static_cast<int>(beyond));
        check(table, how, beyond);
      }
}

} // namespace

TEST_CASE("a curve alone has the values that the kernel computes, to the last bit") {
  for_random_tables([](const RandomTable& table, Interpolation how, Beyond beyond) {
    const Curve curve(table.x, table.y, how, beyond);
    for (const double x : table.probes(3)) {
      CAPTURE(x);
      CHECK(curve.value_at(x) == value(curve, x));
      CHECK(curve.slope_at(x) == slope(curve, x));
    }
  });
}

TEST_CASE("a curve's values, slopes and integrals are those of Hermite's basis") {
  for_random_tables([](const RandomTable& table, Interpolation how, Beyond beyond) {
    const Curve curve(table.x, table.y, how, beyond);
    const Table<long double> exact(table.x, table.y, how, beyond);
    REQUIRE(curve.knots() == table.x);
    for (const double x : table.probes(7)) {
      CAPTURE(x);
      CHECK(std::abs(value(curve, x) - static_cast<double>(exact.value(x))) < round_off);
      const auto area = static_cast<double>(exact.integral(table.x.front(), x));
      CHECK(std::abs(integral(curve, x) - area) < round_off);
      if (std::count(table.x.begin(), table.x.end(), x) > 0) continue; // a kink's slope has a side
      CHECK(std::abs(slope(curve, x) - static_cast<double>(exact.slope(x))) < 1e3 * round_off);
    }
  });
}

TEST_CASE("a monotone curve passes through its knots and stays between them") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomTable table(seed, 2 + static_cast<int>(seed % 7));
    const Curve curve(table.x, table.y, Interpolation::monotone);
    CAPTURE(seed);
    for (std::size_t k = 0; k < table.x.size(); ++k) CHECK(value(curve, table.x[k]) == table.y[k]);
    for (std::size_t k = 0; k + 1 < table.x.size(); ++k) {
      const auto [low, high] = std::minmax(table.y[k], table.y[k + 1]);
      const double sense = table.y[k + 1] > table.y[k] ? 1 : -1;
      double before = table.y[k];
      for (int j = 1; j <= 50; ++j) {
        const double x = table.x[k] + (table.x[k + 1] - table.x[k]) * j / 50;
        const double y = value(curve, std::min(x, table.x[k + 1]));
        CHECK((y > low - 1e-14 && y < high + 1e-14));
        CHECK(sense * (y - before) > -1e-14);
        before = y;
      }
    }
  }
}

TEST_CASE("a curve is constant beyond its ends, or goes straight on") {
  const std::vector<double> x{0, 1, 3}, y{1, 2, 0};
  const Curve constant(x, y, Interpolation::linear);
  CHECK(value(constant, -5.0) == 1);
  CHECK(value(constant, 8.0) == 0);
  CHECK(slope(constant, 8.0) == 0);
  const Curve straight(x, y, Interpolation::linear, Beyond::straight);
  CHECK(value(straight, -5.0) == -4);
  CHECK(value(straight, 8.0) == -5);
  CHECK(integral(straight, -2.0) == 0); // 1 + x from −2 to 0
  const Curve monotone(x, y, Interpolation::monotone, Beyond::straight);
  CHECK(value(monotone, 5.0) == Approx(2 * slope(monotone, 3.0)));
}

TEST_CASE("descending knots are turned round") {
  for_random_tables([](const RandomTable& table, Interpolation how, Beyond beyond) {
    const std::vector<double> x(table.x.rbegin(), table.x.rend());
    const std::vector<double> y(table.y.rbegin(), table.y.rend());
    const Curve up(table.x, table.y, how, beyond), down(x, y, how, beyond);
    CHECK(down.knots() == up.knots());
    for (const double at : table.probes(3)) CHECK(value(down, at) == value(up, at));
  });
}

TEST_CASE("PCHIP through a line is that line, whatever its knots") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RandomTable table(seed, 6);
    for (std::size_t k = 0; k < 6; ++k) table.y[k] = 0.7 - 1.3 * table.x[k];
    const Curve curve(table.x, table.y, Interpolation::monotone, Beyond::straight);
    for (const double x : table.probes(5))
      CHECK(std::abs(value(curve, x) - (0.7 - 1.3 * x)) < 1e-14);
    CHECK(curve.steepest_rise() == Approx(-1.3).epsilon(1e-12));
    CHECK(curve.steepest_fall() == Approx(-1.3).epsilon(1e-12));
  }
  // where the chords' slopes are exact, to the last bit
  const Curve exact({0, 1, 4, 6}, {1, 3, 9, 13}, Interpolation::monotone);
  for (const Curve::Piece& piece : exact.pieces()) CHECK((piece.c[2] == 0 && piece.c[3] == 0));
}

TEST_CASE("a sum of curves is the sum of their values and integrals") {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const RandomTable table(seed, 5);
    const std::vector<double> other = RandomTable(seed + 100, 5).y;
    const Curve f(table.x, table.y, Interpolation::monotone);
    const Curve g(table.x, other, Interpolation::monotone);
    const Curve sum = Curve::sum(0.5, f, -2, g);
    for (const double x : table.probes(5)) {
      CHECK(std::abs(value(sum, x) - (0.5 * value(f, x) - 2 * value(g, x))) < round_off);
      CHECK(std::abs(integral(sum, x) - (0.5 * integral(f, x) - 2 * integral(g, x))) < round_off);
    }
  }
}

TEST_CASE("a curve of up to eight pieces has them by columns, and no longer one has") {
  for (int knots = 2; knots <= 12; ++knots) {
    const RandomTable table(40 + knots, knots);
    const Curve curve(table.x, table.y, Interpolation::monotone);
    CAPTURE(knots);
    REQUIRE(curve.pieces().size() == static_cast<std::size_t>(knots) + 1);
    REQUIRE(curve.columns().has_value() == (knots + 1 <= 8));
    for (std::size_t k = 0; curve.columns() && k < curve.pieces().size(); ++k) {
      CHECK(curve.columns()->from[k] == curve.knots()[k > 0 ? k - 1 : 0]);
      CHECK(curve.columns()->integral[k] == curve.pieces()[k].integral);
      for (std::size_t power = 0; power < 4; ++power)
        CHECK(curve.columns()->c[power][k] == curve.pieces()[k].c[power]);
    }
  }
}

TEST_CASE("a curve's bounds on its slope hold and are met") {
  for_random_tables([](const RandomTable& table, Interpolation how, Beyond beyond) {
    const Curve curve(table.x, table.y, how, beyond);
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const double x : table.probes(200)) {
      const double at = slope(curve, x);
      least = std::min(least, at), most = std::max(most, at);
    }
    const double size = std::abs(most) + std::abs(least), round = 1e-12 * (1 + size);
    CHECK(least >= curve.steepest_fall() - round);
    CHECK(most <= curve.steepest_rise() + round);
    CHECK(least <= curve.steepest_fall() + 1e-3 * size + round); // of 200 probes a piece
    CHECK(most >= curve.steepest_rise() - 1e-3 * size - round);
  });
}

TEST_CASE("a curve's sharpest bend bounds the change of its slope inside a piece") {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const RandomTable table(seed, 6);
    const Curve curve(table.x, table.y, Interpolation::monotone);
    double largest = 0;
    for (std::size_t k = 0; k + 1 < table.x.size(); ++k) {
      const double h = (table.x[k + 1] - table.x[k]) / 100;
      for (int j = 1; j < 99; ++j) {
        const double x = table.x[k] + h * j;
        largest =
            std::max(largest, std::abs(slope(curve, x + h / 2) - slope(curve, x - h / 2)) / h);
      }
    }
    CHECK(largest <= curve.sharpest_bend() * (1 + 1e-9));
    CHECK(largest >= 0.9 * curve.sharpest_bend());
  }
}

TEST_CASE("a torque test both ways: half the sum drives, half the difference rubs") {
  const std::vector<double> angle{1.5, 0.8, 0}, out{1, 2, 1.5}, back{1.4, 2.1, 2.5};
  const TorqueTable table(angle, out, back, Interpolation::monotone);
  CHECK(table.both_ways());
  CHECK(table.angle() == angle);
  CHECK(table.deploying() == out);
  CHECK(table.stowing() == back);
  const Table<double> f(angle, out, Interpolation::monotone, Beyond::constant);
  const Table<double> g(angle, back, Interpolation::monotone, Beyond::constant);
  for (const double x : {-1., 0., 0.3, 0.8, 1.2, 2.}) {
    CHECK(value(table.drive(), x) == Approx((f.value(x) + g.value(x)) / 2));
    CHECK(value(table.friction(), x) == Approx((g.value(x) - f.value(x)) / 2));
  }
  const TorqueTable one_way(angle, out, Interpolation::linear);
  CHECK(!one_way.both_ways());
  CHECK(one_way.friction().pieces().empty());
  CHECK(value(one_way.drive(), 0.4) == Approx(1.75));
}
