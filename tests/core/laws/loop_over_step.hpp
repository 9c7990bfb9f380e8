/// Random loops, each over a step in which its two hinges move by quintics.
#pragma once

#include "core/laws/loop.hpp"
#include "tests/support/real_scenes.hpp"

#include <cstdint>
#include <vector>

namespace wingspread::oracle {

/// A random loop between hinges 1 and 2, and a random step of these.
struct LoopOverStep {
  Synchronisation given; // holds the table
  LoopTerms<double> loop{};
  Quintic<double> a, b;
  double h;

  explicit LoopOverStep(std::uint64_t seed) {
    Draws draws(seed);
    loop.first = 1, loop.second = 2;
    loop.ratio = draws.sign() * draws.uniform(0.5, 2);
    loop.stiffness = draws.log_uniform(1, 1e3);
    loop.damping = draws.chance(0.7) ? draws.log_uniform(1e-2, 1e2) : 0;
    loop.stowed_a = draws.uniform(-2, 2), loop.stowed_b = draws.uniform(-2, 2);
    loop.sense_a = draws.sign(), loop.sense_b = draws.sign();
    if (draws.chance(0.5)) {
      std::vector<double> x{0}, y{0};
      for (int k = 0; k < 3; ++k) { // falling ones too, and changes of direction
        x.push_back(x.back() + draws.uniform(0.2, 1));
        y.push_back(y.back() + draws.uniform(-1, 1));
      }
      tabulate(given, x, y);
      loop.table = given.table.get();
    }
    h = draws.log_uniform(1e-3, 1);
    const double way = draws.log_uniform(1e-3, 0.5), from = draws.uniform(0, 1.5);
    for (int k = 0; k < 6; ++k) {
      a[k] = loop.stowed_a + loop.sense_a * (from + way * draws.uniform(0, 1));
      const double x = loop.table ? value(*loop.table, from) : loop.ratio * from;
      b[k] = loop.stowed_b + loop.sense_b * (x + way * draws.uniform(-1, 1));
    }
    const double carried = loop.stiffness * way;
    loop.slack_beyond = draws.chance(0.5) ? carried * draws.log_uniform(1e-2, 1) : 1e300;
  }

  [[nodiscard]] LoopState<double> state(double s) const {
    return loop_state(loop, value(a, s), value(derivative(a, h), s), value(b, s),
                      value(derivative(b, h), s));
  }
  [[nodiscard]] double torque(double s) const { return loop_torque(loop, state(s)); }
  [[nodiscard]] double moment(int i, double s) const {
    return on_hinge(loop, i, state(s).gear) * torque(s);
  }
};

/// A loop by a table between its first two knots, where the gear changes all the time; hinge a moves at a constant
/// acceleration and hinge b hardly: the gear's change makes most of the bounds.
inline LoopOverStep bent_loop(std::uint64_t seed) {
  LoopOverStep step(seed);
  Draws draws(seed + 500);
  LoopTerms<double>& loop = step.loop;
  tabulate(step.given, {0, 1, 2}, {0, draws.uniform(0.1, 0.3), draws.uniform(1, 2)});
  loop.table = step.given.table.get();
  loop.damping = draws.chance(0.5) ? draws.log_uniform(1, 100) : 0, loop.slack_beyond = 1e300;
  const double h = step.h, from = draws.uniform(0.05, 0.3), way = draws.log_uniform(1e-3, 0.5);
  const double v = way / h * draws.uniform(0.3, 1), w = 2 * (way - v * h) / (h * h);
  step.a = hermite<double>(h, {from, v, w}, {from + way, v + w * h, w});
  for (double& angle : step.a) angle = loop.stowed_a + loop.sense_a * angle;
  step.b.fill(loop.stowed_b + loop.sense_b * value(*loop.table, from));
  return step;
}

} // namespace wingspread::oracle
