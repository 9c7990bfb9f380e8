// The bound on what a locked hinge bears inside a step, against loads found from positions alone.
#include "core/events/held_load.hpp"
#include "tests/core/dense/any_motion.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace wingspread;

namespace {

template <BaseMotion M> void check_random_wings() {
  const double most = oracle::most_taken_by_random_wings<M>(
      {900, 1700, 140},
      [](const oracle::AnyMotion<M>& motion, double s) { return motion.loads(s); },
      [](const oracle::AnyMotion<M>& motion) {
        HeldLoadBound<double> bound;
        bound.over_step(motion.system, motion.step);
        return bound;
      });
  CHECK(most > 0.05); // it is not twenty times too large everywhere
}

} // namespace

TEST_CASE("what a locked hinge bears rises no more inside a step than the bound says") {
  SECTION("fixed base") { check_random_wings<BaseMotion::fixed>(); }
  SECTION("prescribed base") { check_random_wings<BaseMotion::prescribed>(); }
  SECTION("free base") { check_random_wings<BaseMotion::free>(); }
}

namespace {

/// Sets the step's relative angles to steady turns at these rates, at `middle` half-way through the step.
template <BaseMotion M>
void turn_steadily(oracle::AnyMotion<M>& motion, const std::vector<double>& middle,
                   const std::vector<double>& rates) {
  Step<double>& step = motion.step;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    const std::size_t r = k + rates.size();
    step.x[k] = middle[k] - 0.5 * step.h * rates[k];
    step.x1[k] = middle[k] + 0.5 * step.h * rates[k];
    step.x[r] = step.x1[r] = step.dxdt[k] = step.dxdt1[k] = rates[k];
    step.dxdt[r] = step.dxdt1[r] = 0;
  }
}

/// The part of the bound that the load of hinge i takes in the middle of the step.
template <BaseMotion M> double part_in_middle(const oracle::AnyMotion<M>& motion, int i) {
  HeldLoadBound<double> bound;
  bound.over_step(motion.system, motion.step);
  const double ends = std::max(motion.loads(0)[i], motion.loads(1)[i]);
  return (motion.loads(0.5)[i] - ends) / bound.rise(i);
}

} // namespace

// Two cases in which the bound is three quarters taken, as it may be at most: of (2), one term alone each.
TEST_CASE("a panel that turns on a pushed base takes what the bound leaves it") {
  // its load, m c a sin of the angle between them, is at its crest in the middle of the step
  Scene scene = oracle::latching_panel();
  scene.base.motion = BaseMotion::prescribed;
  scene.base.acceleration = {10, 0};
  oracle::AnyMotion<BaseMotion::prescribed> motion(scene, 1, 2, 0);
  const Vec2<double>& center = motion.wing.bodies[1].center;
  const double across = 0.5 * std::numbers::pi - std::atan2(center.y, center.x);
  turn_steadily(motion, {across}, {0.1});
  const double part = part_in_middle(motion, 1);
  CHECK(part < 0.75 + 1e-6);
  CHECK(part > 0.7); // the panel's own turn adds to the bound, and does nothing
}

TEST_CASE("a panel that turns against its arm takes what the bound leaves it") {
  // the hinge at the end of an arm l turns at w, the panel there at −w: m c l w² sin 2wt
  Scene scene = oracle::latching_panel();
  const double l = 1, c = 0.01, w = 0.5;
  Body arm{"arm", 1e-9, 1e-9};
  scene.bodies = {arm, scene.bodies[0]};
  Hinge root = scene.hinges[0];
  root.name = "arm_root";
  root.child_point = {0, 0};
  scene.hinges[0].parent = 0, scene.hinges[0].child = 1;
  scene.hinges[0].parent_point = {l, 0}, scene.hinges[0].child_point = {-c, 0};
  scene.hinges.push_back(root);
  oracle::AnyMotion<BaseMotion::fixed> motion(scene, 1, 0.2, 0);
  turn_steadily(motion, {0, 0.5 * std::numbers::pi}, {w, -2 * w});
  const double part = part_in_middle(motion, 2);
  CHECK(part < 0.75 + 1e-6);
  CHECK(part > 0.7);
}
