#include "core/dense/step.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;

namespace {

/// A step of one hinge from t = 2 over h = 0.5: its angle a quintic of the time that has passed.
double angle(double u) { return 1 + u * (0.5 + u * (-0.3 + u * (0.7 + u * (-0.2 + 0.4 * u)))); }
double rate(double u) { return 0.5 + u * (-0.6 + u * (2.1 + u * (-0.8 + 2 * u))); }
double acceleration(double u) { return -0.6 + u * (4.2 + u * (-2.4 + 8 * u)); }

Step<double> polynomial_step() {
  const double h = 0.5;
  return {2,
          h,
          {angle(0), rate(0)},
          {rate(0), acceleration(0)},
          {angle(h), rate(h)},
          {rate(h), acceleration(h)}};
}

} // namespace

TEST_CASE("inside a step angles are quintics, rates their derivatives") {
  const Step<double> step = polynomial_step();
  const Layout at{0, 1, false};
  State<double> x(2);
  for (const double s : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    const double u = s * step.h;
    step.interpolate(at, s, x);
    CAPTURE(s);
    CHECK(x[0] == Approx(angle(u)).epsilon(1e-14));
    CHECK(x[1] == Approx(rate(u)).epsilon(1e-13));
    CHECK(value(step.coordinate(0, 1), s) == Approx(angle(u)).epsilon(1e-14));
  }
}

TEST_CASE("the rate in a step of a few roundings is between those at its ends") {
  const double h = 2e-14, rate = 1.75,
               acceleration = -3e3; // a rounding of the angle is 0.6 % of the way
  Step<double> step{0.3, h, {1.3, rate}, {rate, acceleration}, {}, {}};
  step.x1 = {std::nextafter(1.3 + h * rate, 2.0), rate + h * acceleration};
  step.dxdt1 = {step.x1[1], acceleration};
  const Layout at{0, 1, false};
  const Quintic<double> inside = step.rate(0, at.freedoms());
  State<double> x(2);
  for (const double s : {0.0, 0.2, 0.5, 0.9, 1.0}) {
    step.interpolate(at, s, x);
    CHECK(x[1] == Approx(rate).epsilon(1e-9));
    CHECK(value(inside, s) == Approx(rate).epsilon(1e-9));
    CHECK(value(derivative(inside, h), s) == Approx(acceleration).epsilon(1e-3));
  }
}

TEST_CASE(
    "a hinge that starts at an angle leaves it by its rates, not by the rounding of the angle") {
  for (const double angle : {1.5708, -40.})
    for (const double h : {1e-15, 1e-8, 1e-4})
      for (const double rate : {4e-23, 1e-12, 2.}) {
        const double a = 1.1, end = rate + h * a, way = h * (rate + 0.5 * h * a);
        for (const double rounding : {angle + way, std::nextafter(angle + way, 100.)}) {
          const Step<double> step{0, h, {angle, rate}, {rate, a}, {rounding, end}, {end, a}};
          const Quintic<double> distance = step.distance(0, 1, angle);
          CAPTURE(angle, h, rate);
          CHECK(distance[0] == 0);
          for (int k = 1; k < 6; ++k) CHECK(distance[k] > distance[k - 1]);
          CHECK(distance[1] == Approx(0.2 * h * rate).epsilon(1e-12));
          CHECK(distance[5] == Approx(way).epsilon(1e-3).margin(64e-16 * std::abs(angle)));
          CHECK(step.rate(0, 1)[0] == Approx(rate).epsilon(1e-12).margin(0));
        }
      }
}

// Rounding is a share of the angle: what would be rounding of an angle of 1e4 rad is motion of one of 1e-4 rad.
TEST_CASE(
    "a step's dense output does not depend on the unit of its angle, in long and short steps") {
  for (const double unit : {0x1p-40, 0x1p-14, 1.0, 0x1p14, 0x1p40}) {
    CAPTURE(unit);
    const auto in_unit = [&](Step<double> step) {
      for (State<double>* state : {&step.x, &step.dxdt, &step.x1, &step.dxdt1})
        for (double& component : *state) component *= unit;
      return step;
    };
    const Layout at{0, 1, false};
    State<double> x(2);
    Step<double> bent = polynomial_step();
    const double h = 2e-14, v = 1.75;
    Step<double> tiny{0.3, h, {1.3, v}, {v, 0}, {std::nextafter(1.3 + h * v, 2.0), v}, {v, 0}};
    for (const double s : {0.2, 0.5, 0.9}) {
      CAPTURE(s);
      const Step<double> step = in_unit(bent);
      step.interpolate(at, s, x);
      CHECK(x[0] == Approx(unit * angle(s * step.h)).epsilon(1e-14));
      CHECK(x[1] == Approx(unit * rate(s * step.h)).epsilon(1e-13));
      CHECK(value(step.rate(0, 1), s) == Approx(unit * rate(s * step.h)).epsilon(1e-13));
      in_unit(tiny).interpolate(at, s, x);
      CHECK(x[1] == Approx(unit * v).epsilon(1e-12));
      CHECK(value(in_unit(tiny).rate(0, 1), s) == Approx(unit * v).epsilon(1e-12));
    }
  }
}
