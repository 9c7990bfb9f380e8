// A base's table of time and its integrals against the oracle's own curves, by Gauss's points.
#include "core/laws/driven_base.hpp"
#include "core/mechanics/wing.hpp"
#include "tests/support/hinge_laws.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The base's motion up to t under a random table, by quadrature of the oracle's curves.
struct Expected {
  explicit Expected(const Base& base) : base_(base), knots_(base.table->columns().time) {
    if (base.table->gives_rate())
      rate_.emplace(knots_, base.table->columns().rate, base.table->interpolation(),
                    Beyond::constant);
  }
  [[nodiscard]] Eigen::Vector3d accelerations(double t) const {
    return DrivenBase<double>(base_).accelerations(t);
  }
  /// ∫ from 0 to t of f: a polynomial of degree five at most between knots.
  template <class F> [[nodiscard]] double integral(double t, const F& f) const {
    if (t < 0) return NAN;
    double sum = 0, at = 0;
    for (const double knot : knots_) {
      if (knot <= at || knot >= t) continue;
      sum += gauss3(at, knot, f), at = knot;
    }
    return sum + gauss3(at, t, f);
  }
  [[nodiscard]] double velocity(double t, int axis) const {
    return integral(t, [&](double s) { return accelerations(s)[axis]; });
  }
  [[nodiscard]] double rate(double t) const {
    if (rate_) return base_.table_scale * rate_->value(t);
    return base_.rate + velocity(t, 2);
  }
  [[nodiscard]] double angle(double t) const {
    return base_.angle + integral(t, [&](double s) { return rate(s); });
  }

private:
  const Base& base_;
  std::vector<double> knots_;
  std::optional<Table<double>> rate_;
};

BaseTerms<double> terms(const Base& base) {
  Scene scene = free_panel();
  scene.base = base;
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  return wing.base;
}

} // namespace

TEST_CASE("a table's pieces have its accelerations and their exact integrals") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Base base = driven_by_table(free_panel(), seed, 3).base;
    const BaseTerms<double> given = terms(base);
    const Expected expected(base);
    CAPTURE(seed, base.table->gives_acceleration(), base.table->gives_rate());
    Draws draws(seed);
    for (int probe = 0; probe < 30; ++probe) {
      const double t = draws.uniform(0, 4);
      const DrivenPiece<double> piece = driven_piece(given, number_of_piece(*base.table, t));
      REQUIRE((piece.from <= t || t < base.table->columns().time.front()));
      REQUIRE(t < piece.until);
      const Drive<double> drive = drive_at(given, piece, t);
      const Eigen::Vector3d a = expected.accelerations(t);
      CAPTURE(t, piece.from);
      CHECK(drive.felt.x == Approx(a[0]).margin(1e-13));
      CHECK(drive.felt.y == Approx(a[1]).margin(1e-13));
      CHECK(drive.angular_acceleration == Approx(a[2]).margin(1e-13));
      CHECK(drive.rate == Approx(expected.rate(t)).margin(1e-13));
      CHECK(drive.angle == Approx(expected.angle(t)).margin(1e-12));
      CHECK(velocity(piece, t).x == Approx(expected.velocity(t, 0)).margin(1e-12));
      CHECK(velocity(piece, t).y == Approx(expected.velocity(t, 1)).margin(1e-12));
    }
  }
}

TEST_CASE("the pieces of a table join, but for what jumps in the slope of a rate") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const Base base = driven_by_table(free_panel(), seed, 3).base;
    const BaseTerms<double> given = terms(base);
    for (int k = 0; k + 1 < std::ssize(base.table->pieces()); ++k) {
      const DrivenPiece<double> before = driven_piece(given, k), after = driven_piece(given, k + 1);
      const Drive<double> left = drive_at(given, before, before.until),
                          right = drive_at(given, after, after.from);
      CAPTURE(seed, k);
      REQUIRE(before.until == after.from);
      CHECK(left.felt.x == Approx(right.felt.x).margin(1e-13));
      CHECK(left.rate == Approx(right.rate).margin(1e-13));
      CHECK(left.angle == Approx(right.angle).margin(1e-12));
      if (!base.table->gives_rate())
        CHECK(left.angular_acceleration == Approx(right.angular_acceleration).margin(1e-13));
    }
  }
}

TEST_CASE("bounds of a cubic over a stretch hold, and are sharp where it is short") {
  Draws draws(5);
  for (int k = 0; k < 200; ++k) {
    const std::array<double, 4> c{draws.uniform(-1, 1), draws.uniform(-1, 1), draws.uniform(-1, 1),
                                  draws.uniform(-1, 1)};
    const double from = draws.uniform(-1, 1), h = draws.log_uniform(1e-4, 1);
    const std::array<double, 4> moved = shifted(c, from);
    const CubicBounds<double> bound = cubic_bounds(moved, h);
    double value = 0, first = 0, second = 0;
    for (int j = 0; j <= 100; ++j) {
      const double u = from + h * j / 100;
      value = std::max(value, std::abs(cubic_at(c, u)));
      first = std::max(first, std::abs(c[1] + u * (2 * c[2] + 3 * u * c[3])));
      second = std::max(second, std::abs(2 * c[2] + 6 * u * c[3]));
    }
    CAPTURE(h);
    CHECK(value <= bound.value * (1 + 1e-12));
    CHECK(first <= bound.first * (1 + 1e-12));
    CHECK(second <= bound.second * (1 + 1e-12));
    CHECK(bound.value <= value + 20 * h);
    CHECK(bound.first <= first + 20 * h);
    CHECK(bound.second <= second + 20 * h);
  }
}

TEST_CASE("a base moves steadily only after the last knot of a table that leaves it so") {
  const auto steady = [](const BaseTable::Columns& columns, int piece) {
    Base base;
    base.motion = BaseMotion::prescribed;
    base.table = std::make_shared<const BaseTable>(columns, Interpolation::linear);
    const BaseTerms<double> given = terms(base);
    return is_steady(given, driven_piece(given, piece));
  };
  const BaseTable::Columns spun_up{{0, 1, 2}, {}, {}, {0, 1, 1}};
  CHECK_FALSE(steady(spun_up, 1));
  CHECK_FALSE(steady(spun_up, 2)); // though the rate is constant there
  CHECK(steady(spun_up, 3));
  const BaseTable::Columns faster{{0, 1, 2}, {}, {0, 1, 0.5}, {}};
  CHECK_FALSE(steady(faster, 3));
  CHECK(steady({{0, 1, 2}, {}, {0, 1, 0}, {}}, 3));
  CHECK(steady({{0, 1}, {{0, 0}, {1, 2}}, {}, {}}, 2));
}
