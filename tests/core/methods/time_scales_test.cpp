#include "core/methods/time_scales.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;

TEST_CASE("a first step turns no hinge by much more than a radian, from rest or in motion") {
  const Layout at{0, 2, false};
  Step<double> step;
  step.t = 0, step.h = 1;
  step.x = step.x1 = step.dxdt1 = State<double>(4, 0.0);
  const auto time = [&](double rate, double acceleration) {
    step.dxdt = {0, rate, 0, acceleration}; // of the second hinge
    return time_to_a_radian(at, step, 10.0);
  };
  CHECK(time(0, 0) == 10);
  CHECK(time(-4, 0) == 0.25);
  CHECK(time(0, -8) == 0.5); // ½ 8 t² = 1
  CHECK(time(1, 8) == 0.5);
  CHECK(time(4, 8) == 0.25);
  CHECK(time(1e-3, 1e-3) == 10);
}

TEST_CASE("a base is sampled every tenth of a radian, however it is driven") {
  BaseTerms<double> base{};
  const auto time = [&](double rate, double acceleration, double t, double longest) {
    base.rate = rate, base.angular_acceleration = acceleration;
    return time_of_base(base, {}, t, longest);
  };
  CHECK(time(0, 0, 3, 10) == 10);
  CHECK(time(0.5, 0, 3, 10) == Approx(0.2));
  CHECK(time(-0.5, 0, 3, 0.1) == 0.1);
  CHECK(time(0, 10, 0, 10) == Approx(0.1)); // √(0.1/10)
  CHECK(time(0, -10, 0, 10) == Approx(0.1));
  CHECK(time(1, 0.5, 2, 10) == Approx(0.05)); // at 2 rad/s
  CHECK(time(1, -0.5, 2, 10) == Approx(std::sqrt(0.1 / 0.5)));
  const BaseTable table({{0, 1}, {}, {0, 1}, {}}, Interpolation::linear);
  base.table = &table;
  DrivenPiece<double> piece{};
  piece.from = 1, piece.rate = 0.25, piece.turning = {1, 0.5, 0, 0}; // at t = 3: ¼ + 2 + 1
  CHECK(time_of_base(base, piece, 3.0, 10.0) == Approx(0.1 / 3.25));
  piece.rate = -3, piece.turning = {1, 0.5, 0, 0}; // the rate is 0: up to 2 + ½ 4 rad/s² in 4 s
  CHECK(time_of_base(base, piece, 3.0, 4.0) == Approx(std::sqrt(0.1 / 4)));
}
