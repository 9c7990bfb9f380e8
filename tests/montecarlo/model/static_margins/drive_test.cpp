#include "montecarlo/model/static_margins/drive.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

using namespace wingspread;

namespace {

Hinge hinge_of(const char* name, int body, double travel, double torque, double friction) {
  Hinge hinge;
  hinge.name = name;
  hinge.child = body;
  hinge.stowed = travel;
  hinge.spring = {torque, torque};
  hinge.friction.coulomb = friction;
  return hinge;
}

Synchronisation loop_of(int first, int second, double ratio) {
  Synchronisation loop;
  loop.first = first, loop.second = second, loop.ratio = ratio;
  loop.stiffness = 100;
  return loop;
}

/// Three hinges, of which loops keep the second to twice the first, and the third to the second.
Scene looped() {
  Scene scene;
  scene.hinges = {hinge_of("root", 0, 1, 3, 0.5), hinge_of("mid", 1, 2, 0, 0.2),
                  hinge_of("tip", 2, 2, 0.5, 0.1)};
  for (Hinge& hinge : scene.hinges) hinge.latch = Latch{.stiffness = 1e4, .damping = 100};
  scene.synchronisations = {loop_of(0, 1, 2), loop_of(1, 2, 1)};
  return scene;
}

} // namespace

TEST_CASE("hinges without loops drive alone; those without spring, motor and latch not at all",
          "[motorization]") {
  Scene scene = looped();
  scene.synchronisations.clear();
  scene.hinges[1].latch.reset();
  const std::vector<HingeDrive> drives = drives_of(scene);
  REQUIRE(drives.size() == 2);
  CHECK(name_of(drives[0], scene) == "root");
  CHECK(name_of(drives[1], scene) == "tip");
  scene.hinges[1].motor = Motor{.rate = 0.1, .gain = 1, .torque_limit = 0.02};
  CHECK(drives_of(scene).size() == 3); // a motor alone is to be strong enough too
}

// For a radian of the root mid and tip turn two: T = 3 + 2·0 + 2·0.5, FR = 0.5 + 2·0.2 + 2·0.1 N·m.
TEST_CASE("hinges in loops have their margin together, each by its gear", "[motorization]") {
  const Scene scene = looped();
  const std::vector<HingeDrive> drives = drives_of(scene);
  REQUIRE(drives.size() == 1);
  CHECK(name_of(drives[0], scene) == "root+mid+tip");
  StaticMarginSpec spec = default_static_margins(scene);
  spec.torques[1].adhesion = 0.05; // at mid, twice as far from the root
  const TorqueTerms terms = terms_at(scene, drives[0], 0.3, spec);
  CHECK(terms.available == Approx(4).epsilon(1e-14));
  CHECK(terms.friction == Approx(1.1).epsilon(1e-14));
  CHECK(terms.adhesion == Approx(0.1).epsilon(1e-14));
  CHECK(least_margins(scene, drives[0], spec)[1] == Approx(4 / (3 * 1.2) - 1).epsilon(1e-13));
}

TEST_CASE("whichever of a loop leads, the margin is the same", "[motorization]") {
  Scene scene = looped();
  scene.hinges[1].spring = {0.4, -0.3}; // pulls back from 4/7 of its way on
  const StaticMarginSpec spec = default_static_margins(scene);
  const Margins forward = least_margins(scene, drives_of(scene).front(), spec);
  scene.synchronisations[0] = loop_of(1, 0, 0.5);
  const std::vector<HingeDrive> drives = drives_of(scene);
  REQUIRE(drives.size() == 1);
  CHECK(name_of(drives[0], scene) == "mid+root+tip");
  const Margins backward = least_margins(scene, drives[0], spec);
  for (std::size_t kind = 0; kind < forward.size(); ++kind)
    CHECK(backward[kind] == Approx(forward[kind]).epsilon(1e-12));
  // and against the direction in which the loops are given
  HingeDrive turned{{2, 1, 0}, {{0, 1, false}, {1, 0, true}}};
  const Margins from_tip = least_margins(scene, turned, spec);
  for (std::size_t kind = 0; kind < forward.size(); ++kind)
    CHECK(from_tip[kind] == Approx(forward[kind]).epsilon(1e-12));
}

