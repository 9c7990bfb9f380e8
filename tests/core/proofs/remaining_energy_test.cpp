// What the spring of a hinge that cannot reach its latch exerts with the energy left, against the way walked in small steps.
#include "core/proofs/remaining_energy.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace wingspread;

namespace {

/// A panel before its latch, on a constant spring or one that falls and pulls back there.
Scene weak_panel(oracle::Draws& draws, bool falls) {
  oracle::RandomScene options;
  options.bodies = 1, options.friction = false;
  Scene scene = oracle::random_scene(1, options);
  Hinge& hinge = scene.hinges[0];
  hinge.latch = Latch{100, 1}, hinge.harness = {}, hinge.friction = {};
  hinge.stowed = 0, hinge.latched = draws.sign() * 3;
  const double torque = draws.log_uniform(0.01, 1);
  hinge.spring = {torque, falls ? -draws.log_uniform(0.01, 1) : torque};
  if (draws.uniform(0, 1) < 0.5) {
    hinge.friction.model = FrictionModel::exact;
    hinge.friction.coulomb = draws.log_uniform(1e-3, 0.3);
  }
  return scene;
}

/// The largest |spring moment| on the way that the energy lets the hinge go from `from` in this sense, N·m.
template <class System>
double most_on_way(System& system, double from, double sense, double latched, double friction,
                   double energy) {
  State<double> x(system.layout().size(), 0.0);
  double left = energy, most = 0;
  const double step = 1e-5;
  for (long k = 0; left >= 0; ++k) {
    x[0] = from + sense * step * static_cast<double>(k);
    if (std::abs(x[0]) > std::abs(latched) && x[0] * latched > 0) break;
    if (k > 4'000'000) return INFINITY;
    most = std::max(most, std::abs(system.moment(x, 1)));
    x[0] += 0.5 * sense * step; // of a linear moment the work is exact
    left += (sense * system.moment(x, 1) - friction) * step;
  }
  return most;
}

} // namespace

TEST_CASE(
    "the spring of a hinge that cannot reach its latch exerts no more than the energy lets it") {
  for (int trial = 0; trial < 60; ++trial) {
    oracle::Draws draws(4400 + trial);
    const Scene scene = weak_panel(draws, trial % 2 == 0);
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    State<double> x;
    system.start(x);
    x[0] = scene.hinges[0].latched * draws.uniform(-0.2, 0.8);
    x[1] = draws.uniform(-0.3, 0.3);
    RemainingEnergy<double> remaining;
    remaining.prepare(system);
    const auto left = remaining.energy(system, x, 0.0, 1e9);
    CAPTURE(trial);
    REQUIRE(left);
    double most = 0;
    for (const double sense : {-1., 1.})
      most = std::max(most, most_on_way(system, x[0], sense, scene.hinges[0].latched,
                                        scene.hinges[0].friction.coulomb, left->within));
    CHECK(remaining.steady(1) >= most * (1 - 1e-9));
    CHECK(remaining.steady(1) <= most * (1 + 1e-3));
  }
}

TEST_CASE("there is no bound of the energy where it may take a hinge to a stop, on either side") {
  for (const bool far : {false, true})
    for (const double stowed : {0.02, -0.02}) { // the latch is at 0
      Scene scene = oracle::latching_panel();
      Hinge& hinge = scene.hinges[0];
      hinge.stowed = stowed, hinge.latched = 0;
      hinge.spring = {}, hinge.harness = {}, hinge.friction = {};
      Stop stop;
      stop.stiffness = 1e5, stop.gap = 0.01;
      (far ? hinge.far_stop : hinge.stop) = stop;
      const double way = far ? 0.01 : 0.03; // from rest to the stop
      Wing<double> wing = make_wing<double>(scene, outward_order(scene));
      set_parameters(wing, scene);
      Workspace<double> work;
      System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
      system.find_sides({0, 0}); // where it latches
      system.engage(1);
      RemainingEnergy<double> remaining;
      remaining.prepare(system);
      for (const double share : {-1.01, -0.99, 0.5, 0.99, 1.01}) { // either way: the hinge swings
        State<double> x{share * way, 0};
        system.find_sides(x);
        CAPTURE(far, stowed, share);
        CHECK(remaining.energy(system, x, 0., 1.).has_value() == (std::abs(share) < 1));
      }
    }
}
