// Runs that ask for latches alone, where a latch that has engaged may let go again.
#include "core/deployment.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <memory>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("a run that asks for latches alone goes on after the last one while it may let go") {
  for (const double holding : {5.0, 50.0, 1e5}) {
    Scene scene = latching_panel();
    scene.hinges[0].latch->holding_moment = holding;
    Goal whole = latches_only;
    whole.to_t_end = true;
    const Integration how = within(1e-9, 10);
    const Outcome early = Deployment().run(scene, how, latches_only);
    const Outcome late = Deployment().run(scene, how, whole);
    CAPTURE(holding);
    REQUIRE(!late.latches.empty());
    CHECK(late.let_go.empty() == (holding > 1e3)); // it rebounds with some 100 N·m
    REQUIRE(early.let_go.size() == late.let_go.size());
    CHECK(early.latches.size() == late.latches.size());
    for (std::size_t k = 0; k < late.let_go.size(); ++k)
      CHECK(early.let_go[k].time == late.let_go[k].time);
    CHECK(early.status == late.status);
  }
}

TEST_CASE("a latch is not final while its hinge, thrown back by a stop, may tear it open") {
  int torn = 0, final = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Draws draws(seed);
    Scene scene = latching_panel();
    Hinge& hinge = scene.hinges[0];
    hinge.latch = Latch{.stiffness = 100};
    hinge.latch->damping = draws.uniform(0.2, 1);
    hinge.far_stop = Stop{.stiffness = draws.log_uniform(300, 3000)};
    hinge.far_stop->gap = draws.log_uniform(0.01, 0.05);
    hinge.latch->holding_moment = draws.log_uniform(0.5, 15);
    hinge.spring.torque_stowed = hinge.spring.torque_latched = draws.log_uniform(0.1, 1);
    const Integration how = within(1e-9, 40);
    Goal whole;
    whole.to_t_end = true;
    const Outcome late = Deployment().run(scene, how, whole);
    torn += late.let_go.size() > 1;
    for (const Goal& goal : {latches_only, Goal{}}) {
      const Outcome early = Deployment().run(scene, how, goal);
      final += early.t_end < late.t_end;
      CAPTURE(seed, hinge.latch->holding_moment, early.t_end);
      CHECK(early.status == late.status);
      CHECK(early.latches.size() == late.latches.size());
      REQUIRE(early.let_go.size() == late.let_go.size());
      for (std::size_t k = 0; k < late.let_go.size(); ++k)
        CHECK(early.let_go[k].time == late.let_go[k].time);
    }
  }
  CAPTURE(torn, final);
  CHECK((torn > 5 && final > 20));
}

TEST_CASE("a run that asks for latches alone waits for a motor's later command to pull one open") {
  for (const double torque : {200.0, 800.0}) {
    Scene scene = latching_panel();
    Hinge& hinge = scene.hinges[0];
    hinge.latch->holding_moment = 400;
    Motor motor;
    motor.gain = 1e4, motor.torque_limit = torque;
    motor.time = {0, 6, 6.5, 20}, motor.rates = {0.5, 0.5, -0.5, -0.5};
    motor.interpolation = Interpolation::linear;
    motor.table = std::make_shared<Curve>(motor.time, motor.rates, motor.interpolation);
    hinge.motor = motor;
    Goal whole = latches_only;
    whole.to_t_end = true;
    const Integration how = within(1e-8, 8);
    const Outcome early = Deployment().run(scene, how, latches_only);
    const Outcome late = Deployment().run(scene, how, whole);
    CAPTURE(torque);
    REQUIRE(!late.latches.empty());
    CHECK(late.latches[0].time < 6);
    CHECK(late.let_go.size() == (torque > 400 ? 1u : 0u));
    REQUIRE(early.let_go.size() == late.let_go.size());
    CHECK(early.status == late.status);
  }
}

namespace {

/// A yoke that swings in its elastic hold, which lets go as the tip latches; the tip's rigid hold waits for the yoke's
/// angle of 0.28 rad. Beside them a panel that latches.
Scene swinging_in_its_hold(double damping) {
  Scene scene;
  scene.bodies = {{"yoke", 10, 0.5}, {"panel", 5, 0.3}, {"side", 3, 0.2}};
  Hinge root, tip, aside;
  root.name = "root", root.child = 0;
  root.child_point = {-0.5, 0}, root.latched = 1.5;
  root.spring = {3, 3};
  root.release = Release{.event = Release::Event::latched, .after = 1};
  root.hold = Hold{.stiffness = 20, .damping = damping};
  tip.name = "tip", tip.parent = 0, tip.child = 1;
  tip.parent_point = {0.5, 0}, tip.child_point = {-0.5, 0}, tip.stowed = 1.5;
  tip.spring = {1, 1};
  tip.release = Release{.event = Release::Event::passed, .after = 0, .angle = 0.28};
  tip.latch = Latch{.stiffness = 1000, .damping = 10};
  aside.name = "aside", aside.child = 2;
  aside.parent_point = {0, 1}, aside.child_point = {-0.3, 0}, aside.latched = 1.5;
  aside.spring = {1, 1};
  aside.latch = Latch{.stiffness = 1000, .damping = 10};
  scene.hinges = {root, tip, aside};
  return scene;
}

} // namespace

TEST_CASE("a hold that waits for the angle of a hinge that swings in its own hold may let go") {
  for (const bool fails : {false, true}) {
    Scene scene = swinging_in_its_hold(0);
    scene.hinges[0].release->fails = fails;
    const Outcome early = Deployment().run(scene, within(1e-9, 20), latches_only);
    CAPTURE(fails);
    REQUIRE(early.latches.size() == 2);
    CHECK(early.latches[1].hinge == 1);
    CHECK(early.latches[1].time == Approx(4.074556).epsilon(1e-6)); // by dop853 at 1e-11
    CHECK(early.releases.front().time == Approx(1.843168).epsilon(1e-6));
    CHECK(early.status == (fails ? Status::stalled : Status::deployed));
  }
}

TEST_CASE(
    "before t_end such holds count among those that may let go later, unless all is at rest") {
  const auto held = [](double damping, double t_end, bool fails) {
    Scene scene = swinging_in_its_hold(damping);
    scene.hinges[0].release->fails = fails;
    const Outcome out = Deployment().run(scene, within(1e-8, t_end), latches_only);
    CHECK(out.never_released.size() + out.may_release_later.size() >= 1);
    CHECK(out.latches.size() == 1);
    return out.may_release_later;
  };
  CHECK(held(0, 1.5, false) == std::vector<int>{0, 1});
  CHECK(held(0, 1.5, true) == std::vector<int>{1}); // the yoke's hold never lets go
}
