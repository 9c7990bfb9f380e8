#include "core/dense/roughness.hpp"
#include "core/mechanics/system.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The roughness of a step that a swing of one coordinate makes, from `phase` on by `turned`.
double roughness_of_swing(double phase, double turned) {
  const double h = 0.01, w = turned / h, last = phase + turned;
  Step<double> step;
  step.t = 0, step.h = h;
  step.x = {std::sin(phase), w * std::cos(phase)};
  step.x1 = {std::sin(last), w * std::cos(last)};
  step.dxdt = {step.x[1], -w * w * step.x[0]};
  step.dxdt1 = {step.x1[1], -w * w * step.x1[0]};
  return roughness(Layout{0, 1, false}, step, 1e-10);
}

} // namespace

TEST_CASE("a step over much of a swing is rough wherever it begins") {
  using std::numbers::pi;
  for (int k = 0; k < 24; ++k) {
    const double phase = 2 * pi * k / 24;
    CAPTURE(k);
    CHECK(roughness_of_swing(phase, 0.25) < 0.1); // a 25th of a period
    CHECK(roughness_of_swing(phase, 0.8 * 2 * pi) > 1);
  }
  // odd about its middle: the even part of the difference is nothing
  CHECK(roughness_of_swing(-0.4 * pi, 0.8 * pi) > 0.3);
  CHECK(roughness_of_swing(-0.8 * pi, 1.6 * pi) > 3);
}

// A hinge may be known up to 1e8 rad, where its angle is rounded by more than a short step moves it.
TEST_CASE("rounding makes no step rough, however far the hinge has turned and whatever is asked") {
  for (int seed = 1; seed <= 2000; ++seed) {
    Draws draws(seed);
    const double angle = draws.sign() * draws.log_uniform(1e-3, 1e8);
    const double rate = draws.sign() * draws.log_uniform(1e-6, 1);
    Step<double> step;
    step.t = 0, step.h = draws.log_uniform(1e-12, 1e-3);
    step.x = {angle, rate}, step.x1 = {angle + step.h * rate, rate};
    step.dxdt = step.dxdt1 = {rate, 0};
    CAPTURE(seed, angle, rate, step.h);
    CHECK(roughness(Layout{0, 1, false}, step, draws.log_uniform(1e-18, 1e-8)) < 1e-3);
  }
}

TEST_CASE("rounding does not make a tiny step rough") {
  Step<double> step;
  step.t = 0, step.h = 1e-9;
  step.x = {3, 1e-3}, step.dxdt = {1e-3, 0};
  step.x1 = {3 + 1e-12, 1e-3}, step.dxdt1 = {1e-3, 0};
  CHECK(roughness(Layout{0, 1, false}, step, 1e-10) < 1);
}

// The cubic Hermite interpolant is the quintic one of the accelerations that the cubic has at its ends.
TEST_CASE("a motor's roughness is its gain times what the rates of cubic and quintic differ by") {
  Scene scene = unit_oscillator(1);
  const double command = -0.4, gain = 0.3, limit = 5; // it deploys from 1 rad to 0
  scene.hinges[0].motor = Motor{.rate = -command, .gain = gain, .torque_limit = limit};
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
  Step<double> step;
  system.start(step.x);
  REQUIRE(system.motor_runs(1));
  for (State<double>* x : {&step.dxdt, &step.x1, &step.dxdt1}) x->assign(2, 0);
  double even = 0, odd = 0;
  for (int seed = 1; seed <= 200; ++seed) {
    Draws draws(seed);
    const double h = step.h = draws.log_uniform(1e-3, 1), v0 = draws.uniform(-1, 1),
                 v1 = draws.uniform(-1, 1), way = h * (v0 + v1) / 2 + h * draws.uniform(-0.1, 0.1);
    step.t = 0, step.x = {0.5, v0}, step.x1 = {0.5 + way, v1};
    step.dxdt = {v0, draws.uniform(-1, 1) / h}, step.dxdt1 = {v1, draws.uniform(-1, 1) / h};
    const Jet<double> start{0.5, v0, step.dxdt[1]}, end{0.5 + way, v1, step.dxdt1[1]};
    Jet<double> cubic_start = start, cubic_end = end;
    cubic_start.second = (6 * way / h - 4 * v0 - 2 * v1) / h;
    cubic_end.second = (-6 * way / h + 2 * v0 + 4 * v1) / h;
    const Quintic<double> quintic = derivative(hermite<double>(h, start, end), h),
                          cubic = derivative(hermite<double>(h, cubic_start, cubic_end), h);
    double off = 0;
    for (int k = 0; k <= 400; ++k)
      off = std::max(off, std::abs(value(quintic, k / 400.0) - value(cubic, k / 400.0)));
    const double moment = gain * std::max(std::abs(command - v0), std::abs(command - v1));
    const double expected = gain * off / (0.02 * std::max(moment, 1e-3 * limit));
    const double rough = roughness_of_motors(system, step);
    CAPTURE(seed, h, v0, v1, way);
    CHECK(expected <= rough * (1 + 1e-9));
    CHECK(rough <= 3 * expected); // (3) adds the largest slopes of two parts, which lie apart
    const double d0 = start.second - cubic_start.second, d1 = end.second - cubic_end.second;
    even = std::max(even, std::abs(d0 + d1)), odd = std::max(odd, std::abs(d1 - d0));
  }
  CHECK(std::min(even, odd) > 1);
}
