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