// Principle of virtual work: the work of all springs over a small turn of the leader, by their potentials.
TEST_CASE("a drive's torque is the work of its hinges, whichever way its loops are given",
          "[motorization]") {
  Scene scene = looped();
  scene.hinges[0].stowed = 1.2, scene.hinges[1].stowed = 3, scene.hinges[2].stowed = -1.5;
  scene.hinges[0].spring = {3, 2}, scene.hinges[1].spring = {0.9, 0.4};
  scene.hinges[2].spring = {0.6, 0.5};
  constexpr std::array ratios{2.5, -0.4};
  const StaticMarginSpec spec = default_static_margins(scene);
  const auto work = [&](int hinge, double travel) { // of a torque that is linear in the travel
    const Hinge& own = scene.hinges[hinge];
    const double whole = std::abs(own.stowed),
                 change = own.spring.torque_latched - own.spring.torque_stowed;
    return own.spring.torque_stowed * travel + 0.5 * change * travel * travel / whole;
  };
  for (const bool first_backward : {false, true})
    for (const bool second_backward : {false, true}) {
      scene.synchronisations = {
          first_backward ? loop_of(1, 0, 1 / ratios[0]) : loop_of(0, 1, ratios[0]),
          second_backward ? loop_of(2, 1, 1 / ratios[1]) : loop_of(1, 2, ratios[1])};
      HingeDrive drive{{0, 1, 2}, {{0, 0, !first_backward}, {1, 1, !second_backward}}};
      const double travel = 0.3 * 1.2, step = 1e-4;
      const auto all =
          [&](double
                  own) { // the third turns backwards: it is at its stowed angle, with that torque
            return work(0, own) + work(1, ratios[0] * own) + ratios[1] * ratios[0] * own * 0.6;
          };
      const TorqueTerms terms = terms_at(scene, drive, 0.3, spec);
      CHECK(terms.available - terms.spring ==
            Approx((all(travel + step) - all(travel - step)) / (2 * step)).epsilon(1e-9));
      CHECK(terms.friction == Approx(0.5 + 2.5 * 0.2 + 0.1).epsilon(1e-14));
    }
}

TEST_CASE("a loop without stiffness ties nothing", "[motorization]") {
  Scene scene = looped();
  scene.synchronisations[0].stiffness = 0;
  const std::vector<HingeDrive> drives = drives_of(scene);
  REQUIRE(drives.size() == 2);
  CHECK(name_of(drives[0], scene) == "root");
  CHECK(name_of(drives[1], scene) == "mid+tip");
}

TEST_CASE("however soft a loop is, it ties its hinges, and the one that follows none leads",
          "[motorization]") {
  for (const double stiffness : {1e-9, 0.5, 1.0, 1e6}) {
    CAPTURE(stiffness);
    Scene scene = looped();
    scene.synchronisations = {loop_of(2, 0, 2), loop_of(0, 1, 1)};
    for (Synchronisation& loop : scene.synchronisations) loop.stiffness = stiffness;
    const std::vector<HingeDrive> drives = drives_of(scene);
    REQUIRE(drives.size() == 1);
    CHECK(name_of(drives[0], scene) == "tip+root+mid");
  }
  Scene scene = looped();
  scene.synchronisations = {loop_of(2, 0, 2), loop_of(0, 1, 1), loop_of(1, 2, 0.5)};
  scene.synchronisations[2].stiffness = 0; // without it, tip follows none
  CHECK(name_of(drives_of(scene).at(0), scene) == "tip+root+mid");
}

