// What the spring of a hinge that cannot reach its latch exerts with the energy left, against the way walked in small steps.
#include "core/proofs/remaining_energy.hpp"
#include "tests/core/proofs/energy_bounded_wing.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

using namespace wingspread;
using oracle::LatchedWing;

namespace {

/// A panel before its latch, on a constant spring or one that falls and pulls back there.
Scene weak_panel(oracle::Draws& draws, bool falls) {
  oracle::RandomScene options;
  options.bodies = 1, options.friction = false;
  Scene scene = oracle::random_scene(1, options);
  Hinge& hinge = scene.hinges[0];
  hinge.latch = Latch{100, 1}, hinge.harness = {}, hinge.friction = {};
  hinge.stowed = 0, hinge.latched = draws.sign() * 3;
  const double torque = draws.log_uniform(0.01, 1);
  hinge.spring = {torque, falls ? -draws.log_uniform(0.01, 1) : torque};
  if (draws.uniform(0, 1) < 0.5) {
    hinge.friction.model = FrictionModel::exact;
    hinge.friction.coulomb = draws.log_uniform(1e-3, 0.3);
  }
  return scene;
}

/// The largest |spring moment| on the way that the energy lets the hinge go from `from` in this sense, N·m.
template <class System>
double most_on_way(System& system, double from, double sense, double latched, double friction,
                   double energy) {
  State<double> x(system.layout().size(), 0.0);
  double left = energy, most = 0;
  const double step = 1e-5;
  for (long k = 0; left >= 0; ++k) {
    x[0] = from + sense * step * static_cast<double>(k);
    if (std::abs(x[0]) > std::abs(latched) && x[0] * latched > 0) break;
    if (k > 4'000'000) return INFINITY;
    most = std::max(most, std::abs(system.moment(x, 1)));
    x[0] += 0.5 * sense * step; // of a linear moment the work is exact
    left += (sense * system.moment(x, 1) - friction) * step;
  }
  return most;
}

} // namespace

TEST_CASE(
    "the spring of a hinge that cannot reach its latch exerts no more than the energy lets it") {
  for (int trial = 0; trial < 60; ++trial) {
    oracle::Draws draws(4400 + trial);
    const Scene scene = weak_panel(draws, trial % 2 == 0);
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    State<double> x;
    system.start(x);
    x[0] = scene.hinges[0].latched * draws.uniform(-0.2, 0.8);
    x[1] = draws.uniform(-0.3, 0.3);
    RemainingEnergy<double> remaining;
    remaining.prepare(system);
    const auto left = remaining.energy(system, x, 0.0);
    CAPTURE(trial);
    REQUIRE(left);
    double most = 0;
    for (const double sense : {-1., 1.})
      most = std::max(most, most_on_way(system, x[0], sense, scene.hinges[0].latched,
                                        scene.hinges[0].friction.coulomb, left->within));
    CHECK(remaining.steady(1) >= most * (1 - 1e-9));
    CHECK(remaining.steady(1) <= most * (1 + 1e-3));
  }
}

TEST_CASE("there is no bound of the energy where it may take a hinge to a stop, on either side") {
  for (const bool far : {false, true})
    for (const double stowed : {0.02, -0.02}) { // the latch is at 0
      Scene scene = oracle::latching_panel();
      Hinge& hinge = scene.hinges[0];
      hinge.stowed = stowed, hinge.latched = 0;
      hinge.spring = {}, hinge.harness = {}, hinge.friction = {};
      Stop stop;
      stop.stiffness = 1e5, stop.gap = 0.01;
      (far ? hinge.far_stop : hinge.stop) = stop;
      const double way = far ? 0.01 : 0.03; // from rest to the stop
      Wing<double> wing = make_wing<double>(scene, outward_order(scene));
      set_parameters(wing, scene);
      Workspace<double> work;
      System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
      system.find_sides({0, 0}); // where it latches
      system.engage(1);
      for (const double prepared_at : {0., 1.01 * way, -1.01 * way}) { // on its stop or not
        system.find_sides({prepared_at, 0});
        RemainingEnergy<double> remaining;
        remaining.prepare(system);
        for (const double share : {-1.01, -0.99, 0.5, 0.99, 1.01}) { // either way: the hinge swings
          State<double> x{share * way, 0};
          system.find_sides(x);
          CAPTURE(far, stowed, prepared_at, share);
          const auto left = remaining.energy(system, x, 0.);
          CHECK(left.has_value() == (std::abs(share) < 1));
          if (left) CHECK(left->within == Approx(0.5 * hinge.latch->stiffness * x[0] * x[0]));
        }
      }
    }
}

namespace {

/// The moment of a spring by a table that is linear between its knots, and its integral from latched to y, y < 0 before the latch.
struct SteepTable {
  std::vector<double> ways, torques; ///< y ascending

