// What is told of a run's energy.
#include "core/deployment.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("energy that friction takes is drift as energy that a base brings in is") {
  Scene scene = unit_oscillator(1);
  scene.hinges[0].friction.viscous = 0.2 * panel_inertia; // damping ratio 0.1
  const Outcome out = Deployment().run(scene, within(1e-9, 5), to_the_end);
  CHECK(out.energy.final < out.energy.initial);
  CHECK(out.energy.drift_before_first_latch ==
        Approx(out.energy.initial - out.energy.final).epsilon(1e-6)); // it never grows
}
