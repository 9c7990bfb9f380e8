// What a hold bears of a loop on its hinge: a closed form, alone and in lanes.
#include "tests/core/deployment/real_runs.hpp"

using namespace wingspread;
using namespace wingspread::oracle;

// Two panels beside each other on a fixed base. The first swings against a loop to the second, which is held: its travel
// is (τ/K)(1 − cos ωt), ω² = K/J. The hold bears the second's spring and K times that travel.
TEST_CASE(
    "a hold bears its hinge's spring and the loop that another hinge pulls, whatever the steps") {
  for (const double stiffness : {3.0, 5.0, 20.0}) {
    Scene scene = latching_panel();
    scene.bodies.push_back({"other_panel", 10, 0.5});
    Hinge other = scene.hinges[0];
    other.name = "other", other.child = 1, other.parent_point = {3, 1};
    other.release = Release{.time = 40};
    scene.hinges.push_back(other);
    Synchronisation loop;
    loop.name = "loop", loop.first = 0, loop.second = 1, loop.ratio = 1;
    loop.stiffness = stiffness;
    scene.synchronisations = {loop};
    const double half = std::numbers::pi * std::sqrt(panel_inertia / stiffness);
    for (const double rtol : {1e-5, 1e-8, 1e-11}) {
      const Outcome out = Deployment().run(scene, within(rtol, 5 * half), {});
      CAPTURE(stiffness, rtol);
      REQUIRE(out.hold_moment.size() == 2);
      CHECK(out.hold_moment[1].value == Approx(2 + 2 * 2).epsilon(20 * rtol));
      require_equal_bits({scene, scene, scene}, within(rtol, 5 * half), every_peak);
    }
  }
}
