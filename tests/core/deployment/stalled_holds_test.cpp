// Holds that fail, wait for what never comes, or let go too late: the runs stall and say why.
#include "tests/core/deployment/held_hinges.hpp"

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

TEST_CASE("a hold that fails stalls the run, which names its hinge") {
  Scene scene = two_panels();
  scene.hinges[1].release = at_time(1);
  scene.hinges[1].release->fails = 1;
  const Outcome out = run_stalled(scene, 60);
  CHECK(out.reason == "other was never released");
  CHECK(out.releases.empty());
  CHECK(out.hold_moment[1].value == 2);
  CHECK(out.final_angle[1] == pi / 2);
  Goal latches = {.peak_moment = false, .peak_force = false, .hold_moment = false};
  const Outcome early = Deployment().run(scene, within(1e-10, 60), latches);
  CHECK(early.status == Status::stalled);
  CHECK(early.t_end < 20); // no output can change any more
}

TEST_CASE("a hold that waits for what never comes stalls the run; the first cause is named") {
  Scene scene = two_panels();
  scene.hinges[0].release = at_time(1);
  scene.hinges[0].release->fails = 1;
  scene.hinges[1].release = after(0, Release::Event::latched);
  CHECK(run_stalled(scene, 60).reason == "root was never released");
  CHECK(Deployment().run(scene, within(1e-10, 60), {}).t_end < 60); // all are held
  scene.hinges[0].release = after(1, Release::Event::released);     // each waits for the other
  CHECK(run_stalled(scene, 60).reason == "root was never released; other was never released");
  scene.hinges[0].release.reset();
  rub(scene.hinges[0], 3); // sticks
  CHECK(run_stalled(scene, 60).reason == "other was never released");
}

TEST_CASE("a hold that waits for a hinge without a latch, which sticks for good, never lets go") {
  Scene scene = two_panels();
  for (Hinge& hinge : scene.hinges) hinge.latch.reset();
  scene.hinges[1].release = after(0, Release::Event::passed, 0, 0.5);
  rub(scene.hinges[0], 3); // sticks
  const Outcome out = run_stalled(scene, 60);
  CHECK(out.may_release_later.empty());
  CHECK(out.never_released == std::vector<int>{1});
  scene.hinges[0].friction = {}; // it moves, but not as far before the end
  CHECK(run_stalled(scene, 0.1).may_release_later == std::vector<int>{1});
}

TEST_CASE("a hold whose time is after t_end has stalled the run at t_end") {
  Scene scene = latching_panel();
  scene.hinges[0].release = at_time(20);
  const Outcome out = run_stalled(scene, 10);
  CHECK(out.reason == "root was never released up to t_end; its hold may let go later");
  CHECK(out.may_release_later == std::vector<int>{0});
  CHECK(out.t_end == 10);
  CHECK_FALSE(out.peaks_final); // it has not begun
  scene.hinges[0].release = at_time(5);
  CHECK(Deployment().run(scene, within(1e-10, 10), {}).status == Status::deployed);
}

TEST_CASE("a stalled run says which of its holds would have let go after t_end") {
  Scene scene = two_panels();
  scene.hinges[1].release = after(0, Release::Event::latched);
  scene.hinges[1].release->delay = 30; // the root latches before 20 s
  const Outcome out = run_stalled(scene, 20);
  CHECK(out.reason == "other was never released up to t_end; its hold may let go later");
  CHECK_FALSE(out.peaks_final);
  CHECK(Deployment().run(scene, within(1e-10, 90), {}).status == Status::deployed);
  const double early = out.latches.front().time / 2; // the root still moves
  CHECK(run_stalled(scene, early).may_release_later == std::vector<int>{1});
  scene.hinges[0].release = at_time(1);
  scene.hinges[0].release->fails = 1; // what waits for it waits for ever
  CHECK(run_stalled(scene, 20).may_release_later.empty());
  scene.hinges[0].release->fails = 0, scene.hinges[0].release->time = 50;
  const Outcome both = run_stalled(scene, 20);
  CHECK(both.may_release_later == std::vector<int>{0, 1});
  CHECK(both.reason == "root was never released up to t_end; its hold may let go later");
  scene.hinges[1].release->fails = 1; // one of each
  CHECK(run_stalled(scene, 20).reason ==
        "root was never released up to t_end; its hold may let go later; other was never released");
}

TEST_CASE("a hinge without a latch that is never released stalls the run too") {
  Scene scene = two_panels();
  scene.hinges[1].latch.reset();
  scene.hinges[1].release = at_time(1);
  scene.hinges[1].release->fails = 1;
  CHECK(run_stalled(scene, 60).reason == "other was never released");
  const Goal latches = {.peak_moment = false, .peak_force = false, .hold_moment = false};
  CHECK(Deployment().run(scene, within(1e-10, 60), latches).status == Status::stalled);
  require_equal_bits({scene, scene, scene}, within(1e-10, 60), latches);
  Integration fine = within(1e-8, 60);
  fine.method = "runge_kutta4";
  fine.step = way_of_panel() / 1000; // more steps before the latch than between attempts at a proof
  const Outcome out =
      Deployment().run(scene, fine, latches); // the latch is too stiff for such steps
  CHECK(out.latches.size() == 1);             // the held hinge counted for none with a latch
  scene.hinges[1].release = at_time(80);      // after t_end
  const std::string later = "other was never released up to t_end; its hold may let go later";
  CHECK(run_stalled(scene, 60).reason == later);
  scene.hinges[0].latch.reset();
  CHECK(run_stalled(scene, 60).reason == later);
}

TEST_CASE("a hold that fails ends the run early where no energy bounds the motion too") {
  Scene scene = two_panels();
  scene.base.motion = BaseMotion::prescribed;
  scene.base.angular_acceleration = 0.01;
  scene.hinges[1].release = at_time(1), scene.hinges[1].release->fails = 1;
  const Goal latches = {.peak_moment = false, .peak_force = false, .hold_moment = false};
  const Outcome out = Deployment().run(scene, within(1e-10, 60), latches);
  CHECK(out.status == Status::stalled);
  CHECK(out.latches.size() == 1);
  CHECK(out.t_end < 30);
}

TEST_CASE("without peaks too a run waits for the release of a hinge without a latch") {
  Scene scene = two_panels();
  scene.hinges[1].latch.reset();
  const Goal latches = {.peak_moment = false, .peak_force = false, .hold_moment = false};
  for (const double T : {10., 20.}) {
    scene.hinges[1].release = at_time(T);
    const Outcome out = Deployment().run(scene, within(1e-10, 60), latches);
    CHECK(out.status == Status::deployed);
    REQUIRE(out.releases.size() == 1);
    CHECK(out.releases[0].time == T);
    CHECK(out.t_end < 60);
    require_equal_bits({scene, scene, scene}, within(1e-10, 60), latches);
  }
}