TEST_CASE("a hinge that a loop turns backwards resists by its spring", "[motorization]") {
  Scene scene = looped();
  scene.hinges.pop_back();
  scene.synchronisations.pop_back();
  scene.synchronisations[0].ratio = -1;
  scene.hinges[1].spring = {0.7, 0.7};
  const TorqueTerms terms =
      terms_at(scene, drives_of(scene).front(), 0.5, default_static_margins(scene));
  CHECK((terms.available == 3 && terms.spring == 0.7));
  CHECK(terms.friction == 0.7); // 0.5 and 0.2
}

TEST_CASE("a loop by a table has its gear from place to place, and its least is found",
          "[motorization]") {
  Scene scene = looped();
  scene.hinges.pop_back();
  scene.synchronisations.pop_back();
  Synchronisation& loop = scene.synchronisations[0];
  loop.table = std::make_shared<const Curve>(std::vector{0.0, 0.5, 1.0}, std::vector{0.0, 0.5, 2.0},
                                             Interpolation::linear, Beyond::straight);
  const StaticMarginSpec spec = default_static_margins(scene);
  const HingeDrive drive = drives_of(scene).front();
  CHECK(terms_at(scene, drive, 0.25, spec).friction == Approx(0.5 + 0.2).epsilon(1e-14));
  CHECK(terms_at(scene, drive, 0.75, spec).friction == Approx(0.5 + 3 * 0.2).epsilon(1e-14));
  const HingeDrive turned{{1, 0}, {{0, 0, false}}}; // led by the second
  CHECK(terms_at(scene, turned, 0.125, spec).friction == Approx(0.2 + 0.5).epsilon(1e-14));
  CHECK(terms_at(scene, turned, 0.75, spec).friction == Approx(0.2 + 0.5 / 3).epsilon(1e-14));
  Margins at{};
  const Margins least = least_margins(scene, drive, spec, &at);
  CHECK(least[1] == Approx(3 / (3 * 1.1) - 1).epsilon(1e-13));
  CHECK(at[1] >= 0.5);
  const std::vector<double> places = places_of_least(scene, drive);
  CHECK(std::ranges::count(places, 0.5) >= 1); // where the gear changes
}

TEST_CASE("each hinge of a loop is looked at where its own torques turn", "[motorization]") {
  Scene scene = looped();
  scene.hinges[2].spring = {0.5, -0.5}; // turns at half its way, as far as the root's
  const std::vector<double> points = turning_points(scene, drives_of(scene).front());
  CHECK(std::ranges::any_of(points, [](double x) { return std::abs(x - 0.5) < 1e-12; }));
  CHECK((points.front() == 0 && points.back() == 1));
}

namespace {

/// Four hinges of 1 N·m with friction 0.1 N·m, in a chain of loops with the ratios 2, 1 and 1: gears 1, 2, 2 and 2.
Scene chain_of_four() {
  Scene scene;
  for (int k = 0; k < 4; ++k)
    scene.hinges.push_back(hinge_of(std::array{"a", "b", "c", "d"}[k], k, k == 0 ? 1 : 2, 1, 0.1));
  scene.synchronisations = {loop_of(0, 1, 2), loop_of(1, 2, 1), loop_of(2, 3, 1)};
  return scene;
}

double one_spring_out(const Scene& scene) {
  return least_margins(scene, drives_of(scene).at(0), default_static_margins(scene))[2];
}

} // namespace

// T = 1 + 2 + 2 + 2 = 7 N·m against 0.7 N·m. One of two springs of a takes 0.5 N·m, one of b, c or d takes 1 N·m.
TEST_CASE("one spring out of a loop: the one spring whose loss costs most", "[motorization]") {
  Scene scene = chain_of_four();
  CHECK(one_spring_out(scene) == Approx(6 / 0.7 - 1).epsilon(1e-13));
  scene.hinges[0].spring = {6, 6}; // T = 12, of which a's spring takes 3
  CHECK(one_spring_out(scene) == Approx(9 / 0.7 - 1).epsilon(1e-13));
  StaticMarginSpec spec = default_static_margins(scene);
  spec.springs_per_hinge = 3;
  CHECK(least_margins(scene, drives_of(scene).at(0), spec)[2] ==
        Approx(10 / 0.7 - 1).epsilon(1e-13));
}

