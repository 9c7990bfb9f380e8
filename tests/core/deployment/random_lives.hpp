/// Lives for random wings: holds, motors, latches that miss and let go, and stops beyond the latched angle.
#pragma once

#include "tests/core/deployment/real_runs.hpp"

namespace wingspread::oracle {

inline std::optional<Motor> random_motor(Draws& draws) {
  if (draws.chance(0.3)) return std::nullopt;
  Motor motor;
  motor.gain = draws.log_uniform(0.3, 100);
  motor.rate = draws.uniform(-0.3, 1);
  motor.torque_limit = motor.gain * draws.log_uniform(0.05, 5);
  if (draws.chance(0.6)) return motor;
  motor.time = {draws.uniform(-1, 0.3)}, motor.rates = {draws.uniform(-0.3, 1)};
  for (int k = 0; k < 4; ++k) {
    motor.time.push_back(motor.time.back() + draws.uniform(0.1, 1));
    motor.rates.push_back(draws.uniform(-0.3, 1));
  }
  motor.interpolation = draws.chance(0.5) ? Interpolation::monotone : Interpolation::linear;
  motor.table = std::make_shared<Curve>(motor.time, motor.rates, motor.interpolation);
  motor.scale = draws.uniform(0.5, 1.5);
  return motor;
}

/// Makes the latches of a random scene softer, and gives its hinges a life.
/// @param motors whether hinges may have motors and elastic holds, which leave all other draws as they are
inline Scene with_life(Scene scene, std::uint64_t seed, bool motors = false) {
  Draws draws(seed), motor_draws(seed + 77777);
  const int n = static_cast<int>(scene.hinges.size());
  for (int i = 0; i < n; ++i) {
    Hinge& hinge = scene.hinges[i];
    hinge.initial_rate = 0;
    hinge.friction.regularization_rate = 0.1;
    Latch latch{draws.log_uniform(50, 1000), draws.log_uniform(0.1, 10)};
    if (draws.chance(0.3)) {
      latch.damping = 0, latch.dissipation = draws.log_uniform(0.1, 2);
      // with a damper the moment would jump at its edges, where the oracle's last stage may lie on either side
      if (draws.chance(0.5)) latch.backlash = draws.log_uniform(1e-3, 3e-2);
    }
    if (draws.chance(0.5)) latch.capture_rate = draws.log_uniform(0.2, 5);
    if (draws.chance(0.5)) latch.holding_moment = draws.log_uniform(1, 100);
    hinge.latch = latch;
    if (draws.chance(0.5))
      hinge.far_stop =
          Stop{draws.log_uniform(50, 1000), draws.uniform(0, 1), draws.uniform(0, 0.2)};
    if (motors) hinge.motor = random_motor(motor_draws);
    if (!draws.chance(0.5)) continue;
    Release release{.delay = draws.chance(0.5) ? draws.uniform(0, 0.5) : 0};
    release.after = draws.below(n);
    if (release.after == i || draws.chance(0.4)) {
      release.time = draws.uniform(0, 1), release.after = -1;
    } else {
      const bool held = scene.hinges[release.after].release.has_value() && release.after < i;
      const Hinge& other = scene.hinges[release.after];
      release.event = held && draws.chance(0.3) ? Release::Event::released
                      : draws.chance(0.5)       ? Release::Event::latched
                                                : Release::Event::passed;
      release.angle = draws.uniform(0.05, 0.95) * std::abs(other.latched - other.stowed);
    }
    if (draws.chance(0.1)) release.fails = 1;
    hinge.release = release;
    if (motors && motor_draws.chance(0.4))
      hinge.hold = Hold{motor_draws.log_uniform(1, 3000), motor_draws.log_uniform(0.1, 10)};
  }
  return scene;
}

} // namespace wingspread::oracle
