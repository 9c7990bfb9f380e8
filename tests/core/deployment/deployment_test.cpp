// Deployment: scenes that cannot be run give a reason, and one object runs any scenes.
#include "core/deployment.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("a scene that cannot be run gives the reason") {
  Scene scene = oracle::seed_scene();
  SECTION("an unphysical draw is invalid, with each reason") {
    scene.bodies[1].mass = -1;
    scene.hinges[0].friction.coulomb = std::nan("");
    const Outcome out = Deployment().run(scene, {}, {});
    CHECK(out.status == Status::invalid);
    CHECK_THAT(out.reason,
               Catch::Contains("bodies." + scene.bodies[1].name + ".mass is -1, expected > 0"));
    CHECK_THAT(out.reason,
               Catch::Contains("hinges.root.friction.coulomb is nan, expected a finite number"));
  }
  SECTION("a regularization rate whose square vanishes is refused, not found out by a run") {
    scene.hinges[0].friction.coulomb = 0.1, scene.hinges[0].friction.regularization_rate = 1e-200;
    const Outcome out = Deployment().run(scene, {}, {});
    CHECK(out.status == Status::invalid);
    CHECK_THAT(out.reason, Catch::Contains("hinges.root.friction.regularization_rate is "
                                           "9.9999999999999998e-201, expected >= 1e-150"));
    scene.hinges[0].friction.regularization_rate = 1e200; // or overflows
    CHECK_THAT(Deployment().run(scene, {}, {}).reason, Catch::Contains("expected <= 1e150"));
    scene.hinges[0].friction.regularization_rate = 1e-150;
    Integration how;
    how.max_steps = 2000; // a layer that no double can follow
    CHECK(Deployment().run(scene, how, {}).status != Status::invalid);
  }
  SECTION("numbers that overflow fail the run and give no result") {
    scene.hinges[0].spring = {1e300, 1e300};
    const Outcome out = Deployment().run(scene, {}, {});
    CHECK(out.status == Status::failed);
    CHECK(!out.reason.empty());
    for (const Peak& peak : out.peak_moment) CHECK(std::isfinite(peak.value));
  }
  SECTION(
      "what no step can follow in the middle of a run fails it there, and keeps what came before") {
    scene.hinges[0].latch = Latch{1e308, 100};
    const Outcome out = Deployment().run(scene, {}, {});
    CHECK(out.status == Status::failed);
    CHECK_THAT(out.reason, Catch::Contains("step size") && Catch::Contains("at t = 4.81"));
    CHECK(out.latches.size() == 1);
    for (const Peak& peak : out.peak_moment) CHECK(std::isfinite(peak.value));
    for (const Peak& peak : out.peak_force) CHECK(std::isfinite(peak.value));
  }
  SECTION("a latch too stiff for the method reaches the limit of steps") {
    for (Hinge& hinge : scene.hinges) hinge.latch = Latch{1e9, 1e5};
    Integration how;
    how.method = "dopri5";
    how.max_steps = 2000;
    const Outcome out = Deployment().run(scene, how, {});
    CHECK(out.status == Status::failed);
    CHECK_THAT(out.reason, Catch::Contains("limit of 2000 steps"));
  }
  SECTION("a wing without the torque to unfold is timed out") {
    for (Hinge& hinge : scene.hinges) hinge.spring = {0, 0};
    const Outcome out = Deployment().run(scene, {}, {});
    CHECK(out.status == Status::timed_out);
    CHECK(out.latches.empty());
    CHECK(out.t_end == 60);
  }
}

TEST_CASE("a free base without mass or inertia is refused by name") {
  for (const auto& [mass, inertia] : {std::pair(0., 350.), {800., 0.}}) {
    Scene scene = two_wing_free_spacecraft();
    scene.base.mass = mass, scene.base.inertia = inertia;
    const Outcome out = Deployment().run(scene, {}, {});
    CHECK(out.status == Status::invalid);
    CHECK_THAT(out.reason, Catch::Contains(mass > 0 ? "base.inertia is " : "base.mass is ") &&
                               Catch::Contains("expected > 0"));
  }
}

TEST_CASE("a body without mass or inertia is refused by name") {
  for (const auto& [mass, inertia] : {std::pair(0., 0.5), {10., 0.}, {-0., 0.5}}) {
    Scene scene = seed_scene();
    scene.bodies[1].mass = mass, scene.bodies[1].inertia = inertia;
    const std::string path =
        "bodies.panel_2." + std::string(mass > 0 ? "inertia" : "mass") + " is ";
    for (const MethodInfo& method : methods()) {
      Integration how;
      how.method = method.name;
      const Outcome out = Deployment().run(scene, how, {});
      CHECK(out.status == Status::invalid);
      CHECK_THAT(out.reason, Catch::Contains(path) && Catch::Contains("expected > 0"));
      CHECK(out.latches.empty());
    }
  }
}

TEST_CASE("one workspace serves scenes of different topology") {
  Deployment deployment;
  const Outcome first = deployment.run(oracle::seed_scene(), {}, {});
  (void)deployment.run(oracle::two_wing_free_spacecraft(), {}, {});
  (void)deployment.run(oracle::latching_panel(), {}, {});
  const Outcome again = deployment.run(oracle::seed_scene(), {}, {});
  REQUIRE(first.latches.size() == again.latches.size());
  for (std::size_t k = 0; k < first.latches.size(); ++k)
    CHECK(first.latches[k].time == again.latches[k].time);
  CHECK(first.peak_force[1].value == again.peak_force[1].value);
}

TEST_CASE("a workspace tells a star from a chain of as many bodies") {
  Scene chain = oracle::seed_scene(), star = chain;
  for (Hinge& hinge : star.hinges) hinge.parent = base_index;
  Deployment deployment;
  (void)deployment.run(star, {}, {});
  const Outcome after = deployment.run(chain, {}, {}), fresh = Deployment().run(chain, {}, {});
  REQUIRE(after.latches.size() == fresh.latches.size());
  for (std::size_t k = 0; k < fresh.latches.size(); ++k)
    CHECK(after.latches[k].time == fresh.latches[k].time);
}
