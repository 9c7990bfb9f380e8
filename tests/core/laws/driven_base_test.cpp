#include "core/laws/driven_base.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;

TEST_CASE("a base of prescribed motion turns over a step as its law says") {
  BaseTerms<double> base{};
  base.rate = 0.3, base.angular_acceleration = 0.2;
  const double t0 = 5, h = 2;
  const Quintic<double> turned = turn_of_base(base, {}, t0, h);
  for (const double s : {0.0, 0.3, 1.0}) {
    const double t = s * h, rate = 0.3 + 0.2 * t0;
    CHECK(value(turned, s) == Approx(rate * t + 0.1 * t * t).margin(1e-15));
  }
}

TEST_CASE("a base that a table drives turns over a step as its piece says, and is pushed no more") {
  BaseTerms<double> base{};
  const BaseTable table({{0, 1}, {}, {0, 1}, {}}, Interpolation::linear);
  base.table = &table, base.gravity = {0.5, 0};
  DrivenPiece<double> piece{};
  piece.from = 4, piece.rate = 0.3, piece.turning = {0.2, -0.1, 0.05, 0.02};
  piece.x = {1, 2, 0, 0}, piece.y = {0, 0, -3, 0};
  const double t0 = 5, h = 2;
  const Quintic<double> turned = turn_of_base(base, piece, t0, h);
  for (const double s : {0.0, 0.3, 1.0}) {
    const auto angle = [&](double u) {
      return 0.3 * u + u * u * (0.1 + u * (-0.1 / 6 + u * (0.05 / 12 + u * 0.02 / 20)));
    };
    CHECK(value(turned, s) == Approx(angle(1 + s * h) - angle(1)).margin(1e-14));
  }
  const CubicBounds<double> push = push_of_base(base, piece, t0, h); // largest at the end, u = 3
  CHECK(push.value == Approx(std::hypot(6.5, 27)).epsilon(1e-14));
  CHECK(push.first == Approx(std::hypot(2, 18)).epsilon(1e-14));
  CHECK(push.second == Approx(6).epsilon(1e-14));
  piece.x = {1, 2, 0.5, 0.25}, piece.y = {0, 0, 0, 2}; // growing terms: all are largest at the end
  const CubicBounds<double> more = push_of_base(base, piece, t0, h);
  CHECK(more.value == Approx(std::hypot(0.5 + 6 + 4.5 + 6.75, 54)).epsilon(1e-14));
  CHECK(more.first == Approx(std::hypot(2 + 3 + 6.75, 54)).epsilon(1e-14));
  CHECK(more.second == Approx(std::hypot(1 + 4.5, 36)).epsilon(1e-14));
}
