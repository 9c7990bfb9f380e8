// Where the angles of hinges are 0 is the author's choice: it changes neither a motion nor when a run may end.
#include "core/deployment.hpp"
#include "tests/support/random_scenes.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The same wing, the axes of its bodies turned by angles of their own. @pre no plates and no tables of torques
Scene with_turned_axes(Scene scene, Draws& draws) {
  std::vector<double> turned(scene.bodies.size());
  for (double& angle : turned) angle = draws.uniform(-1, 1);
  const auto turn = [&](int body) { return body == base_index ? 0 : turned[body]; };
  for (Hinge& hinge : scene.hinges) {
    const double more = turn(hinge.child) - turn(hinge.parent);
    hinge.stowed += more, hinge.latched += more;
    hinge.parent_point = Eigen::Rotation2Dd(-turn(hinge.parent)) * hinge.parent_point;
    hinge.child_point = Eigen::Rotation2Dd(-turn(hinge.child)) * hinge.child_point;
  }
  return scene;
}

} // namespace

TEST_CASE("a run ends as early whichever axes the bodies have") {
  Draws draws(5);
  Integration how;
  how.rtol = 1e-8, how.atol = 1e-10, how.t_end = 100;
  int ended = 0;
  for (int k = 0; k < 12; ++k) {
    Scene scene = seed_scene();
    for (Hinge& hinge : scene.hinges) {
      hinge.spring.torque_stowed *= draws.uniform(1, 1.5);
      hinge.latch = Latch{draws.log_uniform(2e3, 2e4), draws.log_uniform(20, 100)};
      hinge.friction.viscous = draws.log_uniform(0.1, 1);
      if (k % 2 == 1) { // made linear for the rates that are left
        hinge.damper.emplace();
        hinge.damper->law = DamperLaw::power;
        hinge.damper->coefficient = draws.log_uniform(0.1, 1), hinge.damper->exponent = 1.5;
        hinge.damper->regularization_rate = 1e-3;
      }
    }
    const Goal goal{.audit = false};
    const Outcome given = Deployment().run(scene, how, goal);
    const Outcome other = Deployment().run(with_turned_axes(scene, draws), how, goal);
    CAPTURE(k, given.t_end, other.t_end);
    CHECK(given.status == other.status);
    ended += given.t_end < how.t_end;
    CHECK(other.t_end == Approx(given.t_end).epsilon(0.1));
    REQUIRE(given.latches.size() == other.latches.size());
    for (std::size_t i = 0; i < given.latches.size(); ++i)
      CHECK(other.latches[i].time == Approx(given.latches[i].time).epsilon(1e-5));
    for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
      CHECK(other.peak_moment[i].value == Approx(given.peak_moment[i].value).epsilon(1e-5));
      CHECK(other.peak_force[i].value == Approx(given.peak_force[i].value).epsilon(1e-5));
    }
  }
  CHECK(ended >= 9);
}
