// Whole runs against independent ones: another formulation, other integrators, closed forms.
#include "core/deployment.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The errors of the seed wing's latches and of its state at 7 s.
double deployment_error(const Integration& how) {
  Goal goal{.peak_moment = false, .peak_force = false, .audit = false, .to_t_end = true};
  const Outcome out = Deployment().run(seed_scene(), how, goal);
  CAPTURE(out.reason);
  REQUIRE(out.latches.size() == 3);
  double worst = 0;
  for (int i = 0; i < 3; ++i)
    worst = std::max({worst, std::abs(out.latches[i].time - seed_reference().latches[i].time),
                      std::abs(out.final.angles[i] - seed_reference().final.angles(i)),
                      std::abs(out.final.rates[i] - seed_reference().final.rates(i))});
  return worst;
}

} // namespace

TEST_CASE("the three-panel wing gives the figures of an independent model") {
  // Produced outside this repository by SciPy's DOP853 at rtol 1e-11
  // on a dense model in absolute angles.
  const Outcome out = run(oracle::seed_scene(), 1e-10, 12);
  REQUIRE(out.status == Status::deployed);
  REQUIRE(out.latches.size() == 3);
  const double time[] = {4.819271, 6.047369, 6.794189}, rate[] = {-1.267827, 0.732120, -1.160431};
  const double moment[] = {250.4651, 84.6102, 115.9431};
  for (int k = 0; k < 3; ++k) {
    CHECK(out.latches[k].hinge == k); // root, mid, tip
    CHECK(std::abs(out.latches[k].time - time[k]) < 1e-6);
    CHECK(std::abs(out.latches[k].rates[k] - rate[k]) < 1e-6);
    CHECK(std::abs(out.peak_moment[k].value - moment[k]) < 1e-4);
  }
  // the tip's peak is at its own engagement: d |φ̇| less the spring that is left, at t⁺
  CHECK(out.peak_moment[2].time == out.latches[2].time);
  CHECK(out.peak_moment[2].value ==
        Approx(100 * std::abs(out.latches[2].rates[2]) - 0.1).epsilon(1e-12));
}

TEST_CASE("latches, peak moments and peak forces agree with extended precision by another route") {
  const oracle::ReferenceOutcome exact = reference(oracle::seed_scene(), 12);
  compare(run(oracle::seed_scene(), 1e-8, 12), exact, 1e-7, 1e-6);
  compare(run(oracle::seed_scene(), 1e-10, 12), exact, 1e-9, 1e-8);
  compare(run(oracle::seed_scene(), 1e-12, 12), exact, 1e-11, 1e-10);
}

TEST_CASE("peaks inside the long steps of extrapolation have the accuracy of its steps", "[long]") {
  // A step spans more than a peak. The dense output alone is off by 2e-6 and 4e-6 in the first two,
  // whatever the tolerance; in the third its maximum stands so far from the force's own that a step
  // to it gives 7e-11 too little.
  struct Case {
    double stiffness, damping, rtol;
  };
  for (const Case& c : {Case{1.05e4, 115, 1e-12}, {1.05e4, 130, 1e-12}, {9e3, 130, 1e-11}}) {
    Scene scene = oracle::seed_scene();
    for (Hinge& hinge : scene.hinges)
      hinge.latch->stiffness = c.stiffness, hinge.latch->damping = c.damping;
    Integration how = within(c.rtol, 7.2);
    how.method = "bulirsch_stoer";
    CAPTURE(c.stiffness, c.damping);
    compare(Deployment().run(scene, how, to_the_end), reference(scene, 7.2), 1e-10, 2e-11);
  }
}

TEST_CASE("random wings with every base motion agree with the reference", "[long]") {
  std::size_t latches = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    oracle::RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 4);
    options.mass_lower = 1, options.mass_upper = 20;
    options.motion = static_cast<BaseMotion>(seed % 3);
    const Scene scene = oracle::random_scene(seed, options);
    CAPTURE(seed, options.bodies);
    const Outcome got = run(scene, 1e-11, 1.5);
    REQUIRE(got.status != Status::failed);
    compare(got, reference(scene, 1.5), 1e-8, 1e-7);
    latches += got.latches.size();
  }
  CHECK(latches >= 8);
}

TEST_CASE("one panel has closed forms before and after its latch") {
  const Scene scene = oracle::latching_panel();
  const double inertia = 0.5 + 10 * 0.25, travel = 1.5707963267948966, torque = 2, k = 1e4, d = 100;
  const Outcome out = run(scene, 1e-10, 5);
  REQUIRE(out.latches.size() == 1);
  const double t = std::sqrt(2 * travel * inertia / torque), speed = torque / inertia * t;
  CHECK(relative(out.latches[0].time, t) < 1e-9);
  CHECK(relative(std::abs(out.latches[0].rates[0]), speed) < 1e-9);
  // after it: y'' + 2 δ y' + ω² y = torque/inertia in the deploying sense, y(0) = 0, y'(0) = speed.
  // |M| = |torque − k y − d y'|, maximised on a fine grid and refined by its neighbours' parabola
  const double delta = d / (2 * inertia), omega = std::sqrt(k / inertia - delta * delta),
               rest = torque / k;
  const auto moment = [&](double s) {
    const double b = (speed - delta * rest) / omega, e = std::exp(-delta * s);
    const double y = rest + e * (-rest * std::cos(omega * s) + b * std::sin(omega * s));
    const double v =
        -delta * (y - rest) + e * omega * (rest * std::sin(omega * s) + b * std::cos(omega * s));
    return std::abs(torque - k * y - d * v);
  };
  double best = 0;
  for (int i = 0; i <= 2'000'000; ++i) best = std::max(best, moment(i * 1e-7));
  CHECK(relative(out.peak_moment[0].value, best) < 1e-9);
}

TEST_CASE("the error of a whole deployment follows the tolerance") {
  for (const MethodInfo& method : methods()) {
    if (method.name == "runge_kutta4") continue;
    // a method of order 3 takes 1e5 steps for 1e-11; extrapolation of a linear solve rounds
    const int last = method.name == "rosenbrock_w" ? 9 : 12;
    const double round_off = method.name == "seulex" ? 5e-9 : 5e-13;
    for (int digits = 3; digits <= last; ++digits) {
      Integration how;
      how.method = method.name, how.t_end = 7;
      how.rtol = std::pow(10., -digits), how.atol = 0.1 * how.rtol;
      CAPTURE(method.name, digits);
      CHECK(deployment_error(how) < 3 * how.rtol + round_off);
    }
  }
}

TEST_CASE("the error of a whole deployment falls with the fourth power of a fixed step") {
  double before = 0;
  for (const double step : {4e-3, 2e-3, 1e-3, 5e-4}) {
    Integration how;
    how.method = "runge_kutta4", how.step = step, how.t_end = 7, how.rtol = how.atol = 1;
    const double error = deployment_error(how);
    CAPTURE(step, std::log10(error));
    if (before > 0) CHECK(std::log2(before / error) == Approx(4).margin(0.6));
    before = error;
  }
}
