#include "core/scene/torque.hpp"
#include "montecarlo/model/static_margins/hinge_terms.hpp"
#include "montecarlo/model/static_margins/static_margin.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace wingspread;

namespace {

/// A hinge with these torques at its ends.
Hinge hinge_with(const HingeTorque& spring, const HingeTorque& harness, double coulomb) {
  Hinge hinge;
  hinge.stowed = 1.5;
  hinge.spring = spring;
  hinge.harness = harness;
  hinge.friction.coulomb = coulomb;
  return hinge;
}

} // namespace

TEST_CASE("a motor counts with its torque at rest", "[motorization]") {
  Hinge hinge = hinge_with({2, 1}, {0, 0}, 0);
  hinge.motor = Motor{.rate = 0.1, .gain = 20, .torque_limit = 3}; // 2 N·m at rest
  CHECK(terms_at(hinge, 0).available == 4);
  CHECK(terms_at(hinge, 1).available == 3);
  hinge.motor->gain = 400; // its limit
  CHECK(terms_at(hinge, 0).available == 5);
  hinge.motor->rate = -0.1; // pulls back
  CHECK((terms_at(hinge, 0).available == 2 && terms_at(hinge, 0).spring == 3));
  TorqueTerms turned; // a hinge that another one turns backwards
  add_terms(hinge, 0, -2, {}, turned);
  CHECK((turned.available == 6 && turned.spring == 4));
}

// 1 rad of travel. The command covers 0.1 · 5 / 2 + 0.1 · 4 + 0.1 · 1 / 2 = 0.7 rad, and ends at 0.
TEST_CASE("a motor whose command has ended gives nothing at rest", "[motorization]") {
  Hinge hinge = hinge_with({0, 0}, {0, 0}, 0.5);
  const double travel = std::abs(hinge.latched - hinge.stowed);
  Motor& motor = hinge.motor.emplace();
  motor.gain = 20, motor.torque_limit = 1.5;
  motor.time = {0, 5, 9, 10}, motor.rates = {0, 0.1 * travel, 0.1 * travel, 0};
  motor.gain /= travel;
  motor.table = std::make_shared<Curve>(motor.time, motor.rates, Interpolation::linear);
  for (const double x : {0.0, 0.2, 0.6}) CHECK(terms_at(hinge, x).available == 1.5); // of 2 at most
  CHECK(terms_at(hinge, 0.65 + 0.0375).available == Approx(1)); // half of the ramp to 0
  for (const double x : {0.71, 0.9, 1.0}) CHECK(terms_at(hinge, x).available == 0);
  const std::vector<double> places = places_of_least(hinge);
  CHECK(std::ranges::count_if(places, [](double x) { return 0.65 < x && x < 0.7; }) >= 7);
  motor.rates.back() = 0.01 * travel; // goes on slowly
  motor.table = std::make_shared<Curve>(motor.time, motor.rates, Interpolation::linear);
  CHECK(terms_at(hinge, 0.3).available == 1.5);
  CHECK(terms_at(hinge, 1).available == Approx(0.2));
  motor.rates.back() = -0.01 * travel; // turns back
  motor.table = std::make_shared<Curve>(motor.time, motor.rates, Interpolation::linear);
  CHECK(terms_at(hinge, 1).available == 0);
  CHECK(terms_at(hinge, 1).spring == Approx(0.2));
}

TEST_CASE("a hinge's terms: what changes its sense changes its side", "[motorization]") {
  Hinge hinge = hinge_with({2, -1}, {-0.1, 0.3}, 0.02);
  const TorqueTerms stowed = terms_at(hinge, 0), latched = terms_at(hinge, 1);
  CHECK((stowed.available == 2 && stowed.spring == 0));
  CHECK((latched.available == 0 && latched.spring == 1));
  CHECK(stowed.harness == 0); // it helps there, and is not counted on
  CHECK(latched.harness == 0.3);
  CHECK(latched.friction == 0.02);
  hinge.friction.model = FrictionModel::exact;
  CHECK(terms_at(hinge, 0).friction == 0.02);
  hinge.friction.static_level = 0.05; // holds at rest
  CHECK(terms_at(hinge, 0).friction == 0.05);
  const std::vector<double> points = turning_points(hinge);
  REQUIRE(points.size() == 4);
  CHECK(points[1] == Approx(0.25));
  CHECK(points[2] == Approx(2.0 / 3));
}

