// The bounds by energy on the peaks of a latched wing: the tests seek states that break them.
#include "core/mechanics/energy.hpp"
#include "core/peaks/base_peaks.hpp"
#include "core/proofs/energy_bounds.hpp"
#include "core/proofs/remaining_energy.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

/// A wing with all latches engaged that it has.
template <BaseMotion M = BaseMotion::fixed> struct LatchedWing {
  /// @param stuck hinges that stick when the bounds are prepared, and slip afterwards
  explicit LatchedWing(const Scene& scene, const std::vector<int>& stuck = {})
      : wing(with_numbers(scene)), system(wing, std::nullopt, work), at(system.layout()) {
    for (int i = 1; i <= at.bodies; ++i)
      if (wing.hinges[i].has_latch) system.engage(i);
    for (const int i : stuck) system.set_contact(i, Contact::stuck);
    remaining.prepare(system);
    bounds.prepare(system);
    for (const int i : stuck) system.set_contact(i, Contact::none);
    rest = remaining.rest();
    system.want_forces(true);
  }

  /// What no energy exceeds from this state on, at its own time.
  [[nodiscard]] double energy(const State<double>& x, double t) {
    return remaining.energy(system, x, t, t).value().whole;
  }

  /// Largest share of its bound that any moment or force takes at the state rest + s·way, s such
  /// that the state has the energy.
  struct Shares {
    double moment = 0, force = 0;
  };
  Shares shares(const State<double>& way, double energy_given, double t = 0) {
    State<double> x;
    double low = 0, high = 1;
    const auto put = [&](double s) {
      x = rest;
      for (int k = 0; k < at.size(); ++k) x[k] += s * way[k];
      return energy(x, t);
    };
    while (put(high) < energy_given) high *= 2;
    for (int pass = 0; pass < 60; ++pass)
      (put((low + high) / 2) < energy_given ? low : high) = (low + high) / 2;
    put(low);
    const double given = energy_given * (1 + 1e-9);
    bounds.bound(system, remaining, {given, given});
    return taken(x, t);
  }

  /// Of the bounds as they were made last.
  Shares taken(const State<double>& x, double t) {
    State<double> dxdt(at.size());
    system(x, dxdt, t);
    Shares worst;
    for (int i = 1; i <= at.bodies; ++i) {
      const Vec2<double>& f = system.work().forces[i];
      worst.moment = std::max(worst.moment, std::abs(system.moment(x, i)) / bounds.moment[i]);
      worst.force = std::max(worst.force, std::sqrt(dot(f, f)) / bounds.force[i]);
    }
    return worst;
  }

  Wing<double> wing;
  Workspace<double> work;
  System<double, Tree, M> system;
  Layout at;
  RemainingEnergy<double> remaining;
  EnergyBounds<double> bounds;
  State<double> rest;

private:
  static Wing<double> with_numbers(const Scene& scene) {
    Wing<double> made = make_wing<double>(scene, outward_order(scene));
    set_parameters(made, scene);
    return made;
  }
};
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

/// The seed wing on a base that turns at `rate` and is pushed.
Scene carried_seed(double rate, double push) {
  Scene scene = oracle::seed_scene();
  scene.base.motion = BaseMotion::prescribed;
  scene.base.angle = 0.3, scene.base.rate = rate;
  scene.base.acceleration = {push * std::cos(0.7), push * std::sin(0.7)};
  return scene;
}

} // namespace

