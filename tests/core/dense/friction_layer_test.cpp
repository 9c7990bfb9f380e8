// Steps through the layer of rates in which regularized friction changes its sign: single steps, and whole runs of wings
// with friction against CVODE on the dense formulation.
#include "core/dense/friction_layer.hpp"
#include "core/deployment.hpp"
#include "tests/core/packs/same_bits.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/reference_run.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A three-panel wing with harness, friction regularized over 1e-3 rad/s at every hinge, and latches with the given
/// damping.
Scene rubbing_wing(int unit, double least_damping = 0.7) {
  Draws draws(5000 + unit);
  Scene scene = seed_scene();
  const HingeTorque harness[] = {{0.1, 0.05}, {0.08, 0.04}, {0.04, 0.02}};
  for (int i = 0; i < 3; ++i) {
    Hinge& hinge = scene.hinges[i];
    const double spring = draws.uniform(0.9, 1.1);
    hinge.spring.torque_stowed *= spring, hinge.spring.torque_latched *= spring;
    hinge.harness = harness[i];
    hinge.friction.coulomb = draws.log_uniform(0.01, 0.04);
    hinge.friction.viscous = 0.02 * draws.uniform(0.5, 2);
    hinge.latch->stiffness *= draws.uniform(0.7, 1.3);
    hinge.latch->damping *= draws.log_uniform(least_damping, 1.3);
    scene.bodies[i].mass *= draws.uniform(0.96, 1.04);
  }
  return scene;
}

struct Errors {
  double rate = 0, peak = 0;
};

Errors errors_of(const Outcome& out, const ReferenceOutcome& exact) {
  Errors worst;
  REQUIRE(out.latches.size() == exact.latches.size());
  for (std::size_t k = 0; k < out.latches.size(); ++k) {
    const int hinge = exact.latches[k].hinge;
    REQUIRE(out.latches[k].hinge == hinge);
    worst.rate = std::max(
        worst.rate, std::abs(out.latches[k].rates[hinge] / exact.latches[k].rates[hinge] - 1));
  }
  for (std::size_t i = 0; i < out.peak_moment.size(); ++i)
    worst.peak =
        std::max({worst.peak, std::abs(out.peak_moment[i].value / exact.peak_moment[i].value - 1),
                  std::abs(out.peak_force[i].value / exact.peak_force[i].value - 1)});
  return worst;
}

/// The limits of a step of one hinge from rate v0 to v1, with the acceleration a at its end.
LayerLimits<double> limits(double v0, double v1, double a, double coulomb = 0.1) {
  Scene scene = latching_panel();
  scene.hinges[0].friction.coulomb = coulomb; // ω_s = 1e-3
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Step<double> step;
  step.t = 0, step.h = 0.01;
  step.x = {0, v0}, step.x1 = {0, v1}, step.dxdt = {v0, a}, step.dxdt1 = {v1, a};
  return layer_limits(wing, Layout{0, 1, false}, step, 1e-8, 1e-10);
}

} // namespace

TEST_CASE("a step that leaps over the layer of a friction is cut, one that samples it is not") {
  CHECK(limits(0.5, -0.5, -100).cut == Approx(0.325)); // to 0.35 of the rate
  CHECK(limits(0.5, 0.1, -40).cut == Approx(0.8125));  // the same, without a crossing
  CHECK(limits(2e-3, -9e-3, -1.1).cut < 0.3);          // in the layer
  CHECK(limits(1e-3, 0.1, 10).cut < 0.05);             // out of it
  CHECK(limits(0.5, 0.2, -30).cut > 1);
  CHECK(limits(1e-3, -1.5e-3, -0.25).cut > 1);
  CHECK(limits(1e-5, 1.1e-5, 1e-4).cut > 1);                // a hinge that creeps
  CHECK(limits(0.5, -0.5, -100, 0).cut > 1);                // no friction
  CHECK(limits(0.5, -0.5, -100, 1e-7).cut > 1);             // none that could matter
  CHECK(limits(0.8, 0.5, -30).next == Approx(0.325 / 0.3)); // towards zero
  CHECK(limits(0.5, 0.8, 30).next == Approx(3 * 0.8 / 0.3).epsilon(1e-5));
  for (const auto& [v0, v1, a] : {std::array{0.5, -0.5, -100.},
                                  {2e-3, -9e-3, -1.1},
                                  {1e-3, 0.1, 10.},
                                  {0.8, 0.5, -30.},
                                  {0.5, 0.8, 30.},
                                  {0.5, 0.1, 40.},
                                  {0.1, 0.5, -40.}}) { // neither sense is preferred
    const LayerLimits<double> one = limits(v0, v1, a), other = limits(-v0, -v1, -a);
    CAPTURE(v0, v1, a);
    CHECK(one.cut == other.cut);
    CHECK(one.next == other.next);
  }
}

TEST_CASE("runs of rubbing wings are right: by default to 1e-6 in rates and 1e-5 in peaks",
          "[long]") {
  double default_rate = 0, default_peak = 0, loose_rate = 0, tight_rate = 0;
  long loose = 0, usual = 0, cash_karp = 0;
  for (int unit = 0; unit < 12; ++unit) {
    const Scene scene = rubbing_wing(unit, unit % 2 == 0 ? 0.7 : 0.05);
    ReferenceOptions options;
    options.t_end = 12, options.rtol = 1e-13, options.atol = 1e-15;
    const ReferenceOutcome exact = cvode_run(scene, options);
    const auto run = [&](const char* method, double rtol) {
      Integration how = within(rtol, 12);
      how.method = method;
      return Deployment().run(scene, how, to_the_end);
    };
    CAPTURE(unit);
    const Outcome out = run("auto", 1e-8), at_1e6 = run("auto", 1e-6), at_1e3 = run("auto", 1e-3);
    const Errors errors = errors_of(out, exact);
    default_rate = std::max(default_rate, errors.rate);
    default_peak = std::max(default_peak, errors.peak);
    tight_rate = std::max(tight_rate, errors_of(at_1e6, exact).rate);
    loose_rate = std::max(loose_rate, errors_of(at_1e3, exact).rate);
    usual += out.work.rhs_evaluations, loose += at_1e6.work.rhs_evaluations;
    cash_karp += run("cash_karp54", 1e-8).work.rhs_evaluations;
  }
  CAPTURE(default_rate, default_peak, tight_rate, loose_rate, usual / 12, loose / 12,
          cash_karp / 12);
  CHECK(default_rate < 1e-6); // 2e-6 where the layer was leapt over
  CHECK(default_peak < 1e-5);
  CHECK(tight_rate < 1e-5); // 3e-4
  CHECK(loose_rate < 2e-2);
  CHECK(static_cast<double>(loose) < 0.75 * static_cast<double>(cash_karp)); // for 1e-5
  CHECK(static_cast<double>(usual) < 1.2 * static_cast<double>(cash_karp));
}

TEST_CASE("a run in a lane has the bits of the run alone: rubbing wings") {
  std::vector<Scene> scenes;
  for (int unit = 0; unit < 19; ++unit) scenes.push_back(rubbing_wing(unit));
  scenes[3].hinges[0].friction.coulomb = scenes[3].hinges[1].friction.coulomb = 0;
  for (Hinge& hinge : scenes[5].hinges) hinge.friction.coulomb = 0;
  for (const double rtol : {1e-3, 1e-8})
    for (const Goal& goal : {Goal{.audit = false}, latches_only})
      require_equal_bits(scenes, within(rtol, 12), goal);
}
