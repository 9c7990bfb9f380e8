// The air's part of the bound on a locked hinge's load, on two bodies that turn faster and faster on a base that is pushed: it
// has the value of (2) and (3), computed here with numbers for that wing alone.
#include "core/events/stuck_load.hpp"
#include "tests/core/dense/any_motion.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>

using namespace wingspread;

namespace {

/// Bounds of a vector and its first two derivatives.
struct Sizes {
  double value, first, second;
  Sizes plus(double factor, const Sizes& b) const {
    return {value + factor * b.value, first + factor * b.first, second + factor * b.second};
  }
};

/// An angle with a constant acceleration.
struct TurningFaster {
  double angle, rate, acceleration;
  [[nodiscard]] double fastest(double h) const {
    return std::max(std::abs(rate), std::abs(rate + h * acceleration));
  }
  TurningFaster operator-(const TurningFaster& b) const {
    return {angle - b.angle, rate - b.rate, acceleration - b.acceleration};
  }
  /// (2) of a vector in axes that turn so.
  [[nodiscard]] Sizes sees(const Sizes& v, double h) const {
    const double d = fastest(h), a = std::abs(acceleration);
    return {v.value, v.first + d * v.value, v.second + 2 * d * v.first + (a + d * d) * v.value};
  }
};

/// An arm of this length with a plate at its end, on a base of constant acceleration.
struct PlateOnArm {
  double arm, reach, strength, velocity, acceleration, h;
  std::array<TurningFaster, 2> bodies; ///< against inertial axes

  /// d²L/dt² of both hinges, as seen from axes that turn so. Their sizes are the same from all axes.
  [[nodiscard]] std::array<Sizes, 2> loads(const TurningFaster& axes) const {
    const auto swing = [&](int k) {
      return (bodies[k] - axes)
          .sees({bodies[k].fastest(h), std::abs(bodies[k].acceleration), 0}, h);
    };
    const Sizes base = axes.sees({velocity + acceleration * h, acceleration, 0}, h);
    const TurningFaster first = bodies[0] - axes, second = bodies[1] - axes;
    const Sizes v = second.sees(base.plus(arm, swing(0)).plus(reach, swing(1)), h);
    const Sizes force{strength * v.value * v.value, 2 * strength * v.value * v.first,
                      2 * strength * (v.value * v.second + v.first * v.first)};
    const Sizes outer{reach * force.value, 0, reach * force.second};
    return {outer.plus(arm, first.sees(second.sees(force, h), h)), outer};
  }
};

} // namespace

TEST_CASE("the bound on a locked hinge's load has the air's terms, seen from inertial axes and "
          "from its body") {
  for (int trial = 0; trial < 40; ++trial) {
    oracle::Draws draws(9700 + trial);
    Scene scene = oracle::latching_panel();
    scene.bodies = {Body{"arm", 1e-15, 1e-15}, Body{"plate", 1e-15, 1e-15}};
    Hinge root = scene.hinges[0], tip = scene.hinges[0];
    root.name = "root", tip.name = "tip";
    root.parent = base_index, root.child = 0, tip.parent = 0, tip.child = 1;
    root.parent_point = root.child_point = tip.child_point = {0, 0};
    const double arm = draws.uniform(0.1, 2), reach = draws.uniform(0.1, 1);
    tip.parent_point = {arm, 0};
    scene.hinges = {root, tip};
    scene.bodies[1].plate = Plate{{reach / 2, 0}, {reach, 0}, 1, 2};
    scene.environment.air_density = draws.log_uniform(0.1, 10);
    scene.base.motion = BaseMotion::prescribed;
    scene.base = oracle::driven_by_table(scene, 1, 3).base;
    const double h = draws.log_uniform(0.01, 1);
    oracle::AnyMotion<BaseMotion::prescribed> motion(scene, 1, h, 0);
    const auto part = [&] {
      return draws.chance(0.3) ? 0 : draws.sign() * draws.log_uniform(0.1, 3);
    };
    PlateOnArm wing{arm, reach, motion.wing.plates[2].strength, std::abs(part()), std::abs(part()),
                    h,   {}};
    const TurningFaster first{0.3, part(), part() / h}, between{-0.4, part(), part() / h};
    wing.bodies = {first, first - (TurningFaster{} - between)};
    Step<double>& step = motion.step;
    for (int k = 0; k < 2; ++k) {
      const TurningFaster& turn = k == 0 ? first : between;
      step.x[k] = turn.angle, step.x[k + 2] = step.dxdt[k] = turn.rate;
      step.x1[k + 2] = step.dxdt1[k] = turn.rate + h * turn.acceleration;
      step.x1[k] = turn.angle + h * (turn.rate + 0.5 * h * turn.acceleration);
      step.dxdt[k + 2] = step.dxdt1[k + 2] = turn.acceleration;
    }
    DrivenPiece<double>& piece = motion.system.writable_workspace().driven;
    piece.from = step.t, piece.until = never;
    piece.x = piece.turning = {0, 0, 0, 0}, piece.y = {wing.acceleration, 0, 0, 0};
    piece.velocity = {0, wing.velocity}, piece.rate = piece.angle = 0;
    HeldLoadBound<double> bound;
    bound.over_step(motion.system, step);
    const auto inertial = wing.loads({0, 0, 0});
    CAPTURE(trial, first.rate, first.acceleration, between.rate, between.acceleration);
    const auto check = [&](int i, double bend) {
      const double margin = 1e-9 * h * h * inertial[0].second + 1e-10;
      CHECK(bound.rise(i) == Approx(h * h / 6 * bend).epsilon(1e-6).margin(margin));
      CHECK(bound.size(i) == Approx(inertial[i - 1].value).epsilon(1e-6).margin(1e-10));
    };
    for (const int i : {1, 2}) {
      check(i, inertial[i - 1].second);
      bound.narrow(motion.system, step, i);
      check(i, std::min(inertial[i - 1].second, wing.loads(wing.bodies[i - 1])[i - 1].second));
    }
  }
}
