#include "core/mechanics/linear_solve.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("a smoothed latch resists as far as it has engaged") {
  Scene scene = oracle::latching_panel();
  Hinge& hinge = scene.hinges[0];
  hinge.latch = Latch{1000, 10};
  hinge.friction = {};
  hinge.friction.viscous = 3;
  hinge.spring = {2, 2}, hinge.harness = {};
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  const double epsilon = 1e-2;
  const System<double, Tree, BaseMotion::fixed> system(wing, epsilon, work);
  State<double> x(system.layout().size(), 0.0);
  for (const auto& [state, share] : {std::pair{0.0, 0.0}, {epsilon / 2, 0.5}, {epsilon, 1.0}}) {
    x[system.layout().latch(1)] = state;
    const Resistance<double> found = resistance(system, x, 0.0, 1);
    CHECK(found.stiffness == Approx(1000 * share));
    CHECK(found.damping == Approx(3 + 10 * share));
  }
}