// The same number another way: scale each hinge's spring in turn and take the least margin without a loss.
TEST_CASE("one spring out is the least over all wings with one spring less", "[motorization]") {
  Scene scene = chain_of_four();
  scene.hinges[0].spring = {3, 0.5};
  scene.hinges[1].spring = {0.2, 1.4};
  scene.hinges[2].spring = {0.6, -0.3}; // pulls back on the last third
  scene.hinges[3].motor = Motor{.rate = 1, .gain = 10, .torque_limit = 0.4};
  StaticMarginSpec spec = default_static_margins(scene);
  spec.nasa = nasa_one_spring_out();
  double least = std::numeric_limits<double>::infinity();
  for (int lost = 0; lost < 4; ++lost) {
    Scene weaker = scene;
    weaker.hinges[lost].spring.scale = 0.5;
    least = std::min(least, least_margins(weaker, drives_of(weaker).at(0), spec)[1]);
  }
  CHECK(one_spring_out(scene) == Approx(least).epsilon(1e-12));
}

TEST_CASE("one spring out leaves motors whole, and does not apply without a spring",
          "[motorization]") {
  Scene scene;
  scene.hinges = {hinge_of("root", 0, 1, 2, 0.5)};
  scene.hinges[0].motor = Motor{.rate = 1, .gain = 10, .torque_limit = 3};
  CHECK(one_spring_out(scene) == Approx((3 + 1) / 0.5 - 1).epsilon(1e-13));
  scene.hinges[0].latch = Latch{.stiffness = 1e4, .damping = 100};
  const HingeDrive drive = drives_of(scene).at(0);
  CHECK(applies(MarginKind::nasa_one_spring_out, scene, drive));
  scene.hinges[0].spring = {};
  CHECK_FALSE(applies(MarginKind::nasa_one_spring_out, scene, drive));
  CHECK(applies(MarginKind::nasa, scene, drive));
}

namespace {

HingeTorque tabled(std::vector<double> angle, std::vector<double> torque) {
  HingeTorque by_table;
  by_table.table = std::make_shared<const TorqueTable>(std::move(angle), std::move(torque),
                                                       Interpolation::monotone);
  return by_table;
}

/// The least margins at 100,000 places of the travel.
Margins least_seen(const Scene& scene, const HingeDrive& drive, const StaticMarginSpec& spec) {
  Margins least;
  least.fill(std::numeric_limits<double>::infinity());
  constexpr int cells = 100'000;
  for (int k = 0; k <= cells; ++k) {
    const Margins here = margins_at(scene, drive, k / static_cast<double>(cells), spec);
    for (std::size_t kind = 0; kind < least.size(); ++kind)
      least[kind] = std::min(least[kind], here[kind]);
  }
  return least;
}

} // namespace

// Within the last eighth of a piece the spring has left its least and the harness begins to rise: NASA's margin is
// −0.058 there, and 0.005 or more at all ends of eighths.
TEST_CASE("a margin that is least between eighths of a table's piece is found", "[motorization]") {
  Scene scene;
  scene.hinges = {hinge_of("root", 0, 1, 0, 0.02)};
  scene.hinges[0].latch = Latch{.stiffness = 1e4, .damping = 100};
  scene.hinges[0].spring = tabled({1, 0.16549, 0}, {3.050926, 0.508527, 10.680029});
  scene.hinges[0].harness =
      tabled({1, 0.86189, 0.222905, 0}, {0.17548, 0.056278, 0.053638, 0.977569});
  const StaticMarginSpec spec = default_static_margins(scene);
  const HingeDrive drive = drives_of(scene).front();
  Margins at{};
  const Margins least = least_margins(scene, drive, spec, &at);
  const auto nasa = static_cast<std::size_t>(MarginKind::nasa);
  // of 2,000,001 places, by SciPy's PchipInterpolator
  CHECK(least[nasa] == Approx(-0.0579703609).epsilon(1e-8));
  CHECK(at[nasa] == Approx(0.8418).margin(1e-3));
  CHECK(margins_at(scene, drive, at[nasa], spec)[nasa] == least[nasa]); // attained
}