TEST_CASE("what a campaign gives a hinge is added to its own terms, each by its gear",
          "[motorization]") {
  using Terms = TorqueTerms;
  const Hinge hinge = hinge_with({2, -1}, {-0.1, 0.3}, 0.02);
  constexpr std::array all{&Terms::available, &Terms::inertia,  &Terms::spring,
                           &Terms::motor,     &Terms::friction, &Terms::hysteresis,
                           &Terms::harness,   &Terms::adhesion, &Terms::acceleration,
                           &Terms::delivered, &Terms::damping};
  STATIC_REQUIRE(sizeof(Terms) == all.size() * sizeof(double));
  for (const double gear : {1.0, -2.5})
    for (const auto given : all) {
      Terms other, own, with;
      other.*given = 0.5;
      (void)add_terms(hinge, 0.8, gear, {}, own);
      (void)add_terms(hinge, 0.8, gear, {other}, with);
      for (const auto term : all)
        CHECK(with.*term - own.*term == Approx(term == given ? std::abs(gear) * 0.5 : 0));
    }
}

TEST_CASE("no place of the travel is worse than the turning points", "[motorization]") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> torque(-0.5, 2), level(0, 0.2);
  const auto margins = [](const Hinge& hinge, double x) {
    const TorqueTerms terms = terms_at(hinge, x);
    return std::pair{ecss_margin(terms, {}), nasa_static_margin(terms, {})};
  };
  for (int trial = 0; trial < 200; ++trial) {
    const Hinge hinge = hinge_with({torque(random), torque(random)},
                                   {torque(random), torque(random)}, level(random));
    double ecss = 1e300, nasa = 1e300;
    for (const double x : turning_points(hinge)) {
      ecss = std::min(ecss, margins(hinge, x).first);
      nasa = std::min(nasa, margins(hinge, x).second);
    }
    for (int k = 0; k <= 500; ++k) {
      const auto [e, n] = margins(hinge, k / 500.0);
      CHECK(e >= ecss - 1e-12);
      CHECK(n >= nasa - 1e-12);
    }
  }
}

TEST_CASE("scale and offset are in a hinge's terms", "[motorization]") {
  Hinge hinge = hinge_with({2, 1}, {0.1, 0.3}, 0.02);
  hinge.spring.scale = 0.5, hinge.spring.offset = -0.75;
  hinge.harness.scale = 2, hinge.friction.scale = 3;
  const TorqueTerms latched = terms_at(hinge, 1);
  CHECK((latched.available == 0 && latched.spring == 0.25));
  CHECK(latched.harness == 0.6);
  CHECK(latched.friction == 3 * 0.02);
  const std::vector<double> points = turning_points(hinge); // 1 - 0.5 x - 0.75 = 0
  REQUIRE(points.size() == 3);
  CHECK(points[1] == 0.5);
}

TEST_CASE("a torque test both ways has half its hysteresis in the friction", "[motorization]") {
  Hinge hinge = hinge_with({0, 0}, {0, 0}, 0.02);
  hinge.stowed = 1.5, hinge.latched = 0;
  hinge.spring.table =
      std::make_shared<const TorqueTable>(std::vector{1.5, 0.5, 0.0}, std::vector{1.0, 0.6, -0.2},
                                          std::vector{1.2, 1.0, 0.6}, Interpolation::linear);
  hinge.friction.scale = 2;
  const TorqueTerms terms = terms_at(hinge, 2.0 / 3);
  CHECK(terms.available == Approx(0.8).epsilon(1e-15)); // the mean of the curves at 0.5 rad
  CHECK(terms.friction == Approx(2 * (0.02 + 0.2)).epsilon(1e-15));
  CHECK(terms_at(hinge, 1).available == Approx(0.2).epsilon(1e-15));
}

