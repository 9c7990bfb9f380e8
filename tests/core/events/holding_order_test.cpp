// Hinges that are torn loose in one step, each at its own time.
#include "core/deployment.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <memory>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A panel that sticks until its motor's rising command tears it loose.
Hinge torn_loose(Hinge hinge, double static_level) {
  hinge.spring = {0, 0}, hinge.latch.reset();
  rub(hinge, 0.5 * static_level, static_level);
  Motor motor{.gain = 1, .torque_limit = 100};
  motor.table = std::make_shared<Curve>(std::vector<double>{0, 10}, std::vector<double>{0, 10},
                                        Interpolation::linear, Beyond::constant);
  hinge.motor = motor;
  return hinge;
}

} // namespace

// Panels beside each other on a fixed base do not feel each other.
TEST_CASE("hinges torn loose in one step set out in the order of their loads, whatever their own") {
  Draws draws(17);
  for (int k = 0; k < 12; ++k) {
    const double levels[] = {draws.uniform(1, 3), draws.uniform(1, 3), draws.uniform(1, 3)};
    Scene all = latching_panel();
    const Hinge hinge = all.hinges[0];
    const Body body = all.bodies[0];
    all.bodies.clear(), all.hinges.clear();
    for (int i = 0; i < 3; ++i) {
      all.bodies.push_back(body), all.bodies.back().name += std::to_string(i);
      all.hinges.push_back(torn_loose(hinge, levels[i]));
      all.hinges.back().name += std::to_string(i), all.hinges.back().child = i;
    }
    const Outcome together = run(all, 1e-9, 4);
    for (int i = 0; i < 3; ++i) {
      Scene one = all;
      one.bodies = {all.bodies[i]}, one.hinges = {all.hinges[i]}, one.hinges[0].child = 0;
      const Outcome alone = run(one, 1e-9, 4);
      CAPTURE(k, i, levels[0], levels[1], levels[2]);
      CHECK(std::abs(alone.final.rates[0]) > 1e-3);
      CHECK(together.final.angles[i] == Approx(alone.final.angles[0]).margin(1e-6));
      CHECK(together.final.rates[i] == Approx(alone.final.rates[0]).margin(1e-6));
    }
  }
}
