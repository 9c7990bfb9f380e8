#include "core/mechanics/system.hpp"
#include "core/methods/time_scales.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

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

// A swing φ = rest + a cos ωt at any phase: |φ̈/φ̇| = ω |cot ωt|, and |φ̇/(φ − rest)| = ω |tan ωt| counts where a latch bears.
TEST_CASE("a swing counts with its frequency or more at every phase, on a latch or without one") {
  for (const bool latched : {true, false}) {
    Scene scene = oracle::unit_oscillator(1); // about 0, by its spring alone
    Hinge& hinge = scene.hinges[0];
    double rest = 0, omega = 1;
    if (latched) { // 2 N·m in the deploying sense push the latch beyond its angle
      hinge = oracle::latching_panel().hinges[0];
      hinge.latch->damping = 0, hinge.friction = {};
      rest = -hinge.spring.torque_latched / hinge.latch->stiffness;
      omega = std::sqrt(hinge.latch->stiffness / oracle::panel_inertia);
    }
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    if (latched) system.engage(1);
    Step<double> step;
    step.dxdt.resize(2);
    for (int k = 1; k < 20; ++k) {
      const double phase = 0.33 * k, size = 1e-2, rate = size * omega * std::sin(phase);
      step.x = {rest + size * std::cos(phase), -rate};
      system(step.x, step.dxdt, 0.0);
      const double tangent = std::abs(std::tan(phase));
      const double expected = latched ? omega * std::max(tangent, 1 / tangent) : omega / tangent;
      CAPTURE(latched, phase);
      CHECK(highest_frequency(system, step, 0.0) == Approx(expected).epsilon(1e-9));
      CHECK(highest_frequency(system, step, std::abs(rate) / 101) ==
            Approx(expected).epsilon(1e-9));
      CHECK(highest_frequency(system, step, std::abs(rate) / 99) == 0); // as if at rest
    }
  }
}

TEST_CASE("angles are known up to 1e8 rad either way, of every hinge; the base's does not count") {
  const double most = 1e8, below = std::nextafter(most, 0.0);
  for (const int base : {0, 3}) {
    const Layout at{base, 3, false};
    State<double> x(at.size(), 0.0);
    CHECK(angles_are_known(at, x));
    for (int k = 0; k < base; ++k) x[k] = 1e9;
    for (int k = at.freedoms(); k < at.size(); ++k) x[k] = 1e9; // rates
    for (int i = 1; i <= 3; ++i) {
      CAPTURE(base, i);
      for (const double angle : {below, -below}) {
        x[at.angle(i)] = angle;
        CHECK(angles_are_known(at, x));
      }
      for (const double angle : {most, -most, std::numeric_limits<double>::quiet_NaN()}) {
        x[at.angle(i)] = angle;
        CHECK_FALSE(angles_are_known(at, x));
      }
      x[at.angle(i)] = 0;
    }
  }
}
