// Motions that climb towards the bound on what a locked hinge bears: none breaks it, and where one kind of load is alone
// some come near. A bound that lacks a term is broken.
#include "core/events/stuck_load.hpp"
#include "tests/core/dense/any_motion.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

using namespace wingspread;

namespace {

using oracle::AnyMotion;

/// The largest part of the bound that any hinge's load takes inside the step; infinite where a load is above its size.
template <BaseMotion M> double part_of_load(const AnyMotion<M>& motion, bool narrowed) {
  HeldLoadBound<double> bound;
  bound.over_step(motion.system, motion.step);
  const int n = motion.wing.size();
  double rounding = 1e-300; // of loads by differences of positions
  for (const BodyTerms<double>& body : motion.wing.bodies)
    rounding += 1e-6 * (body.mass + body.central_inertia);
  for (int i = 1; narrowed && i <= n; ++i) bound.narrow(motion.system, motion.step, i);
  for (const double s : {0.0, 0.3, 0.7, 1.0}) {
    const std::vector<double> loads = motion.loads(s);
    for (int i = 1; i <= n; ++i)
      if (!(loads[i] <= bound.size(i) * (1 + 1e-4) + rounding)) return INFINITY;
  }
  return oracle::part_taken(
      n, 0, 1, [&](double s) { return motion.loads(s); },
      [&](int i) { return bound.rise(i) + 1e-6 * bound.size(i) + rounding; });
}

/// Climbs from the motion by changes of the states and accelerations at the step's ends.
template <BaseMotion M>
double climbed(AnyMotion<M>& motion, oracle::Draws& draws, bool narrowed, int passes) {
  const Layout& at = motion.system.layout();
  const int n = at.freedoms();
  Step<double>& step = motion.step;
  double best = part_of_load(motion, narrowed), size = 1;
  for (int pass = 0; pass < passes; ++pass) {
    const Step<double> before = step;
    const auto change = [&](double scale) { return scale * size * draws.uniform(-1, 1); };
    for (int k = 0; k < n; ++k) {
      if (draws.chance(0.5)) continue;
      const int r = k + n;
      const double scale = draws.log_uniform(1e-3, 1);
      const double still = draws.chance(0.1) ? 0 : 1; // a coordinate at rest
      step.x[k] += change(scale);
      const double v0 = still * (step.x[r] + change(scale)),
                   v1 = still * (step.x1[r] + change(scale));
      step.x[r] = step.dxdt[k] = v0, step.x1[r] = step.dxdt1[k] = v1;
      step.dxdt[r] = still * (step.dxdt[r] + change(scale) / step.h);
      step.dxdt1[r] = still * (step.dxdt1[r] + change(scale) / step.h);
      // as the four of them lead there, and a little off
      step.x1[k] = step.x[k] + step.h * (0.5 * (v0 + v1) + still * change(0.1 * scale)) +
                   step.h * step.h * (step.dxdt[r] - step.dxdt1[r]) / 12;
    }
    const double there = part_of_load(motion, narrowed);
    if (there > best)
      best = there, size = std::min(1.0, 1.5 * size);
    else
      step = before, size = std::max(1e-3, 0.95 * size);
  }
  return best;
}

enum class Alone { inertia, masses, air, gravity };

template <BaseMotion M> double most_climbed(Alone what, bool driven, int wings, int passes) {
  double most = 0;
  for (int k = 0; k < wings; ++k) {
    oracle::Draws draws(9100 + k);
    oracle::RandomScene options;
    options.bodies = 1 + k % 3, options.branching = false, options.motion = M;
    Scene scene = random_scene(9200 + k, options);
    scene.base.acceleration = {0, 0};
    if (what == Alone::gravity) scene.environment.gravity = {draws.uniform(-9, 9), 3};
    for (Body& body : scene.bodies) {
      if (what == Alone::inertia) body.inertia *= 1e6;
      if (what == Alone::masses) body.inertia *= 1e-6;
      if (what != Alone::air) continue;
      body.mass *= 1e-9, body.inertia *= 1e-9;
      if (&body == &scene.bodies.back() || draws.chance(0.5))
        body.plate = Plate{draws.vector(0.5), draws.vector(0.5), 1, 1.5};
    }
    if (what == Alone::air) scene.environment.air_density = 1.2, scene.base.mass = 1e-9;
    if (driven) scene.base = oracle::driven_by_table(scene, 9300 + k, 3).base;
    AnyMotion<M> motion(scene, 9400 + k, draws.log_uniform(0.2, 1), 1);
    const double part = climbed(motion, draws, k % 2 == 0, passes);
    CAPTURE(k, static_cast<int>(what), driven);
    CHECK(part < 0.75 + 1e-4);
    most = std::max(most, part);
  }
  return most;
}

} // namespace

