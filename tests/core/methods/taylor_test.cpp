// Power series of a wing's motion against another method in extended precision.
#include "core/deployment.hpp"
#include "core/methods/steppers.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/stepping.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

RandomScene chain_of(int bodies) {
  RandomScene options;
  options.bodies = bodies, options.branching = false, options.motion = BaseMotion::fixed;
  options.friction = false, options.mass_lower = 1;
  return options;
}

enum class From { motion, rest, beside_latches, engaged };

/// A wing of the scene in a random state.
template <class T> struct RandomWing : TestWing<T> {
  RandomWing(std::uint64_t seed, const Scene& scene, From from) : TestWing<T>(scene) {
    if (from == From::engaged) this->engage_all();
    const Layout& at = this->system.layout();
    const WingState<double> state = random_state(seed, scene);
    for (int i = 1; i <= at.bodies; ++i) {
      const int hinge = this->wing.hinge_of[i];
      const T latched = this->wing.hinges[i].latched, angle(state.angles[hinge]);
      T& there = this->start[at.angle(i)];
      there = angle;
      if (from == From::beside_latches) there = latched + T(1e-4) * angle;
      if (from == From::engaged) there = latched + T(0.01 * i);
      this->start[at.rate(i)] = from == From::rest ? T(0) : T(state.rates[hinge]);
    }
  }
};

/// The largest difference of two states, in units of the tolerance.
double worst_in_tolerances(const State<double>& x, const State<long double>& exact,
                           double tolerance) {
  double worst = 0;
  for (std::size_t k = 0; k < exact.size(); ++k)
    worst = std::max(worst, std::abs(static_cast<double>(x[k] - exact[k])) /
                                (tolerance * (1 + std::abs(x[k]))));
  return worst;
}

/// The seed wing, or its first panels, with other numbers; all hinges and mass centres lie on one line at the start, and
/// the moments are constant.
Scene folded_straight(std::uint64_t seed, int bodies) {
  Scene scene = seed_scene();
  scene.bodies.resize(bodies), scene.hinges.resize(bodies);
  Draws draws(seed);
  for (Body& body : scene.bodies)
    body.mass *= draws.log_uniform(0.3, 3), body.inertia *= draws.log_uniform(0.3, 3);
  for (Hinge& hinge : scene.hinges) {
    hinge.parent_point = {hinge.parent_point.x() * draws.uniform(0.5, 1), 0};
    hinge.child_point = {hinge.child_point.x() * draws.uniform(0.5, 1), 0};
    hinge.stowed = draws.chance(0.5) ? 0 : std::numbers::pi;
    hinge.latched = hinge.stowed + draws.sign();
    const double torque = draws.uniform(0.1, 2);
    hinge.spring = {torque, torque}, hinge.harness = {}, hinge.friction = {};
  }
  return scene;
}

/// The largest error of a step that series fit to the tolerance, in units of it.
double error_of_fitted_step(std::uint64_t seed, const Scene& scene, From from, double tolerance) {
  RandomWing<double> wing(seed, scene, from);
  Adaptive<double, TaylorSeries<double>> series;
  series.restart({tolerance, tolerance});
  Stepping<double> at(wing.system, wing.start);
  const StepVerdict verdict = at.attempt(series, wing.system, 1e3);
  CHECK(verdict.accepted());
  CHECK(verdict.factor > 1);
  CHECK(verdict.error > 1e-4); // no shorter than need be: 1/32, less where rates grow in it
  const double fitted = at.made;
  CHECK(at.attempt(series, wing.system, 0.5 * fitted).accepted());
  CHECK(at.made == 0.5 * fitted);
  REQUIRE(at.attempt(series, wing.system, fitted).accepted());
  CHECK(at.made == fitted); // a landing relies on this
  RandomWing<long double> exact(seed, scene, from);
  Adaptive<long double, DormandPrince853<long double>> reference;
  const State<long double> there = after_steps<long double>(reference, exact, fitted / 512.L, 512);
  return worst_in_tolerances(at.x1, there, tolerance);
}

} // namespace