  [[nodiscard]] double at(double y) const {
    if (y <= ways.front()) return torques.front();
    std::size_t k = 1;
    while (k + 1 < ways.size() && ways[k] < y) ++k;
    if (y >= ways.back()) return torques.back();
    return std::lerp(torques[k - 1], torques[k], (y - ways[k - 1]) / (ways[k] - ways[k - 1]));
  }
  /// By Simpson's rule in parts that are small beside the table's.
  [[nodiscard]] double work(double from, double to) const {
    constexpr int parts = 4000;
    double sum = 0;
    for (int k = 0; k < parts; ++k) {
      const double a = std::lerp(from, to, static_cast<double>(k) / parts),
                   b = std::lerp(from, to, (k + 1.0) / parts);
      sum += (b - a) / 6 * (at(a) + 4 * at((a + b) / 2) + at(b));
    }
    return sum;
  }
  /// The steepest rise between −r and r.
  [[nodiscard]] double steepest(double r) const {
    double most = -ways.front() < r ? 0 : -INFINITY; // it is level beyond its ends
    for (std::size_t k = 1; k < ways.size(); ++k)
      if (ways[k - 1] < r && ways[k] > -r)
        most = std::max(most, (torques[k] - torques[k - 1]) / (ways[k] - ways[k - 1]));
    return most;
  }
};

/// Latched at 0 with the stiffness 100; the table rises steeply at some distance before or beyond.
Scene detained_panel(const SteepTable& table, double sense) {
  Scene scene = oracle::latching_panel();
  Hinge& hinge = scene.hinges[0];
  hinge.stowed = -2 * sense, hinge.latched = 0;
  hinge.latch = Latch{100, 1}, hinge.harness = {}, hinge.friction = {};
  std::vector<double> angles;
  for (const double y : table.ways) angles.push_back(sense * y);
  hinge.spring = {};
  hinge.spring.table = oracle::torque_table(angles, table.torques, Interpolation::linear);
  return scene;
}

} // namespace

TEST_CASE(
    "the energy of a hinge with a table steeper than its latch is bounded just where it stays "
    "in the window that the table leaves") {
  int bounded = 0, windows = 0;
  for (int trial = 0; trial < 40; ++trial) {
    oracle::Draws draws(5200 + trial);
    const double sense = draws.sign(), place = draws.log_uniform(0.02, 1) * draws.sign();
    const double width = draws.log_uniform(0.1, 1) * 0.1 * std::abs(place),
                 drive = draws.uniform(0, 3);
    const double slope = draws.log_uniform(10, 1000);
    // outside of the steep part the torque falls a little, as a spring's may
    SteepTable table{{-1.9, place - width, place + width, 1.9},
                     {drive + 1, drive, drive + 2 * width * slope, drive}};
    const Scene scene = detained_panel(table, sense);
    oracle::LatchedWing<> wing(scene);
    double r = INFINITY;
    if (!(100 - table.steepest(INFINITY) > 0))
      for (r = 2; !(100 - 2 * table.steepest(r) > 0);) r /= 2;
    const double kappa = 100 - table.steepest(r);
    windows += std::isfinite(r);
    double rest = 0; // of P' = 100 y − table
    for (int pass = 0; pass < 2000; ++pass) rest += (table.at(rest) - 100 * rest) / 1000;
    const double most = std::isfinite(r) ? std::min(1.5 * r, 1.5) : 1;
    for (int k = -20; k <= 20; ++k) {
      const double y = most * k / 20 + 1e-7;
      const double energy = 50 * (y * y - rest * rest) - table.work(rest, y);
      const double furthest = std::sqrt(2 * std::max(energy, 0.0) / kappa);
      const double reach = std::abs(rest) + furthest;
      const bool stays = std::abs(y) <= r && reach < r;
      if (std::abs(reach / r - 1) < 1e-3 || std::abs(std::abs(y) / r - 1) < 1e-3) continue;
      State<double> x{sense * y, 0};
      const auto left = wing.remaining.energy(wing.system, x, 0.);
      CAPTURE(trial, place, width, slope, r, y, energy, rest, kappa, reach);
      CHECK(left.has_value() == stays);
      if (!left || !stays) continue;
      bounded += std::isfinite(r);
      CHECK(left->whole == Approx(energy).epsilon(1e-5).margin(1e-7));
      CHECK(wing.remaining.furthest(1, left->within) ==
            Approx(furthest).epsilon(1e-4).margin(1e-4));
    }
    CHECK(sense * wing.remaining.rest()[0] == Approx(rest).margin(1e-9));
  }
  CAPTURE(windows, bounded);
  CHECK((windows >= 10 && windows <= 30));
  CHECK(bounded > 100);
}

TEST_CASE("the energy bounds ways by each hinge's stiffness, but not on a base that is pushed and "
          "turns") {
  Scene scene = oracle::seed_scene();
  const LatchedWing<> fixed(scene);
  REQUIRE(fixed.remaining.least_stiffness());
  for (int i = 1; i <= 3; ++i) {
    const double latch = scene.hinges[fixed.wing.hinge_of[i]].latch->stiffness;
    CHECK(fixed.remaining.least_stiffness()[i - 1] == Approx(latch).epsilon(1e-2)); // and a spring
  }
  scene.base.mass = 100, scene.base.inertia = 30, scene.base.motion = BaseMotion::free;
  CHECK(LatchedWing<BaseMotion::free>(scene).remaining.least_stiffness());
  scene.base.motion = BaseMotion::prescribed, scene.base.rate = 0.1;
  using Driven = LatchedWing<BaseMotion::prescribed>;
  CHECK(Driven(scene).remaining.least_stiffness());
  scene.base.acceleration = {0.1, 0};
  CHECK_FALSE(Driven(scene).remaining.least_stiffness());
  scene.base.rate = 0;
  CHECK(Driven(scene).remaining.least_stiffness());
  scene.base.angular_acceleration = 0.1;
  CHECK_FALSE(Driven(scene).remaining.least_stiffness());
  scene.base.acceleration = {0, 0};
  Driven quickening(scene);
  CHECK(quickening.remaining.least_stiffness());
  CHECK_FALSE(quickening.remaining.energy(quickening.system, quickening.rest, 0.));
  CHECK(quickening.remaining.energy_so_far(quickening.system, quickening.rest, 0.));
}
