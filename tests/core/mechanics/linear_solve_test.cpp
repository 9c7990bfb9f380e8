#include "core/mechanics/linear_solve.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

#include <vector>

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

namespace {

/// The bounds of the hinges of two discs in a row, on a base of 4 kg·m² if it is free.
template <BaseMotion M> std::vector<double> mobility_of_discs() {
  Scene scene = oracle::coaxial_discs(3, 2);
  scene.base.motion = M, scene.base.mass = 1, scene.base.inertia = 4;
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  const System<double, Tree, M> system(wing, std::nullopt, work);
  return {mobility_bound(system, 1), mobility_bound(system, 2)};
}

} // namespace

TEST_CASE("how easily a hinge is moved is at most as if its two bodies were free") {
  const Scene scene = oracle::coaxial_discs(3, 2);
  const double J1 = scene.bodies[0].inertia, J2 = scene.bodies[1].inertia;
  for (const auto& found :
       {mobility_of_discs<BaseMotion::fixed>(), mobility_of_discs<BaseMotion::prescribed>()}) {
    CHECK(found[0] == Approx(1 / J1)); // the base does not give way
    CHECK(found[1] == Approx(1 / J1 + 1 / J2));
  }
  const auto free = mobility_of_discs<BaseMotion::free>();
  CHECK(free[0] == Approx(1 / J1 + 0.25));
  CHECK(free[1] == Approx(1 / J1 + 1 / J2));
}