TEST_CASE("no place of tables has a smaller margin than the least one", "[motorization]") {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> angle(0, 1), logarithm(-6, 1);
  const auto table = [&] {
    std::vector<double> angles{1, angle(random), angle(random), 0}, torques;
    std::ranges::sort(angles, std::ranges::greater{});
    for (std::size_t k = 0; k < angles.size(); ++k) torques.push_back(std::exp(logarithm(random)));
    return tabled(angles, torques);
  };
  for (int trial = 0; trial < 40; ++trial) {
    Scene scene;
    scene.hinges = {hinge_of("root", 0, 1, 0, 0.02), hinge_of("mid", 1, 2, 0, 0.01)};
    for (Hinge& hinge : scene.hinges) {
      hinge.latch = Latch{.stiffness = 1e4, .damping = 100};
      hinge.spring = tabled({hinge.stowed, 0.3, 0}, {1, 0.1, 0.5});
    }
    scene.hinges[0].spring = table(), scene.hinges[0].harness = table();
    if (trial % 2 == 0) scene.synchronisations = {loop_of(0, 1, 2)};
    const StaticMarginSpec spec = default_static_margins(scene);
    const HingeDrive drive = drives_of(scene).front();
    const Margins least = least_margins(scene, drive, spec), seen = least_seen(scene, drive, spec);
    for (std::size_t kind = 0; kind < least.size(); ++kind) {
      if (static_cast<MarginKind>(kind) == MarginKind::nasa_one_spring_out && trial % 2 == 0)
        continue; // has a kink
      CHECK(least[kind] <= seen[kind] + 1e-9 * std::abs(1 + seen[kind]));
      CHECK(least[kind] >=
            seen[kind] - 1e-3 * std::abs(1 + seen[kind])); // it is attained, between those places
    }
  }
}

// The command turns back between two knots: beyond its longest way the motor only brakes, and the spring still rises.
TEST_CASE("the least margin lies where a motor's command turns back", "[motorization]") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0.05, 0.95);
  for (const auto interpolation : {Interpolation::linear, Interpolation::monotone})
    for (int trial = 0; trial < 10; ++trial) {
      Scene scene;
      scene.hinges = {hinge_of("root", 0, 1.5, 0, 0.02)};
      Hinge& root = scene.hinges[0];
      root.latch = Latch{.stiffness = 1e4, .damping = 100};
      root.spring = {0.5, 0.5 + 10 * unit(random)};
      const std::vector<double> time{0, 3, 3 + 2 * unit(random), 9},
          rates{0.2 * unit(random), 0.2 * unit(random), -0.2 * unit(random), -0.1};
      root.motor = Motor{.gain = 10, .torque_limit = 1};
      root.motor->table = std::make_shared<Curve>(time, rates, interpolation);
      root.motor->time = time, root.motor->rates = rates;
      const StaticMarginSpec spec = default_static_margins(scene);
      const HingeDrive drive = drives_of(scene).front();
      const Margins least = least_margins(scene, drive, spec),
                    seen = least_seen(scene, drive, spec);
      for (std::size_t kind = 0; kind < least.size(); ++kind) {
        CHECK(least[kind] <= seen[kind] + 1e-9 * std::abs(1 + seen[kind]));
        CHECK(least[kind] >= seen[kind] - 1e-3 * std::abs(1 + seen[kind]));
      }
    }
}
