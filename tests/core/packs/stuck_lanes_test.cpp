// Runs in lanes whose steps are limited by the motion of their base while a hinge sticks.
#include "tests/core/packs/same_bits.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_scenes.hpp"

using namespace wingspread;
using namespace wingspread::oracle;

// A hinge that sticks on a base that turns faster and faster keeps steps short, and the shorter the later.
TEST_CASE(
    "lanes limit their steps by the base's motion while a hinge sticks, as the run alone does") {
  std::vector<Scene> scenes;
  for (int k = 0; k < 8; ++k) {
    Draws draws(70 + k);
    Scene scene = latching_panel();
    scene.bodies.push_back({"other_panel", 10, 0.5});
    Hinge other = scene.hinges[0];
    other.name = "other", other.child = 1, other.parent_point = {3, 1};
    other.spring = {0, 0}, other.latch.reset();
    rub(other, 1e4);
    scene.hinges.push_back(other);
    scene.hinges[0].spring = {draws.uniform(0.1, 0.5), 0.1}, scene.hinges[0].latch.reset();
    scene.base.motion = BaseMotion::prescribed;
    scene.base.acceleration = {draws.uniform(-0.5, 0.5), draws.uniform(-0.5, 0.5)};
    scene.base.rate = draws.uniform(0.2, 1);
    scene.base.angular_acceleration = draws.uniform(0.05, 0.2);
    scenes.push_back(scene);
  }
  for (const double rtol : {1e-3, 1e-6}) require_equal_bits(scenes, within(rtol, 20), every_peak);
}