TEST_CASE("no state with the energy breaks the bounds on peaks: bases that turn and are pushed") {
  oracle::Draws draws(4);
  for (const auto& [rate, push] :
       {std::pair{0., 0.02}, {0., 1.}, {0.035, 0.}, {0.5, 0.}, {0.035, 0.02}, {-0.3, 0.2}}) {
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

// ---- the formulas, by hand

namespace {

/// Two panels in a line, l from hinge to hinge.
Scene two_in_line(double l, double c1, double c2) {
  Scene scene = oracle::latching_panel();
  scene.bodies = {{"inner", 10, 0.5}, {"outer", 4, 0.2}};
  Hinge& root = scene.hinges[0];
  root.spring = {0, 0}, root.child_point = {-c1, 0}, root.latch = Latch{1e4, 10};
  Hinge mid = root;
  mid.name = "mid", mid.parent = 0, mid.child = 1;
  mid.parent_point = {l - c1, 0}, mid.child_point = {-c2, 0}, mid.latch = Latch{6e3, 20};
  scene.hinges.push_back(mid);
  return scene;
}

} // namespace

TEST_CASE("the bounds by energy are (2) to (4)") {
  const double l = 1.5, c1 = 0.7, c2 = 0.4, J1 = 0.5, J2 = 0.2;
  LatchedWing<> wing(two_in_line(l, c1, c2));
  const double E = 100;
  wing.bounds.bound(wing.system, wing.remaining, {E, E});
  const double M1 = std::sqrt(2 * E * (1e4 + 10 * 10 / J1));
  const double M2 = std::sqrt(2 * E * (6e3 + 20 * 20 * (1 / J1 + 1 / J2)));
  CHECK(wing.bounds.moment[1] == Approx(M1));
  CHECK(wing.bounds.moment[2] == Approx(M2));
  const double w1 = 2 * E / J1, w2 = 2 * E / J2; // bounds of ω²
  const double g1 = w1 * c1, g2 = w1 * l + w2 * c2;
  const double Z = 10 * g1 * g1 + 4 * g2 * g2 + (M1 + M2) * (M1 + M2) / J1 + M2 * M2 / J2;
  CHECK(wing.bounds.force[1] == Approx(std::sqrt(14 * Z)));
  CHECK(wing.bounds.force[2] == Approx(std::sqrt(4 * Z)));
}

TEST_CASE("the bound on what holds a hinge rigidly is (5), whichever hinge is held") {
  const double l = 1.5, c1 = 0.7, c2 = 0.4, J1 = 0.5, J2 = 0.2, E = 3;
  for (const int held : {1, 2}) {
    Scene scene = two_in_line(l, c1, c2);
    scene.hinges[held - 1].release = Release{.fails = 1};
    LatchedWing<> wing(scene);
    wing.system.set_contact(held, Contact::held);
    wing.remaining.prepare(wing.system), wing.bounds.prepare(wing.system);
    wing.bounds.bound(wing.system, wing.remaining, {E, E});
    const double w1 = held == 1 ? 0 : 2 * E / J1, w2 = 2 * E / J2; // of ω²
    const double M1 = held == 1 ? 0 : std::sqrt(2 * E * (1e4 + 10 * 10 / J1));
    const double M2 = held == 2 ? 0 : std::sqrt(2 * E * (6e3 + 20 * 20 * (1 / J1 + 1 / J2)));
    const double g1 = w1 * c1, g2 = w1 * l + w2 * c2, L1 = M1 + M2;
    const double turns1 = held == 1 ? 0 : L1 * L1 / J1; // a body that stands still takes none
    const double Z = 10 * g1 * g1 + 4 * g2 * g2 + turns1 + M2 * M2 / J2;
    const double levers = held == 1 ? 10 * c1 * c1 + 4 * (l + c2) * (l + c2) : 4 * c2 * c2;
    const double inertias = held == 1 ? J1 + J2 : J2, loads = held == 1 ? L1 + M2 : M2;
    const double most = (std::sqrt(levers) + std::sqrt(inertias)) * std::sqrt(Z) + loads;
    CAPTURE(held);
    CHECK(wing.bounds.moment[held] == Approx(most));
    CHECK(wing.bounds.moment[3 - held] == Approx(M1 + M2));
    CHECK(wing.bounds.force[1] == Approx(std::sqrt(14 * Z)));
    CHECK(wing.bounds.force[2] == Approx(std::sqrt(4 * Z)));
  }
}

TEST_CASE("dampers, motors, loops and dissipating latches add their most to the bounds by energy") {
  const double J1 = 0.5, J2 = 0.2, E = 7, gear = 3, K = 50, D = 4, c = 2;
  Scene scene = two_in_line(1.5, 0.7, 0.4);
  Damper damper;
  damper.coefficient = c, damper.scale = 1.5;
  scene.hinges[0].damper = damper;
  Synchronisation cable;
  cable.name = "loop", cable.first = 0, cable.second = 1, cable.ratio = gear;
  cable.stiffness = K, cable.damping = D;
  scene.synchronisations = {cable};
  const double v1 = std::sqrt(2 * E / J1), v2 = std::sqrt(2 * E * (1 / J1 + 1 / J2)); // (2)
  const double M1 = std::sqrt(2 * E * (1e4 + 10 * 10 / J1)) + 1.5 * c * v1;
  const double M2 = std::sqrt(2 * E * (6e3 + 20 * 20 * (1 / J1 + 1 / J2)));
  const double loop = std::sqrt(2 * K * E) + D * (gear * v1 + v2);
  for (const double limit : {1e9, 3.}) {
    scene.hinges[1].motor = Motor{.rate = 0, .gain = 0.8, .torque_limit = limit};
    LatchedWing<> wing(scene);
    wing.bounds.bound(wing.system, wing.remaining, {E, E});
    CAPTURE(limit);
    CHECK(wing.bounds.moment[1] == Approx(M1 + gear * loop));
    CHECK(wing.bounds.moment[2] == Approx(M2 + loop + std::min(0.8 * v2, limit)));
  }
  scene = two_in_line(1.5, 0.7, 0.4);
  scene.hinges[1].latch = Latch{.stiffness = 6e3, .dissipation = 0.4};
  LatchedWing<> wing(scene);
  wing.bounds.bound(wing.system, wing.remaining, {E, E});
  const double way = std::sqrt(2 * E / 6e3);
  CHECK(wing.bounds.moment[2] == Approx(6e3 * way * (1 + 0.4 * v2)));
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
      const auto left = wing.remaining.energy(wing.system, x, 0., 0.).value();
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
  const auto left = wing.remaining.energy(wing.system, x, 0., 0.).value();
  CHECK(left.whole > 10);
  CHECK(left.within <= 2e-9 * left.whole);
  CHECK(left.whirl == Approx(0.5));
}