TEST_CASE("a table's knots and its turning points are places of a margin's least",
          "[motorization]") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> torque(-0.5, 2), gap(0.1, 0.3);
  for (int trial = 0; trial < 50; ++trial) {
    Hinge hinge = hinge_with({0, 0}, {0.1, 0.2}, 0.05);
    hinge.stowed = 0.2, hinge.latched = 1.7;
    std::vector<double> angle, deploying, stowing;
    for (int k = 0; k < 7; ++k) {
      angle.push_back(0.1 + 0.3 * k);
      deploying.push_back(torque(random));
      stowing.push_back(deploying.back() + gap(random));
    }
    hinge.spring.table =
        std::make_shared<const TorqueTable>(angle, deploying, stowing, Interpolation::linear);
    const auto margin = [&](double x) { return ecss_margin(terms_at(hinge, x), {}); };
    double least = 1e300, seen = 1e300;
    for (const double x : places_of_least(hinge)) least = std::min(least, margin(x));
    for (int k = 0; k <= 3000; ++k) seen = std::min(seen, margin(k / 3000.0));
    CHECK(seen >= least - 1e-12);                // of linear pieces it lies at an end
    for (const double x : turning_points(hinge)) // the ends, and where the spring changes its sense
      CHECK((x == 0 || x == 1 || std::abs(torque_at(hinge.spring, hinge, x)) < 1e-12));
  }
}

TEST_CASE("dampers are counted at a stated rate, within their windows, and not at rest",
          "[motorization]") {
  Hinge hinge = hinge_with({2, 1}, {0, 0}, 0.02);
  hinge.stowed = 1.5, hinge.latched = 0;
  hinge.friction.viscous = 0.5, hinge.friction.scale = 2;
  hinge.damper = Damper{.law = DamperLaw::viscous, .coefficient = 3, .window = {}, .scale = 1.5};
  CHECK(terms_at(hinge, 0.5).damping == 0);
  CHECK(terms_at(hinge, 0.5).friction == 0.04);
  CHECK(terms_at(hinge, 0.5, {{}, 0.1}).damping ==
        Approx(1.5 * 3 * 0.1 + 2 * 0.5 * 0.1).epsilon(1e-14));
  hinge.friction.viscous = 0;
  hinge.damper->law = DamperLaw::eddy_current;
  hinge.damper->peak_torque = 0.4, hinge.damper->peak_rate = 0.2;
  CHECK(terms_at(hinge, 0.5, {{}, 0.2}).damping == Approx(1.5 * 0.4).epsilon(1e-14)); // at its peak
  // from 0.4 to 0.6 of the travel, in either order and on either side of the latch
  for (const double side : {-1.0, 1.0})
    for (const auto& [from, to] : {std::pair{0.9, 0.6}, {0.6, 0.9}}) {
      hinge.stowed = side * 1.5, hinge.damper->window = {side * from, side * to};
      CAPTURE(side, from);
      CHECK(terms_at(hinge, 0.5, {{}, 0.2}).damping == Approx(0.6).epsilon(1e-14));
      CHECK(terms_at(hinge, 0.3, {{}, 0.2}).damping == 0);
      CHECK(terms_at(hinge, 0.7, {{}, 0.2}).damping == 0);
    }
  // The least of the travel is at the window's far edge: 1.4 N·m there, 0.64 against it, and 1 against 0.04 beyond.
  double least = 1e300, at = 0;
  for (const double x : places_of_least(hinge))
    if (const double margin = nasa_static_margin(terms_at(hinge, x, {{}, 0.2}), {}); margin < least)
      least = margin, at = x;
  CHECK(at == Approx(0.6).epsilon(1e-12));
  CHECK(least == Approx(1.4 / (3 * 0.64) - 1).epsilon(1e-12));
}

// Drive = ½ (stowing + deploying), friction = ½ (stowing − deploying), worked by hand at 1.0 rad, between the knots.
TEST_CASE("the margin of a torque test both ways is its mean over half its difference",
          "[motorization]") {
  Hinge hinge = hinge_with({0, 0}, {0, 0}, 0);
  hinge.stowed = 1.5, hinge.latched = 0;
  hinge.spring.table =
      std::make_shared<const TorqueTable>(std::vector{1.5, 0.5, 0.0}, std::vector{2.0, 1.6, 1.0},
                                          std::vector{2.4, 2.0, 1.8}, Interpolation::linear);
  const TorqueTerms between = terms_at(hinge, 1 / 3.0);
  CHECK(between.available == Approx(2.0).epsilon(1e-14));
  CHECK(between.friction == Approx(0.2).epsilon(1e-14));
  CHECK(phase_margin(between, {1.5, 2}) == Approx(2.0 / 0.4 - 1).epsilon(1e-13));
  double least = 1e300; // latched: ½ (1.8 + 1.0) over 2 · ½ (1.8 − 1.0)
  for (const double x : places_of_least(hinge))
    least = std::min(least, phase_margin(terms_at(hinge, x), {1.5, 2}));
  CHECK(least == Approx(1.4 / 0.8 - 1).epsilon(1e-13));
}
