#include "core/dense/roughness.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

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
