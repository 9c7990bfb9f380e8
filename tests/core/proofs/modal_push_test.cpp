// The bounds by modes under a push on a base that turns.
#include "tests/core/proofs/latched_wing.hpp"

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