TEST_CASE("no motion that climbs towards the bound on a locked hinge's load passes it") {
  const int wings = 6, passes = 150;
  const auto most = [&](Alone what) {
    return std::min({most_climbed<BaseMotion::fixed>(what, false, wings, passes),
                     most_climbed<BaseMotion::free>(what, false, wings, passes),
                     most_climbed<BaseMotion::prescribed>(what, false, wings, passes),
                     most_climbed<BaseMotion::prescribed>(what, true, wings, passes)});
  };
  CHECK(most(Alone::inertia) > 0.6);
  CHECK(most(Alone::masses) > 0.1);
  CHECK(most(Alone::gravity) > 0.3);
  CHECK(most(Alone::air) > 0.05);
}

namespace {

/// The part of the bound that the load of a stuck panel takes: it lies along x, and its base moves along y by this cubic
/// acceleration, from this velocity on. Its mass is 0.5 m from the hinge. A narrow plate 0.99 m from it makes the moment B v².
double part_of_pushed_plate(double mass, double B, const std::array<double, 4>& acceleration,
                            double velocity, double h, double gravity) {
  Scene scene = oracle::latching_panel();
  scene.bodies[0].mass = mass, scene.bodies[0].inertia = 1e-12;
  scene.hinges[0].child_point = {-0.5, 0};
  scene.bodies[0].plate = Plate{{0.48, 0}, {0.5, 0}, B / (0.02 * 0.99), 2};
  scene.environment.air_density = 1, scene.environment.gravity = {0, gravity};
  scene.base.motion = BaseMotion::prescribed;
  scene.base = oracle::driven_by_table(scene, 1, 3).base;
  AnyMotion<BaseMotion::prescribed> motion(scene, 1, h, 0);
  Step<double>& step = motion.step;
  for (State<double>* x : {&step.x, &step.x1, &step.dxdt, &step.dxdt1}) x->assign(2, 0.0);
  DrivenPiece<double>& piece = motion.system.writable_workspace().driven;
  piece.from = step.t, piece.until = never;
  piece.x = piece.turning = {0, 0, 0, 0}, piece.y = acceleration;
  piece.velocity = {0, velocity}, piece.rate = piece.angle = 0;
  return part_of_load(motion, false);
}

} // namespace

// L = B v² − ½ m |a − g| or the sum of both. Each case leaves one term of the air's bound alone.
TEST_CASE("a plate on a pushed base takes what the air's bound leaves it") {
  for (const double h : {0.02, 0.3})
    for (const double sense : {-1.0, 1.0}) {
      CAPTURE(h, sense);
      // v is largest in the middle: 2 B v |v̈|
      const double bend = 1;
      const double crest = part_of_pushed_plate(
          1e-12, 1, {sense * 0.5 * bend * h, -sense * bend, 0, 0}, sense * 10, h, 0);
      CHECK(crest < 0.75 + 1e-6);
      CHECK(crest > 0.65);
      // v falls to 0 under ½ m a, and takes 2 B v̇² from it; ½ m a falls too, so that their sum has its crest inside
      const double mass = 2, A = 3, share = 0.05, B = share * 0.5 * mass / (A * h * h);
      const double jerk = B * A * A * h / (0.5 * mass);
      const double brakes =
          part_of_pushed_plate(mass, B, {-sense * A, sense * jerk, 0, 0}, sense * A * h, h, 0);
      CHECK(brakes < 0.75 + 1e-6);
      CHECK(brakes > 0.6);
      // v rises from 0 against gravity, which the base hardly feels: v̇ is not what it feels
      const double rises =
          part_of_pushed_plate(mass, B, {sense * A, -sense * jerk, 0, 0}, 0, h, sense * 1.2 * A);
      CHECK(rises < 0.75 + 1e-6);
      CHECK(rises > 0.1);
    }
}
