// The bounds by energy on the peaks of a latched wing: the tests seek states that break them.
#include "core/mechanics/energy.hpp"
#include "core/peaks/base_peaks.hpp"
#include "tests/core/proofs/energy_bounded_wing.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace wingspread;
using oracle::LatchedWing;

namespace {

using PeakShares = LatchedWing<>::Shares;

/// Climbs from random states towards the largest share of the bounds.
template <BaseMotion M>
PeakShares sought(LatchedWing<M>& wing, double energy, oracle::Draws& draws, int starts,
                  double t = 0) {
  PeakShares worst;
  for (const bool forces : {false, true})
    for (int start = 0; start < starts; ++start) {
      State<double> way(wing.at.size());
      for (double& v : way) v = draws.uniform(-1, 1) * draws.log_uniform(1e-3, 1);
      const auto value = [&](const State<double>& at) {
        const auto s = wing.shares(at, energy, t);
        worst.moment = std::max(worst.moment, s.moment);
        worst.force = std::max(worst.force, s.force);
        return forces ? s.force : s.moment;
      };
      double best = value(way), step = 1;
      for (int pass = 0; pass < 150; ++pass) {
        State<double> next = way;
        double largest = 0;
        for (const double v : way) largest = std::max(largest, std::abs(v));
        for (double& v : next)
          v += step * draws.uniform(-1, 1) * draws.log_uniform(1e-4, 1) * largest;
        const double there = value(next);
        if (there > best)
          best = there, way = next;
        else
          step = std::max(0.9 * step, 1e-3);
      }
    }
  return worst;
}

} // namespace

TEST_CASE(
    "no state with the energy breaks the bounds on peaks, and some come near: the seed wing") {
  LatchedWing<> wing(oracle::seed_scene());
  oracle::Draws draws(1);
  for (const double energy : {1e-6, 1e-3, 0.03, 1.0, 30.0}) {
    const PeakShares worst = sought(wing, energy, draws, 6);
    CAPTURE(energy, worst.moment, worst.force);
    CHECK(worst.moment <= 1);
    CHECK(worst.force <= 1);
    CHECK(worst.moment > 0.02);
    CHECK(worst.force > 0.02);
  }
}

TEST_CASE("no state with the energy breaks the bounds on peaks: random wings") {
  oracle::Draws draws(2);
  for (int k = 0; k < 40; ++k) {
    oracle::RandomScene options;
    options.bodies = 1 + k % 6;
    options.branching = k % 2 == 0;
    options.motion = BaseMotion::fixed;
    options.mass_lower = 0.1, options.mass_upper = 30;
    Scene scene = oracle::random_scene(900 + k, options);
    for (Hinge& hinge : scene.hinges) {
      hinge.latch = Latch{draws.log_uniform(1e3, 1e6), draws.log_uniform(1, 1e3)};
      if (k % 3 == 0) hinge.friction.coulomb = draws.uniform(0, 0.5);
    }
    LatchedWing<> wing(scene);
    const double energy = draws.log_uniform(1e-6, 1);
    const PeakShares worst = sought(wing, energy, draws, 2);
    CAPTURE(k, energy, worst.moment, worst.force);
    CHECK(worst.moment <= 1);
    CHECK(worst.force <= 1);
  }
}

TEST_CASE("bounds made while hinges stick hold once they slip") {
  for (const double damping : {100., 1000.}) {
    Scene scene = oracle::seed_scene();
    for (Hinge& hinge : scene.hinges) {
      hinge.latch->damping = damping;
      oracle::rub(hinge, 0.01);
    }
    for (const auto& stuck :
         {std::vector{1}, std::vector{2}, std::vector{3}, std::vector{1, 2, 3}}) {
      LatchedWing<> wing(scene, stuck);
      oracle::Draws draws(3);
      const PeakShares worst = sought(wing, 1e-3, draws, 6);
      CAPTURE(damping, stuck.front(), stuck.size(), worst.moment, worst.force);
      CHECK(worst.moment <= 1);
      CHECK(worst.force <= 1);
      CHECK(worst.moment > 0.01); // states were found that come near enough to be told from none
    }
  }
}

