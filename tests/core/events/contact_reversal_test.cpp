// Exact friction: a hinge that turns back in its stop, beside one that sticks.
#include "core/deployment.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <memory>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The root runs into its stop at the stowed side and turns back, while the tip sticks. Were both locked at that instant,
/// the tip would bear 4.9 N·m; as the root turns on, it bears 0.34 N·m.
Scene turning_back(double static_level_of_tip) {
  Scene scene;
  scene.base.motion = BaseMotion::fixed;
  scene.bodies = {{"p0", 8.45, 4.08}, {"p1", 7.12, 0.189}};
  Hinge root, tip;
  root.name = "root", root.parent = base_index, root.child = 0;
  root.parent_point = {0.5, 0.0222}, root.child_point = {-1.1, -0.00916};
  root.stowed = 0, root.latched = 2.36, root.initial_rate = -0.453;
  root.spring = {2.6, 0.944}, root.harness = {0.0019, 0.388};
  rub(root, 0.163);
  root.friction.static_level = 0.34, root.friction.viscous = 0.0667;
  root.stop = Stop{227, 0.171, 0.0401};
  root.latch = Latch{1670, 0}, root.latch->dissipation = 0.112;
  tip.name = "tip", tip.parent = 0, tip.child = 1;
  tip.parent_point = {0.5, -0.0231}, tip.child_point = {-0.304, -0.00258};
  tip.stowed = 0, tip.latched = -0.588, tip.spring = {1.21, 0.441}, tip.harness = {};
  rub(tip, 0.157);
  tip.friction.static_level = static_level_of_tip, tip.friction.viscous = 0.0443;
  tip.stop = Stop{308, 0.0641, 0.0101};
  tip.latch = Latch{3710, 0}, tip.latch->dissipation = 0.347;
  Motor motor;
  motor.gain = 40, motor.torque_limit = 2.2, motor.time = {0, 1, 3},
  motor.rates = {0, 0.265, 0.279};
  motor.interpolation = Interpolation::monotone, motor.scale = 1;
  motor.table = std::make_shared<Curve>(motor.time, motor.rates, motor.interpolation);
  tip.motor = motor;
  scene.hinges = {root, tip};
  Synchronisation loop;
  loop.name = "loop", loop.first = 0, loop.second = 1;
  loop.ratio = 0.249, loop.stiffness = 101, loop.damping = 1.94;
  scene.synchronisations = {loop};
  return scene;
}

} // namespace

TEST_CASE("a hinge that turns back does not break a stuck one loose") {
  for (const char* method : {"auto", "dopri5", "seulex"}) {
    Integration how = within(1e-8, 0.9);
    how.method = method;
    CAPTURE(method);
    for (const double limit : {1.0, 0.6}) {
      const Outcome out = Deployment().run(turning_back(limit), how, {.to_t_end = true});
      // by another program: Lagrange's equations, SciPy's DOP853 at rtol 1e-11
      CHECK(out.final_angle[1] == Approx(0.557730).margin(2e-6));
      CHECK(out.final.rates[1] == 0);
    }
    // a weaker one does not hold it
    const Outcome weak = Deployment().run(turning_back(0.2), how, {.to_t_end = true});
    CHECK(std::abs(weak.final_angle[1] - 0.557730) > 1e-3);
  }
}