TEST_CASE("a step that series fit to the tolerance keeps it: chains, latched and not", "[long]") {
  constexpr int scenes = 60;
  double worst = 0;
  for (int k = 0; k < scenes; ++k) {
    const From from = static_cast<From>(k / 4 % 4);
    const Scene scene = random_scene(9000 + k, chain_of(1 + k % 4));
    for (const double tolerance : {1e-5, 1e-8, 1e-11}) {
      CAPTURE(k, static_cast<int>(from), tolerance);
      const double error = error_of_fitted_step(k, scene, from, tolerance);
      CHECK(error < 1);
      worst = std::max(worst, error);
    }
  }
  CHECK(worst > 1e-4); // and tolerances are made use of
}

TEST_CASE("a wing folded straight, set out by constant moments from rest, has terms of few orders "
          "alone") {
  Scene scene = seed_scene();
  for (Hinge& hinge : scene.hinges) {
    hinge.parent_point.y() = hinge.child_point.y() = 0;
    hinge.spring.torque_latched = hinge.spring.torque_stowed;
  }
  const auto run = [&](const char* method, double rtol) {
    Integration how;
    how.method = method, how.rtol = rtol, how.atol = 1e-2 * rtol, how.t_end = 10;
    return Deployment().run(scene, how, {});
  };
  const Outcome exact = run("dop853", 1e-13);
  REQUIRE(exact.latches.size() == 3);
  for (const double rtol : {1e-6, 1e-8, 1e-10, 1e-12}) {
    const Outcome out = run("taylor", rtol);
    REQUIRE(out.latches.size() == 3);
    CAPTURE(rtol);
    for (int k = 0; k < 3; ++k)
      CHECK(std::abs(out.latches[k].time / exact.latches[k].time - 1) < 0.1 * rtol + 1e-12);
  }
}

// Of the terms of their rates only every fourth is not 0. So the two last terms vanish, and say nothing of the error.
TEST_CASE("a step that series fit keeps the tolerance where its last terms vanish: wings folded "
          "straight, at rest, under constant moments") {
  double worst = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const int bodies = 2 + static_cast<int>(seed % 2);
    const Scene scene = folded_straight(seed, bodies);
    for (const double tolerance : {1e-5, 1e-8, 1e-11}) {
      TestWing<double> wing(scene);
      Adaptive<double, TaylorSeries<double>> series;
      series.restart({tolerance, tolerance});
      Stepping<double> at(wing.system, wing.start);
      CAPTURE(seed, bodies, tolerance);
      CHECK(at.attempt(series, wing.system, 1e3).accepted());
      TestWing<long double> exact(scene);
      Adaptive<long double, DormandPrince853<long double>> reference;
      const State<long double> there =
          after_steps<long double>(reference, exact, at.made / 512.L, 512);
      const double error = worst_in_tolerances(at.x1, there, tolerance);
      CHECK(error < 1);
      worst = std::max(worst, error);
    }
  }
  CHECK(worst > 1e-4);
}

TEST_CASE("halving a step by series divides its error by two to the seventeenth", "[long]") {
  const Scene scene = random_scene(731, chain_of(4));
  std::vector<double> errors;
  for (const double h : {0.02, 0.01}) {
    RandomWing<Quad> wing(5, scene, From::motion), exact(5, scene, From::motion);
    Adaptive<Quad, TaylorSeries<Quad>> series;
    Adaptive<Quad, Fehlberg78<Quad>> reference;
    const State<Quad> there = after_steps<Quad>(reference, exact, Quad(h) / 512, 512);
    errors.push_back(
        static_cast<double>(apart(after_steps<Quad>(series, wing, Quad(h), 1), there)));
  }
  CAPTURE(errors[0], errors[1]);
  CHECK(errors[1] > 1e-30);
  CHECK(std::log2(errors[0] / errors[1]) == Approx(17).margin(0.7));
}

TEST_CASE("samples inside a step by series have the accuracy of the series") {
  Integration how;
  how.method = "taylor", how.rtol = 1e-11, how.atol = 1e-13, how.t_end = 10;
  double worst = 0;
  int shown = 0;
  const Outcome out = Deployment().run(
      unit_oscillator(1, 0.5), how, {.to_t_end = true, .sample_interval = 0.05},
      [&](const Sample& at) {
        ++shown;
        const double angle = std::cos(at.t) + 0.5 * std::sin(at.t);
        const double rate = -std::sin(at.t) + 0.5 * std::cos(at.t);
        worst = std::max({worst, std::abs(at.angles[0] - angle), std::abs(at.rates[0] - rate)});
      });
  CHECK(out.work.steps < shown / 3);
  CHECK(shown == 201);
  CHECK(worst < 1e-11); // the quintic is 5e-7 off
}
