// The bounds by modes against the worst that friction of either sign could do to one hinge.
#include "tests/core/proofs/latched_wing.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace wingspread;
using oracle::Latched;

namespace {

/// The seed scene's first panel alone on its latch, with dry friction.
Scene rubbing_panel(double damping) {
  Scene scene = oracle::seed_scene();
  scene.bodies.resize(1), scene.hinges.resize(1);
  Hinge& hinge = scene.hinges[0];
  hinge.spring = {}, hinge.harness = {};
  hinge.friction.coulomb = 1, hinge.friction.regularization_rate = 0.02;
  hinge.latch->damping = damping;
  return scene;
}

/// J ü + c u̇ + k u = f(t), from u and v on.
struct Swing {
  double inertia, damping, stiffness, u, v;

  [[nodiscard]] double moment() const { return std::abs(stiffness * u + damping * v); }

  /// One step of Runge and Kutta's classical method under a constant push.
  void go(double push, double h) {
    const auto rise = [&](double y, double w) {
      return (push - stiffness * y - damping * w) / inertia;
    };
    const double a1 = rise(u, v), a2 = rise(u + h / 2 * v, v + h / 2 * a1);
    const double a3 = rise(u + h / 2 * (v + h / 2 * a1), v + h / 2 * a2);
    const double a4 = rise(u + h * (v + h / 2 * a2), v + h * a3);
    u += h * (v + h / 6 * (a1 + a2 + a3));
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
};

/// The largest moment of a motion that a square wave drives in time with its own swing. @param phase of the wave, rad
double largest_moment(Swing swing, double push, double omega, double phase, double seconds) {
  constexpr int steps = 200; // a period
  const double h = 2 * std::numbers::pi / omega / steps;
  double most = swing.moment();
  for (long k = 0; static_cast<double>(k) * h < seconds; ++k) {
    const double angle = omega * (static_cast<double>(k) + 0.5) * h + phase;
    swing.go(std::cos(angle) > 0 ? push : -push, h);
    most = std::max(most, swing.moment());
  }
  return most;
}

} // namespace

TEST_CASE("friction in time with a swing drives it no further than the bound by modes, and nearly "
          "as far") {
  for (const double ratio : {0.002, 0.02, 0.1, 0.3, 0.6, 0.75, 0.95, 2.0}) { // of critical damping
    const Latched<BaseMotion::fixed> undamped(rubbing_panel(1e-6));
    REQUIRE(undamped.has_model);
    const double k = undamped.model.stiffness(0, 0), inertia = undamped.model.mass(0, 0);
    const double critical = 2 * std::sqrt(k * inertia);
    const Latched<BaseMotion::fixed> wing(rubbing_panel(ratio * critical));
    REQUIRE(wing.has_model);
    const double c = wing.model.damping(0, 0), push = wing.model.remainders[0].steady;
    REQUIRE(c == Approx(ratio * critical));
    REQUIRE(push == Approx(1));
    const double alpha = c / (2 * inertia);
    const double omega = std::sqrt(std::max(k / inertia - alpha * alpha, 0.01 * k / inertia));
    const double steady = push * critical / c / k; // of the order of what friction can keep up
    for (const double start : {0.0, 0.3, 0.6, 1.0, 3.0}) {
      double closest = 0;
      for (int phase = 0; phase < 12; ++phase)
        for (const bool moves : {false, true}) {
          State<double> x = wing.rest();
          Swing swing{inertia, c, k, 0, 0};
          (moves ? swing.v : swing.u) = start * steady * (moves ? std::sqrt(k / inertia) : 1);
          x[wing.at.angle(1)] += swing.u, x[wing.at.rate(1)] = swing.v;
          const auto bounds = wing.bound(x, 0, std::nullopt, 0);
          REQUIRE(bounds);
          const double most =
              largest_moment(swing, push, omega, phase * std::numbers::pi / 6, 6 / alpha);
          closest = std::max(closest, (most + push) / bounds->moment(0));
        }
      CAPTURE(ratio, start, closest);
      CHECK(closest <= 1);
      if (ratio < 0.5) CHECK(closest >= (start == 0 || start == 3 ? 0.9 : 0.8));
    }
  }
}
