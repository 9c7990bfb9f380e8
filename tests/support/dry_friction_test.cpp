// The oracle's exact friction against closed forms.
#include "tests/support/closed_forms.hpp"
#include "tests/support/reference_run.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

ReferenceOutcome dry_extended(const Scene& scene, double t_end) {
  ReferenceOptions options;
  options.rtol = 1e-16, options.atol = 1e-17, options.t_end = t_end;
  return high_precision_run<long double>(scene, options);
}

} // namespace

TEST_CASE("the oracle's hinge slides, turns and stops as the closed form says") {
  struct Case {
    double viscous, u, rate, kinetic, static_level;
  };
  for (const Case& c : {Case{0, 1.05, 0, 0.3, 0.3}, Case{0.4, 0.7, 0.5, 0.3, 0.5},
                        Case{0.2, -0.7, 0.5, 0.1, 0.1}}) {
    const CoulombOscillator exact(
        {panel_inertia, panel_inertia, c.viscous, c.kinetic, c.static_level}, {c.u, c.rate});
    Scene scene = unit_oscillator(c.u, c.rate);
    rub(scene.hinges[0], c.kinetic, c.static_level);
    scene.hinges[0].friction.viscous = c.viscous;
    for (const double t : {1., 4., 7., 40.}) {
      const ReferenceOutcome out = dry_extended(scene, t);
      CAPTURE(c.viscous, c.u, t, exact.stop_time());
      // the closed form is in double
      CHECK(std::abs(out.final.angles(0) - exact.at(t).u) < 3e-14);
      CHECK(std::abs(out.final.rates(0) - exact.at(t).rate) < 3e-14);
      if (t > exact.stop_time() + 1e-6) CHECK(out.final.rates(0) == 0);
    }
  }
}

TEST_CASE(
    "the oracle's hinge is held by what its neighbour's swing takes, and let go at its limit") {
  Scene scene = coaxial_discs(3, 2); // see grazing_release_test.cpp: it bears 2 φ̈, at most √5
  scene.hinges[0].stowed = 1, scene.hinges[0].latched = -50, scene.hinges[0].initial_rate = 0.5;
  pull_towards(scene.hinges[0], 0, 5);
  rub(scene.hinges[1], 10);
  const ReferenceOutcome held = dry_extended(scene, 4);
  CHECK(held.peak_moment[1].value == Approx(std::sqrt(5)).epsilon(1e-15));
  CHECK(held.final.rates(1) == 0);
  rub(scene.hinges[1], 1, 2.23605);
  const double release = std::atan(0.5) - std::acos(2.23605 / std::sqrt(5));
  CHECK(dry_extended(scene, release - 1e-6).final.rates(1) == 0);
  CHECK(std::abs(dry_extended(scene, release + 1e-3).final.rates(1)) > 1e-4);
}
