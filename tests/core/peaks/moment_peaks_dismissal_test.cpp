// The tests that dismiss a step in the search for the largest moment of a hinge with a motor, or of one that sticks.
#include "core/peaks/moment_peaks.hpp"
#include "tests/core/dense/any_motion.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("the moment of a hinge with a motor keeps its direction only where no sample turns") {
  int kept = 0, turning = 0;
  for (int k = 0; k < 400; ++k) {
    Draws draws(4100 + k);
    Scene scene = latching_panel();
    scene.hinges[0].spring = {draws.uniform(-20, 20), draws.uniform(-20, 20)};
    Motor motor{.rate = draws.uniform(-2, 2), .gain = draws.log_uniform(0.1, 10)};
    motor.torque_limit = motor.gain * draws.log_uniform(0.1, 10);
    if (draws.chance(0.5))
      motor.table = std::make_shared<Curve>(std::vector<double>{-1, 1, 4},
                                            std::vector<double>{0, draws.uniform(-2, 2), 1},
                                            Interpolation::monotone, Beyond::constant);
    scene.hinges[0].motor = motor;
    AnyMotion<BaseMotion::fixed> motion(scene, 4600 + k, draws.log_uniform(1e-3, 0.3),
                                        draws.log_uniform(0.01, 3));
    const MomentOverStep moment(motion.system, motion.step, 1);
    double rise = 0, fall = 0, size = 0;
    for (int s = 0; s < 400; ++s) {
      const double here = moment(s / 400.), there = moment((s + 1) / 400.);
      rise = std::max(rise, there - here), fall = std::max(fall, here - there);
      size = std::max(size, std::abs(here));
    }
    const bool turns = std::min(rise, fall) > 1e-12 * size;
    turning += turns;
    if (!moment.keeps_direction()) continue;
    ++kept;
    CAPTURE(k, rise, fall);
    CHECK_FALSE(turns);
  }
  CAPTURE(kept, turning);
  CHECK(kept >= 30);
  CHECK(turning >= 100);
}

// What holds a hinge bears at most the static limit beside the hinge's own moment. So a moment across the hinge that
// friction just bears is never excluded, wherever in the step it lies.
TEST_CASE("no moment of a stuck hinge that its friction just bears is excluded") {
  int by_friction = 0;
  for (int k = 0; k < 60; ++k) {
    Draws draws(5100 + k);
    RandomScene options;
    options.bodies = 1 + k % 4, options.branching = k % 2 == 0, options.motion = BaseMotion::fixed;
    options.friction = false;
    AnyMotion<BaseMotion::fixed> motion(random_scene(5400 + k, options), 5700 + k,
                                        draws.log_uniform(1e-2, 0.3), draws.log_uniform(0.01, 1));
    for (int i = 1; i <= motion.wing.size(); ++i) {
      const MomentOverStep own(motion.system, motion.step, i);
      double largest = 0, of_friction = 0, of_law = 0;
      for (int s = 0; s <= 32; ++s) {
        const double across = motion.moments(s / 32.0)[i], law = own(s / 32.0);
        largest = std::max(largest, std::abs(across)), of_law = std::max(of_law, std::abs(law));
        of_friction = std::max(of_friction, std::abs(across - law));
      }
      motion.wing.hinges[i].static_friction = of_friction;
      PeakOf<double> peak;
      peak.value = largest * (1 - 1e-6);
      CAPTURE(k, i, largest, of_law, of_friction);
      CHECK(held_moment_may_rise(peak, motion.system, motion.step, i));
      by_friction += largest > 1.5 * of_law;
      peak.value = (own.most() + of_friction) * (1 + 1e-9);
      CHECK_FALSE(held_moment_may_rise(peak, motion.system, motion.step, i));
    }
  }
  CHECK(by_friction >= 20);
}
