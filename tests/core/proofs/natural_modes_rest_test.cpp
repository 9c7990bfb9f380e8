// The rest about which the natural modes swing, against the balance of the dense formulation.
#include "core/proofs/natural_modes.hpp"
#include "tests/support/dense_wing.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <optional>

using namespace wingspread;
using namespace wingspread::oracle;

// Newton's method from the latched angle ends at −7.7, 0.77 and 5.4 rad: stable too, but beyond a barrier.
TEST_CASE("rest is where a hinge without a latch creeps to, not another place where its torques "
          "balance") {
  Draws draws(39);
  int far = 0;
  const int panels = random_cases(400, 100);
  for (int k = 0; k < panels; ++k) {
    Scene scene = free_panel(1);
    Hinge& hinge = scene.hinges[0];
    hinge.latch.reset(), hinge.harness = {}, hinge.friction = {};
    hinge.stowed = draws.uniform(-3, 3), hinge.latched = draws.uniform(-3, 3);
    hinge.spring = {};
    hinge.spring.torque_stowed = draws.uniform(-5, 5);
    hinge.spring.torque_latched = draws.uniform(-5, 5);
    scene.environment.gravity = {draws.uniform(-4, 4), draws.uniform(-4, 4)};
    const DenseWing<long double> wing(scene);
    const auto moment = [&](double angle) { // at rest: the acceleration has its sign
      WingState<long double> state = wing.initial_state();
      state.angles(0) = angle, state.rates(0) = 0;
      return static_cast<double>(wing.respond(state).hinge_accelerations(0));
    };
    const double sense = moment(hinge.latched) > 0 ? 1 : -1;
    constexpr double step = 1e-3;
    double at = hinge.latched;
    int steps = 0;
    while (steps < 20'000 && sense * moment(at) > 0) at += sense * step, ++steps;
    if (steps == 20'000) continue; // it turns on and on
    const std::optional<WingModes> found = natural_modes(scene, {});
    CAPTURE(k, hinge.latched, at);
    REQUIRE(found);
    CHECK(std::abs(found->rest[0] - at) <= step);
    far += steps > 1000;
  }
  CHECK(far > panels / 20);
}
