// The bound on what hinge forces do inside a step, against forces found from positions alone.
#include "core/mechanics/system.hpp"
#include "core/peaks/reaction_bound.hpp"
#include "tests/core/dense/any_motion.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <vector>

using namespace wingspread;

namespace {

using oracle::AnyMotion;

template <BaseMotion M> ReactionBound<double> bound_of(const AnyMotion<M>& motion) {
  std::vector<Lever<double>> levers;
  set_levers(motion.wing, motion.wing.tree, levers);
  ReactionBound<double> bound;
  bound.resize(motion.wing.size());
  bound.over_step(motion.system, levers, motion.step);
  return bound;
}

template <BaseMotion M> void check_random_wings() {
  const double most = oracle::most_taken_by_random_wings<M>(
      {300, 700, 40}, [](const AnyMotion<M>& motion, double s) { return motion.forces(s); },
      bound_of<M>);
  CHECK(most > 0.1); // it is no ten times too large everywhere
}

} // namespace

// The first moment about a hinge: of its own body, and of each body further out at the hinge by which it hangs there.
TEST_CASE("a lever's mass and first moment are those of all that is outward of its hinge") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    oracle::RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 7), options.branching = seed % 2 == 0;
    const Scene scene = oracle::random_scene(500 + seed, options);
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    std::vector<Lever<double>> levers;
    set_levers(wing, wing.tree, levers);
    for (int i = 1; i <= wing.size(); ++i) {
      double mass = 0;
      Vec2<double> moment{0, 0};
      for (int k = i; k <= wing.size(); ++k) {
        Vec2<double> place = wing.bodies[k].center;
        int on = k;
        for (; on > i; on = wing.tree.parent_of(on)) place = wing.bodies[on].arm;
        if (on != i) continue;
        mass += wing.bodies[k].mass, moment = fused(wing.bodies[k].mass, place, moment);
      }
      CAPTURE(seed, i);
      CHECK(levers[i].mass == Approx(mass));
      CHECK(levers[i].sigma.x == Approx(moment.x).margin(1e-12));
      CHECK(levers[i].sigma.y == Approx(moment.y).margin(1e-12));
      CHECK(levers[i].moment == Approx(std::hypot(moment.x, moment.y)));
      CHECK(levers[i].arm == Approx(std::hypot(wing.bodies[i].arm.x, wing.bodies[i].arm.y)));
    }
  }
}

TEST_CASE("a hinge force rises no more inside a step than the bound says: fixed base") {
  check_random_wings<BaseMotion::fixed>();
}
TEST_CASE("a hinge force rises no more inside a step than the bound says: prescribed base") {
  check_random_wings<BaseMotion::prescribed>();
}
TEST_CASE("a hinge force rises no more inside a step than the bound says: free base") {
  check_random_wings<BaseMotion::free>();
}

TEST_CASE(
    "the bound on a hinge force is attained by a swing of half a period, and by none longer") {
  // a panel swings by 1e-3 rad about where the step's middle finds it: only its acceleration counts
  AnyMotion<BaseMotion::fixed> motion(oracle::harmonic_panel(), 1, 1, 0);
  for (const double turns : {0.25, 0.5, 0.75, 0.95}) {
    const double half = std::numbers::pi * turns, w = 2 * half, size = 1e-3;
    motion.step.x = {size * std::cos(half), size * w * std::sin(half)};
    motion.step.x1 = {size * std::cos(half), -size * w * std::sin(half)};
    motion.step.dxdt = {motion.step.x[1], -w * w * motion.step.x[0]};
    motion.step.dxdt1 = {motion.step.x1[1], -w * w * motion.step.x1[0]};
    const ReactionBound<double> bound = bound_of(motion);
    const BodyTerms<double>& body = motion.wing.bodies[1];
    const double lever = body.mass * std::hypot(body.center.x, body.center.y) * size * w * w; // N
    CAPTURE(turns);
    CHECK(lever - lever * std::abs(std::cos(half)) < bound.rise(1));
    CHECK(1.1 * (lever + lever) > bound.rise(1));
  }
}
