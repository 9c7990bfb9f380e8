#include "montecarlo/model/input_checks/clearance_check.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <string>

using namespace wingspread;

TEST_CASE("the clearance check tells when bodies meet, inside a step too", "[warnings]") {
  // a beam turns at 0.5 rad/s about the origin, from 0; the foot of a mast stands 1 rad ahead, half a metre out
  Scene scene;
  scene.bodies = {{"beam", 1, 0.1}, {"mast", 1, 0.1}};
  Hinge beam, mast;
  beam.name = "root", beam.child = 0, beam.child_point = {-1, 0};
  beam.latched = 2, beam.initial_rate = 0.5, beam.latch = Latch{1e3, 1};
  mast.name = "foot", mast.child = 1, mast.child_point = {-0.4, 0};
  mast.parent_point = {0.5 * std::cos(1.), 0.5 * std::sin(1.)};
  mast.stowed = 2.57, mast.latched = 3, mast.latch = Latch{1e3, 1};
  scene.hinges = {beam, mast};
  for (const bool mirrored : {false, true}) {
    if (mirrored) // angles of the other sign, about the x axis
      for (Hinge& hinge : scene.hinges) {
        hinge.parent_point.y() *= -1, hinge.stowed *= -1, hinge.latched *= -1;
        hinge.initial_rate *= -1;
      }
    CAPTURE(mirrored);
    InputWarnings warnings({});
    (void)check_clearance(scene, {}, warnings);
    REQUIRE(warnings.list().size() == 1);
    double time = 0;
    const std::string& found = warnings.list()[0].found;
    REQUIRE(std::sscanf(found.c_str(), "beam and mast pass through each other at %lf s", &time) ==
            1);
    CHECK((time > 2 - 1e-3 && time < 2 + 0.11)); // compared every 0.05 rad
  }
}
