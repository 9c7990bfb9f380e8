// The bounds by modes under a push on a base that turns.
#include "tests/core/proofs/latched_wing.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace wingspread;
using oracle::Latched;

TEST_CASE(
    "a push is followed as the base turns under it, and not taken for one that finds every mode") {
  Scene scene = oracle::seed_scene();
  scene.base.motion = BaseMotion::prescribed;
  for (const double rate : {-0.2, 0.035, 0.1}) {
    scene.base.rate = rate, scene.base.angle = 0.7, scene.base.acceleration = {0.06, -0.08};
    for (Hinge& hinge : scene.hinges) hinge.friction = {}, hinge.latch->damping = 200;
    Latched<BaseMotion::prescribed> wing(scene);
    REQUIRE(wing.has_model);
    const Layout& at = wing.at;
    State<double> x = wing.rest();
    constexpr double turn = 2 * std::numbers::pi;
    const int round = static_cast<int>(turn / std::abs(rate) / 0.002);
    const auto ring_off = [&](int steps, double from, const auto& look) {
      State<double> k1(at.size()), k2 = k1, y = x; // Heun's steps of 2 ms
      for (int step = 0; step < steps; ++step) {
        const double t = from + 0.002 * step;
        wing.system(x, k1, t);
        look();
        for (int j = 0; j < at.size(); ++j) y[j] = x[j] + 0.002 * k1[j];
        wing.system(y, k2, t + 0.002);
        for (int j = 0; j < at.size(); ++j) x[j] += 0.001 * (k1[j] + k2[j]);
      }
    };
    const int before = std::max(round, 60000);
    ring_off(before, 0, [] {});
    const std::optional<HingeBounds> bounds = wing.bound(x, 0.002 * before, std::nullopt, 0);
    REQUIRE(bounds);
    const HingeVector& bound = bounds->moment;
    Eigen::VectorXd most = Eigen::VectorXd::Zero(at.bodies);
    ring_off(round, 0.002 * before, [&] {
      for (int i = 1; i <= at.bodies; ++i)
        most(i - 1) = std::max(most(i - 1), std::abs(wing.system.moment(x, i)));
    });
    CAPTURE(rate, bound.transpose(), most.transpose());
    CHECK((most.array() <= bound.array()).all());
    CHECK(bound(0) < 1.5 * most(0));
  }
}

// A panel stands square to a long boom of a base that turns faster and faster. At rest the boom's acceleration does not
// load the hinge; off rest it does, by its length, and by more the further the panel turns.
TEST_CASE(
    "no motion breaks the bounds by modes where a long boom accelerates a panel off its rest") {
  double most = 0;
  int bounded = 0;
  for (int k = 0; k < 200; ++k) {
    oracle::Draws draws(7300 + k);
    Scene scene = oracle::latching_panel();
    Hinge& hinge = scene.hinges[0];
    scene.base.motion = BaseMotion::prescribed;
    const double boom = draws.log_uniform(30, 200), quickening = draws.log_uniform(1e-2, 1);
    hinge.parent_point = {boom, 0}, hinge.child_point = {0, -0.5};
    hinge.stowed = -1, hinge.latched = 0, hinge.spring = {};
    const double by_turn =
        boom * 10 * 0.5 * quickening; // moment of the boom's acceleration, N·m/rad
    const double stiffness = draws.uniform(2, 5) * by_turn;
    const double damping = draws.uniform(3, 8) * std::sqrt(oracle::panel_inertia * stiffness);
    hinge.latch = Latch{stiffness, damping};
    scene.base.angular_acceleration = quickening;
    const double end = draws.log_uniform(0.03, 1) * damping / stiffness;
    scene.base.rate = -0.5 * quickening * end; // and back: the base hardly turns
    Latched<BaseMotion::prescribed> wing(scene, end);
    REQUIRE(wing.has_model);
    State<double> x = wing.rest(), dxdt(2), half(2), y(2);
    const double balanced = oracle::panel_inertia * quickening / (stiffness - by_turn); // rad
    x[0] -= draws.uniform(0.2, 0.95) * balanced;
    const auto bounds = wing.bound(x, 0, std::nullopt, 0);
    if (!bounds) continue;
    ++bounded;
    CAPTURE(k, boom, quickening, end);
    constexpr int steps = 400;
    const double h = end / steps;
    for (int step = 0; step <= steps; ++step) {
      wing.system(x, dxdt, step * h);
      const Vec2<double>& f = wing.work.forces[1];
      const double force = std::sqrt(dot(f, f));
      CHECK(std::abs(wing.system.moment(x, 1)) <= bounds->moment(0));
      CHECK(force <= bounds->force(0));
      CHECK(std::abs(x[0] - wing.model.angles(0)) <= bounds->way(0));
      most = std::max(most, force / bounds->force(0));
      for (int j = 0; j < 2; ++j) y[j] = x[j] + 0.5 * h * dxdt[j];
      wing.system(y, half, (step + 0.5) * h);
      for (int j = 0; j < 2; ++j) x[j] += h * half[j];
    }
  }
  CHECK(bounded >= 150);
  CHECK(most > 0.9);
}
