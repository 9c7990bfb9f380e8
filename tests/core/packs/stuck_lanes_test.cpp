// Runs in lanes whose steps are limited by the motion of their base while a hinge sticks.
#include "tests/core/packs/same_bits.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/real_scenes.hpp"

#include <cmath>
#include <memory>

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

namespace {

/// Ten units of a random wing whose hinges stick and slide.
std::vector<Scene> rubbing_units(int k, bool motors) {
  RandomScene options;
  options.bodies = 1 + k % 4, options.branching = k % 2 == 0;
  options.motion = static_cast<BaseMotion>(k % 3);
  Scene scene = random_scene(5000 + k, options);
  RealFeatures loops{.tables = false, .measured = false, .scales = false, .dampers = false};
  loops.windows = loops.stops = loops.backlash = loops.gravity = loops.air = false;
  if (!motors) scene = with_real_hinges(scene, 5000 + k, loops);
  std::vector<Scene> units;
  for (int unit = 0; unit < 10; ++unit) {
    Draws draws(100 * k + unit);
    units.push_back(scene);
    for (Hinge& hinge : units.back().hinges) {
      const double torque = std::abs(hinge.spring.torque_stowed);
      hinge.initial_rate = 0;
      rub(hinge, torque * draws.log_uniform(0.05, 1.5)); // static and kinetic level alike
      hinge.latch = Latch{draws.log_uniform(1e2, 1e4), draws.log_uniform(1, 1e2)};
      if (!motors) continue;
      Motor motor{.time = {0, draws.uniform(0.5, 2), 4},
                  .rates = {0, draws.uniform(-1, 1), draws.uniform(-2, 2)},
                  .interpolation = Interpolation::linear};
      motor.table = std::make_shared<Curve>(motor.time, motor.rates, motor.interpolation);
      motor.gain = torque * draws.log_uniform(1, 10), motor.torque_limit = 1e3;
      hinge.motor = motor;
    }
  }
  return units;
}

} // namespace

TEST_CASE("lanes release stuck hinges as the run alone does while motors' commands rise and fall") {
  for (int k = 0; k < random_cases(60, 6); ++k) {
    CAPTURE(k);
    require_equal_bits(rubbing_units(k, true), within(1e-5, 4), every_peak);
  }
}

TEST_CASE(
    "lanes give a stuck hinge the margin that its latch and loops have at a coarse tolerance") {
  for (int k = 0; k < random_cases(60, 6); ++k) {
    Integration how = within(1e-3, 8);
    how.atol = 1e-3;
    CAPTURE(k);
    require_equal_bits(rubbing_units(k, false), how, every_peak);
  }
}
