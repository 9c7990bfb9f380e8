// Long chains at rest with exact friction: sticking hinges are held, sliding hinges are driven.
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
      const double coulomb = draws.uniform(0.3, 1.2);
      rub(hinge, coulomb, (k % 3 == 0 ? 1.4 : 1) * coulomb);
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
      if (system.is_locked(i)) {
        ++stick;
        CHECK(std::abs(system.locking_moment(x, i)) <= limit * (1 + 1e-9));
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

// At the instant at which a load reaches τ_s = τ_c, the hinge has no acceleration yet. If it were held again, its release
// would not be considered a second time.
TEST_CASE("a hinge that is due to be let go is let go though nothing moves it yet") {
  for (const double sense : {1.0, -1.0}) {
    Scene scene = latching_panel();
    Hinge& hinge = scene.hinges[0];
    hinge.spring = {sense * 2, sense * 2};
    rub(hinge, 2);
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    State<double> x, dxdt(system.layout().size());
    system.start(x);
    sort_contacts(system, x, dxdt, 0.0, 0);
    CHECK(system.is_locked(1)); // at its limit, it is held
    sort_contacts(system, x, dxdt, 0.0, 1);
    CHECK_FALSE(system.is_locked(1));
    CHECK(sliding_sense(system, 1) == (sense > 0 ? -1 : 1)); // the latch is below
    CHECK(std::abs(dxdt[1]) < 1e-15);
  }
}

TEST_CASE("a hinge that is let go and would run against its friction is held again, for good") {
  Scene scene = latching_panel();
  scene.hinges[0].spring = {1, 1};
  rub(scene.hinges[0], 2);
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
  State<double> x, dxdt(system.layout().size());
  system.start(x);
  sort_contacts(system, x, dxdt, 0.0, 1);
  CHECK(system.is_locked(1));
  CHECK(work.evaluations == 3); // held, let go, held
}

// Two panels side by side, which do not feel each other: the hinge that has just come to rest is released first, but not
// in place of the one that is due.
TEST_CASE(
    "a hinge that is due to slide slides, also where another one turns back at that instant") {
  for (const int due : {1, 2}) {
    Scene scene = latching_panel();
    scene.bodies.push_back({"other_panel", 10, 0.5});
    Hinge other = scene.hinges[0];
    other.name = "other", other.child = 1, other.parent_point = {3, 1};
    scene.hinges.push_back(other);
    for (int i = 1; i <= 2; ++i) { // the one that is due is just at its limit
      scene.hinges[i - 1].spring = {2, 2};
      rub(scene.hinges[i - 1], i == due ? 2 : 1);
    }
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    State<double> x, dxdt(system.layout().size());
    system.start(x);
    const int turning = 3 - due;
    system.set_contact(due, Contact::stuck);
    system.set_contact(turning, Contact::forward); // until now, against the spring
    CAPTURE(due);
    sort_contacts(system, x, dxdt, 0.0, due);
    CHECK(sliding_sense(system, due) == -1);
    CHECK(sliding_sense(system, turning) == -1);
    CHECK(dxdt[system.layout().rate(turning)] < 0);
  }
}

TEST_CASE("a rigid hold holds a hinge whose friction alone would let it slide") {
  Scene scene = latching_panel();
  Hinge& hinge = scene.hinges[0];
  hinge.spring = {2, 2};
  rub(hinge, 0.5);
  hinge.release.emplace().time = 5;
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
  State<double> x, dxdt(system.layout().size());
  system.start(x);
  system.set_contact(1, Contact::held);
  sort_contacts(system, x, dxdt, 0.0, 0);
  CHECK(system.work().contact[1] == Contact::held);
  CHECK(dxdt[system.layout().rate(1)] == 0);
  system.set_contact(1, Contact::stuck); // it lets go
  sort_contacts(system, x, dxdt, 0.0, 0);
  CHECK_FALSE(system.is_locked(1));
}