TEST_CASE("friction of either model may be seen where no energy is left") {
  for (const int panels : {3, 30})
    for (const FrictionModel model : {FrictionModel::regularized, FrictionModel::exact}) {
      oracle::RandomScene options;
      options.bodies = panels;
      options.motion = BaseMotion::fixed;
      Scene scene = oracle::random_scene(40, options);
      for (Hinge& hinge : scene.hinges) {
        hinge.latch = Latch{1e4, 10};
        hinge.friction = {};
        hinge.friction.coulomb = 0.7, hinge.friction.model = model;
      }
      LatchedWing<> wing(scene);
      wing.bounds.bound(wing.system, wing.remaining, {0, 0});
      for (int i = 1; i <= panels; ++i) CHECK(wing.bounds.moment[i] == Approx(0.7).epsilon(1e-8));
    }
}

namespace {

/// The seed wing on a base that turns at `rate` or is pushed.
Scene carried_seed(double rate, double push) {
  Scene scene = oracle::seed_scene();
  scene.base.motion = BaseMotion::prescribed;
  scene.base.angle = 0.3, scene.base.rate = rate;
  scene.base.acceleration = {push * std::cos(0.7), push * std::sin(0.7)};
  return scene;
}

} // namespace

TEST_CASE("no state with the energy breaks the bounds on peaks: bases that turn or are pushed") {
  oracle::Draws draws(4);
  for (const auto& [rate, push] : {std::pair{0., 0.02}, {0., 1.}, {0.035, 0.}, {0.5, 0.}}) {
    LatchedWing<BaseMotion::prescribed> wing(carried_seed(rate, push));
    const double least = wing.energy(wing.rest, 2);
    for (const double more : {1e-5, 1e-3, 0.03, 1.0}) {
      const PeakShares worst = sought(wing, least + more, draws, 4, 2);
      CAPTURE(rate, push, least, more, worst.moment, worst.force);
      CHECK(worst.moment <= 1);
      CHECK(worst.force <= 1);
      if (least > 0.1 * more) continue; // what the base does is no small part of it
      CHECK(worst.moment > 0.3);
      if (more < 0.01) CHECK(worst.force > 0.04); // reactions at any angles: twenty times too large
    }
  }
}

TEST_CASE("no state with the energy breaks the bounds on peaks: hinges without latches") {
  oracle::Draws draws(5);
  for (const int without : {0, 1, 2}) {
    Scene scene = oracle::seed_scene(); // its springs weaken on the way: they pull towards a rest
    scene.hinges[without].latch.reset();
    LatchedWing<> wing(scene);
    for (const double energy : {1e-4, 0.1, 2.0}) {
      const PeakShares worst = sought(wing, energy, draws, 4);
      CAPTURE(without, energy, worst.moment, worst.force);
      CHECK(worst.moment <= 1);
      CHECK(worst.force <= 1);
      CHECK(worst.moment > 0.3);
    }
  }
}

TEST_CASE("of a free base that turns, the energy of the whole's turning loads no hinge") {
  oracle::Draws draws(7);
  int far_below = 0;
  for (int k = 0; k < 60; ++k) {
    oracle::RandomScene options;
    options.bodies = 1 + k % 6;
    options.branching = k % 2 == 0;
    options.motion = BaseMotion::free;
    options.mass_lower = 0.1, options.mass_upper = 30;
    Scene scene = oracle::random_scene(700 + k, options);
    for (Hinge& hinge : scene.hinges)
      hinge.latch = Latch{draws.log_uniform(1e3, 1e6), draws.log_uniform(1, 1e3)};
    LatchedWing<BaseMotion::free> wing(scene);
    const double turning = draws.log_uniform(0.01, 10); // rad/s
    for (int state = 0; state < 20; ++state) {
      State<double> x = wing.rest;
      const double size = draws.log_uniform(1e-4, 1);
      for (int i = 1; i <= wing.at.bodies; ++i) {
        x[wing.at.angle(i)] += size * draws.uniform(-1, 1);
        x[wing.at.rate(i)] = size * draws.uniform(-1, 1) * turning;
      }
      x[BaseExcursion<double>::coordinate + wing.at.freedoms()] = turning;
      const auto left = wing.remaining.energy(wing.system, x, 0.).value();
      const TotalMotion<double> now = total_motion(wing.system, x, 0.);
      const double spin = now.spin(), inertia = now.central_inertia();
      CAPTURE(k, turning, size, left.whole, left.within, left.whirl);
      // T' moves the hinges; ½H²/I turns the whole
      CHECK(left.within >= now.central_kinetic() - spin * spin / (2 * inertia));
      CHECK(left.whirl >= std::abs(spin) / inertia);
      wing.bounds.bound(wing.system, wing.remaining, left);
      const auto worst = wing.taken(x, 0);
      CHECK(worst.moment <= 1);
      CHECK(worst.force <= 1);
      far_below += left.within < 0.5 * left.whole ? 1 : 0;
    }
  }
  CHECK(far_below > 100); // of 1200
}

