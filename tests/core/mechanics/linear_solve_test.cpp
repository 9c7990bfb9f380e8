#include "core/mechanics/linear_solve.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/real_scenes.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
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

// The implicit methods solve with this model, and `auto` measures the spectral radius by it. A wrong slope costs steps and
// no accuracy, so no run shows it.
TEST_CASE("what hinges and loops resist are the slopes of their moments: taut, slack, damped, "
          "motorised") {
  oracle::RealFeatures features;
  features.tables = features.measured =
      false; // of a gear that changes the model has the present one
  features.gravity = features.air = features.dissipation = false;
  int slack = 0, taut = 0, limited = 0, driven = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    oracle::Draws draws(seed);
    oracle::RandomScene options;
    options.bodies = 2 + draws.below(4), options.motion = BaseMotion::fixed,
    options.springs = false;
    Scene scene = oracle::with_real_hinges(oracle::random_scene(seed, options), seed, features);
    for (Hinge& hinge : scene.hinges) {
      hinge.harness = {};
      if (draws.chance(0.5))
        hinge.motor = Motor{.rate = draws.uniform(-2, 2),
                            .gain = draws.log_uniform(0.1, 10),
                            .torque_limit = draws.log_uniform(0.1, 10)};
    }
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    const Layout& at = system.layout();
    const int n = at.bodies;
    State<double> x, dxdt;
    system.start(x), dxdt.resize(x.size());
    for (double& c : x) c = draws.uniform(-2, 2);
    system.find_sides(x);
    for (int i = 1; i <= n; ++i)
      if (wing.hinges[i].has_latch && draws.chance(0.5)) system.engage(i);
    system(x, dxdt, 0.0); // commands the motors
    std::vector<LoopResistance<double>> loops;
    loop_resistances(system, x, loops);
    for (const LoopTerms<double>& loop : wing.loops)
      ++(taut_share(loop, system.state_of(loop, x).elastic) < 1 ? slack : taut);
    for (int i = 1; i < static_cast<int>(wing.motors.size()); ++i)
      if (wing.motors[i].present)
        ++(std::abs(wing.motors[i].gain * (work.motors[i].now - x[at.rate(i)])) <
                   wing.motors[i].limit
               ? driven
               : limited);
    for (const bool by_rate : {false, true})
      for (int j = 1; j <= n; ++j) {
        const double d = 1e-7;
        State<double> up = x, down = x;
        const int k = by_rate ? at.rate(j) : at.angle(j);
        up[k] += d, down[k] -= d;
        for (int i = 1; i <= n; ++i) {
          const Resistance<double> own = resistance(system, x, 0.0, i);
          const double expected = i == j ? (by_rate ? own.damping : own.stiffness) : 0;
          double by_loops = 0, size = expected;
          for (const LoopResistance<double>& loop : loops) {
            const double on = i == loop.first    ? loop.on_first
                              : i == loop.second ? loop.on_second
                                                 : 0;
            const double weight = by_rate ? loop.damping : loop.stiffness;
            const double pull =
                weight * loop.along([&](int body) { return body == j ? 1.0 : 0.0; });
            by_loops += on * pull, size += std::abs(on * pull);
          }
          const double slope =
              (system.sliding_moment(down, i) - system.sliding_moment(up, i)) / (2 * d);
          // an eddy-current damper beyond its peak gives way: the hinge then counts with 0
          const double found = i == j ? std::max(slope - by_loops, 0.0) : slope - by_loops;
          const double rounding = 1e-7 * std::abs(system.sliding_moment(x, i));
          CAPTURE(seed, by_rate, i, j);
          CHECK(std::abs(found - expected) <= 1e-4 * size + rounding + 1e-6);
        }
      }
  }
  CHECK(std::min({slack, taut, limited, driven}) > 30);
}
