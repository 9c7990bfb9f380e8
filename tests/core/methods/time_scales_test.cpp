#include "core/methods/time_scales.hpp"

#include <catch2/catch.hpp>

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
