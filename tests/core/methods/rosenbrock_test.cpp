// The linear system of the implicit methods: the column that time has in its Jacobian.
#include "core/methods/rosenbrock.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

// A wrong column costs no order, but steps: a stiff gain then follows its command a step late.
TEST_CASE("the column of time is the derivative of the accelerations by time, whatever piece of "
          "its table a motor is in") {
  int moved = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Draws draws(seed);
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 4), options.motion = BaseMotion::fixed;
    Scene scene = random_scene(seed, options);
    for (Hinge& hinge : scene.hinges) {
      Motor motor{.time = {0.3, 1, 2.5, 4}, .interpolation = Interpolation::monotone};
      double rate = 0; // a monotone table has no slope where it turns
      for (int k = 0; k < 4; ++k) motor.rates.push_back(rate += draws.uniform(0.1, 2));
      motor.table = std::make_shared<Curve>(motor.time, motor.rates, motor.interpolation);
      motor.gain = draws.log_uniform(0.1, 100), motor.torque_limit = draws.log_uniform(1, 1e4);
      hinge.motor = motor;
    }
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    State<double> x, dxdt, before, after;
    system.start(x);
    dxdt = before = after = x;
    const double t = draws.uniform(0.1, 3.9), d = 1e-5, eta = 1e-9;
    system.enter_piece(t);
    LinearlyImplicit<double> linear;
    system(x, dxdt, t);
    linear.factorize(system, Start<double>{t, x, dxdt}, eta);
    State<double> column(x.size(), 0.0);
    linear.solve(system, column, 1.0); // eta times the column, but for eta²
    system(x, before, t - d), system(x, after, t + d);
    const Layout& at = system.layout();
    double size = 0;
    for (int i = 1; i <= at.bodies; ++i)
      size = std::max(size, std::abs(after[at.rate(i)] - before[at.rate(i)]) / (2 * d));
    for (int i = 1; i <= at.bodies; ++i) {
      const double slope = (after[at.rate(i)] - before[at.rate(i)]) / (2 * d);
      CAPTURE(seed, t, i);
      CHECK(column[at.rate(i)] / eta == Approx(slope).epsilon(1e-4).margin(1e-4 * size + 1e-6));
    }
    moved += size > 1e-3;
  }
  CHECK(moved > 30);
}