TEST_CASE("two stretched wings in line have the largest inertia that they can have") {
  Scene scene = oracle::two_wing_free_spacecraft();
  for (Hinge& hinge : scene.hinges) {
    hinge.parent_point.y() = hinge.child_point.y() = 0;
    hinge.latch = Latch{1e4, 100};
    hinge.spring = {}, hinge.harness = {}, hinge.friction = {};
  }
  LatchedWing<BaseMotion::free> wing(scene);
  State<double> x = wing.rest;
  x[BaseExcursion<double>::coordinate + wing.at.freedoms()] = 0.5;
  const auto left = wing.remaining.energy(wing.system, x, 0.).value();
  CHECK(left.whole > 10);
  CHECK(left.within <= 2e-9 * left.whole);
  CHECK(left.whirl == Approx(0.5));
}

TEST_CASE(
    "the largest inertia that a wing with held hinges can have is no less than any that it has, "
    "and that one where every hinge is held") {
  int partly = 0, rigid = 0;
  for (int k = 0; k < 120; ++k) {
    oracle::Draws draws(900 + k);
    oracle::RandomScene options;
    options.bodies = 1 + k % 5, options.branching = k % 2 == 0, options.motion = BaseMotion::free;
    Scene scene = oracle::random_scene(900 + k, options);
    const bool all = k % 3 == 0;
    for (Hinge& hinge : scene.hinges) {
      hinge.latch = Latch{1e4, 100};
      hinge.spring = {}, hinge.harness = {}, hinge.friction = {}, hinge.initial_rate = 0;
      if (all || draws.chance(0.5)) hinge.release = Release{.time = 1e3};
    }
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::free> system(wing, std::nullopt, work);
    State<double> x;
    system.start(x);
    const Layout& at = system.layout();
    int held = 0;
    for (int i = 1; i <= at.bodies; ++i) {
      if (scene.hinges[wing.hinge_of[i]].release)
        system.set_contact(i, Contact::held), ++held;
      else
        system.engage(i);
    }
    RemainingEnergy<double> remaining;
    remaining.prepare(system);
    for (int state = 0; state < 20; ++state) {
      for (int i = 1; i <= at.bodies; ++i) {
        x[at.rate(i)] = 0;
        if (!system.is_held(i))
          x[at.angle(i)] = remaining.rest()[at.angle(i)] + draws.uniform(-3, 3);
      }
      x[BaseExcursion<double>::coordinate + at.freedoms()] = 1;
      const auto left = remaining.energy(system, x, 0.);
      if (!left) continue;
      const TotalMotion<double> now = total_motion(system, x, 0.);
      const double largest = now.spin() * now.spin() / (2 * (left->whole - left->within));
      CAPTURE(k, held, at.bodies, largest, now.central_inertia());
      CHECK(largest >= now.central_inertia() * (1 - 1e-6));
      ++(held == at.bodies ? rigid : partly);
      if (held == at.bodies) CHECK(largest == Approx(now.central_inertia()).epsilon(1e-6));
    }
  }
  CHECK(std::min(partly, rigid) > 100);
}
