// Which outputs a run's end waits for, and which of its proofs the reason tells.
#include "core/deployment.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/dry_friction.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

constexpr Goal no_output{.peak_moment = false,
                         .peak_force = false,
                         .overtravel = false,
                         .hold_moment = false,
                         .motor_energy = false,
                         .audit = false,
                         .end_state = false,
                         .final_angle = false};

} // namespace

TEST_CASE("a run that tells what a hold bears does not end before that is final") {
  Scene scene = seed_scene();
  scene.hinges[2].release = Release{.fails = 1};
  for (Hinge& hinge : scene.hinges) hinge.latch->damping = 5; // it rings for long
  Goal holds = no_output, to_the_end = no_output;
  holds.hold_moment = to_the_end.hold_moment = to_the_end.to_t_end = true;
  const Integration how = within(1e-8, 60);
  const Outcome without = Deployment().run(scene, how, no_output),
                with = Deployment().run(scene, how, holds),
                whole = Deployment().run(scene, how, to_the_end);
  CHECK(without.status == Status::stalled);
  CHECK(with.status == Status::stalled);
  CHECK(with.t_end > without.t_end + 0.1);
  REQUIRE(with.hold_moment.size() == 3);
  CHECK(with.hold_moment[2].value == Approx(whole.hold_moment[2].value).epsilon(1e-6));
}

TEST_CASE("a run that goes on until all hinges stick tells when they do, and not when that was "
          "foreseen") {
  Scene scene = seed_scene();
  for (Hinge& hinge : scene.hinges) {
    rub(hinge, 0.05);
    hinge.spring = {0.3, -0.6};
  }
  Goal to_rest = no_output;
  to_rest.to_rest = true;
  const Integration how = within(1e-8, 300);
  const Outcome early = Deployment().run(scene, how, no_output),
                rested = Deployment().run(scene, how, to_rest);
  CAPTURE(early.reason, rested.reason, early.t_end, rested.t_end);
  REQUIRE(early.status == Status::stalled);
  REQUIRE(rested.status == Status::stalled);
  CHECK(rested.t_end > early.t_end + 0.1);
  CHECK(early.reason.find("stick") == std::string::npos);
  CHECK(rested.reason.find("stick") != std::string::npos);
}

TEST_CASE("nothing is told to be final of a run on a base that turns faster and faster") {
  Scene scene = seed_scene();
  scene.base.motion = BaseMotion::prescribed, scene.base.angular_acceleration = 0.01;
  const Outcome out = Deployment().run(scene, within(1e-6, 10), {});
  CHECK_FALSE((out.peaks_final || out.moments_final || out.forces_final));
}

namespace {

/// The seed wing with a light flap on its last panel, whose hinge has no latch.
Scene seed_with_flap() {
  Scene scene = seed_scene();
  Body light = scene.bodies[2];
  light.name = "flap", light.mass *= 0.01, light.inertia *= 0.01;
  scene.bodies.push_back(light);
  Hinge flap = scene.hinges[2];
  flap.name = "flap", flap.parent = 2, flap.child = 3;
  flap.latch.reset(), flap.spring = {1e-3, 1e-3};
  scene.hinges.push_back(flap);
  return scene;
}

/// Checks that a run for this goal, which ends some time after the last latch, ends in the state that the motion has
/// there.
void check_end_state(const Scene& scene, Goal goal, double t_end) {
  goal.end_state = goal.final_angle = true;
  const Outcome out = Deployment().run(scene, within(1e-10, t_end), goal);
  const Outcome whole = Deployment().run(scene, within(1e-10, out.t_end), {.to_t_end = true});
  REQUIRE(out.latches.size() == 3);
  CHECK(out.t_end > out.latches.back().time + 0.1);
  CHECK(whole.t_end == out.t_end);
  for (std::size_t k = 0; k < scene.hinges.size(); ++k) {
    CAPTURE(k);
    CHECK(out.final.angles[k] == Approx(whole.final.angles[k]).margin(1e-6));
    CHECK(out.final.rates[k] == Approx(whole.final.rates[k]).margin(1e-6));
  }
}

} // namespace

TEST_CASE("a run that goes on after its last latch ends in the same state though nobody asks for "
          "peaks") {
  Goal to_t_end = no_output, to_rest = no_output, energy = no_output;
  to_t_end.to_t_end = to_rest.to_rest = energy.motor_energy = true;
  check_end_state(seed_scene(), to_t_end, 8);
  check_end_state(seed_with_flap(), to_t_end, 8);
  Scene rubbing = seed_scene();
  for (Hinge& hinge : rubbing.hinges) rub(hinge, 0.05);
  check_end_state(rubbing, to_rest, 60);
  Scene held = seed_with_flap();
  held.hinges[3].release = Release{.time = 7}; // its latches have engaged before
  check_end_state(held, no_output, 9);
  Scene driven = seed_with_flap();
  driven.hinges[3].motor = Motor{.rate = 0.2, .gain = 3, .torque_limit = 1};
  check_end_state(driven, energy, 8);
}
