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
