// The numbers of evaluations of the right-hand side that runs take, where speed is promised. The numbers are exact and the
// same on every machine. They change only with the methods or the step control: change them only on purpose.
#include "core/deployment.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The seed wing with harness and regularized friction: studies/scenes/three_panel_flight.json.
Scene flight_wing() {
  Scene scene = seed_scene();
  const HingeTorque harness[] = {{0.1, 0.05}, {0.08, 0.04}, {0.04, 0.02}};
  const double friction[] = {0.02, 0.02, 0.01};
  for (int i = 0; i < 3; ++i) {
    scene.hinges[i].harness = harness[i];
    scene.hinges[i].friction.coulomb = scene.hinges[i].friction.viscous = friction[i];
  }
  return scene;
}

/// A panel whose friction exceeds its spring. It creeps inside the layer of regularized friction, where
/// stability holds an explicit method's steps back.
Scene creeping_panel(double width) {
  Scene scene = latching_panel();
  scene.hinges[0].spring = {0.5, 0.5};
  scene.hinges[0].friction.coulomb = 2;
  scene.hinges[0].friction.regularization_rate = width;
  return scene;
}

long evaluations(const Scene& scene, double rtol, const Goal& goal, double t_end = 60) {
  const Outcome out = Deployment().run(scene, within(rtol, t_end), goal);
  CAPTURE(out.reason);
  REQUIRE(out.status != Status::failed);
  return out.work.rhs_evaluations;
}

} // namespace

TEST_CASE("evaluations of the seed wing are no more than they were") {
  const Goal all{.audit = false};
  CHECK(evaluations(seed_scene(), 1e-8, latches_only) <= 2659);
  CHECK(evaluations(seed_scene(), 1e-6, all) <= 3852);
  CHECK(evaluations(seed_scene(), 1e-8, all) <= 6726);
  CHECK(evaluations(seed_scene(), 1e-10, all) <= 11869);
}

TEST_CASE("evaluations of a wing with friction are no more than they were") {
  const Goal all{.audit = false};
  CHECK(evaluations(flight_wing(), 1e-6, all) <= 9779);
  CHECK(evaluations(flight_wing(), 1e-8, latches_only) <= 7363);
  CHECK(evaluations(flight_wing(), 1e-8, all) <= 17102);
  Scene exact = flight_wing();
  for (Hinge& hinge : exact.hinges) hinge.friction.model = FrictionModel::exact;
  CHECK(evaluations(exact, 1e-8, all) <= 13040);
}

TEST_CASE("evaluations of stiff friction are those of a stiff method") {
  CHECK(evaluations(creeping_panel(1e-3), 1e-8, to_the_end, 20) <= 465);
  CHECK(evaluations(creeping_panel(1e-5), 1e-8, to_the_end, 20) <= 419);
  CHECK(evaluations(creeping_panel(1e-5), 1e-6, {}, 60) <= 395);
}

TEST_CASE("extrapolation takes the orders that pay") {
  // 5181 and 2541; up to three times as many with steps that do not grow for an order more
  Scene scene = seed_scene();
  for (Hinge& hinge : scene.hinges) hinge.latch->damping = 1e4;
  Integration how = within(1e-8, 20);
  how.method = "seulex";
  CHECK(Deployment().run(scene, how, latches_only).work.rhs_evaluations <= 6000);
  how = within(1e-6, 20);
  how.method = "seulex";
  CHECK(Deployment().run(scene, how, latches_only).work.rhs_evaluations <= 2800);
}
