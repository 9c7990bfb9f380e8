// The work of motors over a step of any motion, against a sum over the step of their moments by (1) of motor.hpp.
#include "core/peaks/motor_energy.hpp"
#include "tests/core/dense/any_motion.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A random wing of which most hinges have a motor, of a constant rate or by a table.
Scene motorized_wing(std::uint64_t seed) {
  RandomScene options;
  options.bodies = 1 + static_cast<int>(seed % 5), options.motion = BaseMotion::fixed;
  Scene scene = random_scene(seed, options);
  Draws draws(seed + 1000);
  for (std::size_t k = 0; k < scene.hinges.size(); ++k) {
    if (k > 0 && draws.chance(0.2)) continue;
    Motor motor;
    motor.gain = draws.log_uniform(0.1, 10), motor.torque_limit = draws.log_uniform(0.1, 10);
    motor.rate = draws.uniform(-2, 2);
    if (draws.chance(0.5)) {
      motor.time = {0, 4}, motor.rates = {draws.uniform(-2, 2), draws.uniform(-2, 2)};
      motor.interpolation = Interpolation::linear, motor.scale = draws.uniform(0.5, 2);
      motor.table = std::make_shared<Curve>(motor.time, motor.rates, motor.interpolation);
    }
    scene.hinges[k].motor = motor;
  }
  return scene;
}

struct Worked {
  double work, scale; ///< J; ∫ |M φ̇| dt
  bool passes_limit;  ///< it is within its limit for a part of the step
};

/// ∫ M φ̇ dt over the step by the trapezium rule.
Worked work_of_motor(const AnyMotion<BaseMotion::fixed>& motion, int i) {
  const Hinge& hinge = motion.scene.hinges[motion.wing.hinge_of[i]];
  const Motor& motor = *hinge.motor;
  const double sense = hinge.latched < hinge.stowed ? -1 : 1, h = motion.step.h;
  const int angle = motion.system.layout().angle(i), freedoms = motion.system.layout().freedoms();
  const Quintic<double> rate = derivative(motion.step.coordinate(angle, freedoms), h);
  constexpr int parts = 4000;
  Worked found{0, 0, false};
  int within = 0;
  for (int k = 0; k <= parts; ++k) {
    const double s = double(k) / parts, v = value(rate, s), t = motion.step.t + s * h;
    const double command = motor.table ? motor.scale * motor.table->value_at(t) : motor.rate;
    const double wanted = motor.gain * (sense * command - v);
    const double power = std::clamp(wanted, -motor.torque_limit, motor.torque_limit) * v;
    const double part = (k == 0 || k == parts ? 0.5 : 1) * h / parts;
    found.work += part * power, found.scale += part * std::abs(power);
    within += std::abs(wanted) < motor.torque_limit;
  }
  found.passes_limit = within > 0 && within <= parts;
  return found;
}

} // namespace

TEST_CASE(
    "the work of motors over a step is the sum of their power, also where they reach a limit") {
  int whole = 0, in_parts = 0, counted_not = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    Draws draws(seed + 2000);
    AnyMotion<BaseMotion::fixed> motion(motorized_wing(seed), seed, draws.log_uniform(0.01, 1),
                                        draws.log_uniform(0.01, 3));
    const int n = motion.wing.size();
    std::vector<bool> counts(n + 1, true);
    std::vector<double> energy(n + 1), before(n + 1);
    for (int i = 1; i <= n; ++i) {
      energy[i] = before[i] = draws.uniform(-1, 1); // what earlier steps have given
      counts[i] = motion.wing.motors[i].present;
      if (draws.chance(0.2)) { // its hinge is held
        motion.work.motors[i] = idle_motor<double>();
        counts[i] = false;
      }
      if (draws.chance(0.2)) motion.system.engage(i), counts[i] = false;
    }
    add_motor_energy(energy, motion.system, motion.step);
    for (int i = 1; i <= n; ++i) {
      CAPTURE(seed, i);
      if (!counts[i]) {
        CHECK(energy[i] == before[i]);
        ++counted_not;
        continue;
      }
      const Worked exact = work_of_motor(motion, i);
      CHECK(std::abs(energy[i] - before[i] - exact.work) < 1e-5 * exact.scale);
      ++(exact.passes_limit ? in_parts : whole);
    }
  }
  CHECK(std::min({whole, in_parts, counted_not}) > 30);
}
