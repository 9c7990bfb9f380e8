// Long chains at rest with exact friction: what sticks is held, and what slides is driven.
#include "core/events/contact.hpp"
#include "tests/core/events/rubbed_wings.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("the contacts of a long chain at rest are those that friction allows") {
  int slide = 0, stick = 0;
  for (int k = 0; k < 120; ++k) {
    Draws draws(6000 + k);
    RandomScene options;
    options.bodies = 12 + k % 40, options.branching = false;
    options.motion = BaseMotion::fixed;
    options.mass_lower = 1, options.mass_upper = 10;
    Scene scene = random_scene(6000 + k, options);
    for (Hinge& hinge : scene.hinges) {
      const double torque = draws.uniform(0.2, 2) * draws.sign();
      hinge.spring = {torque, torque}, hinge.harness = {0, 0};
      hinge.initial_rate = 0, hinge.friction = {};
      rub(hinge, draws.uniform(0.3, 1.2));
    }
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    State<double> x, dxdt(system.layout().size());
    system.start(x);
    sort_contacts(system, x, dxdt, 0.0, 0);
    CAPTURE(k, scene.hinges.size());
    for (int i = 1; i <= wing.size(); ++i) {
      const double limit = wing.hinges[i].static_friction;
      CAPTURE(i);
      if (system.sticks(i)) {
        ++stick;
        CHECK(std::abs(system.holding_friction(x, i)) <= limit * (1 + 1e-9));
      } else {
        ++slide;
        CHECK(sliding_sense(system, i) * dxdt[system.layout().rate(i)] >
              -1e-8 * limit / wing.bodies[i].central_inertia);
      }
    }
  }
  CHECK(slide > 300);
  CHECK(stick > 300);
}
