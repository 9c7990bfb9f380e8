#include "core/scene/torque.hpp"
#include "montecarlo/margin/motorization.hpp"

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

// S .05, FR .10, HY .02, HA .03, HD .01, TD .02 N·m: worked by hand from the standard's formula.
TEST_CASE("ECSS: the least torque, and the spring that it takes", "[motorization]") {
  MotorizationTerms terms;
  terms.spring = .05, terms.friction = .10, terms.hysteresis = .02, terms.harness = .03;
  terms.adhesion = .01, terms.acceleration = .02;
  CHECK(ecss_required(terms, {}) == Approx(1.105).epsilon(1e-14));
  CHECK(ecss_required(terms, ecss_measured()) == Approx(.655).epsilon(1e-14));
  for (const auto& [factors, spring] :
       {std::pair{EcssFactors{}, 1.38125}, std::pair{ecss_measured(), .81875}}) {
    terms.available = spring; // just enough
    CHECK(ecss_margin(terms, factors) == Approx(0).margin(1e-14));
    terms.available = 2 * spring;
    CHECK(ecss_margin(terms, factors) == Approx(1).epsilon(1e-14));
  }
}

TEST_CASE("ECSS: every term counts with its own factor", "[motorization]") {
  const auto alone = [](double MotorizationTerms::*term, const EcssFactors& factors) {
    MotorizationTerms terms;
    terms.*term = 1;
    return ecss_required(terms, factors);
  };
  using Terms = MotorizationTerms;
  struct Case {
    double Terms::*term;
    double theoretical, measured;
  };
  for (const auto& [term, theoretical, measured] :
       {Case{&Terms::inertia, 2.2, 2.2}, Case{&Terms::spring, 2.4, 2.4},
        Case{&Terms::motor, 3, 2.4}, Case{&Terms::friction, 6, 3}, Case{&Terms::hysteresis, 6, 3},
        Case{&Terms::harness, 6, 3}, Case{&Terms::adhesion, 6, 6},
        Case{&Terms::acceleration, 1.25, 1.25}, Case{&Terms::delivered, 1, 1}}) {
    CHECK(alone(term, {}) == Approx(theoretical).epsilon(1e-14));
    CHECK(alone(term, ecss_measured()) == Approx(measured).epsilon(1e-14));
  }
}

// T 1, T_f .10, T_v .15, T_a .08 N·m.
TEST_CASE("NASA: static and dynamic margins", "[motorization]") {
  MotorizationTerms terms;
  terms.available = 1, terms.inertia = .10, terms.friction = .15, terms.acceleration = .08;
  CHECK(nasa_static_margin(terms, {}) == Approx(.666667).margin(5e-7));
  CHECK(nasa_dynamic_margin(terms, {}) == Approx(.428571).margin(5e-7));
  CHECK(nasa_static_margin(terms, nasa_development_test()) ==
        Approx(1 / (1.35 * .10 + 2.5 * .15) - 1).epsilon(1e-14));
  CHECK(nasa_dynamic_margin(terms, nasa_acceptance()) ==
        Approx(1 / (1.25 * .10 + 2 * .15 + 1.1 * .08) - 1).epsilon(1e-14));
  CHECK(nasa_dynamic_margin(terms, nasa_one_spring_out()) == Approx(1 / .33 - 1).epsilon(1e-14));
}

TEST_CASE("NASA: every term counts with the factor of its class, and with no other",
          "[motorization]") {
  using Terms = MotorizationTerms;
  const NasaFactors told_apart{2, 5, 11}; // fixed, variable, acceleration
  struct Case {
    double Terms::*term;
    double static_factor, dynamic_factor;
  };
  for (const auto& [term, static_factor, dynamic_factor] :
       {Case{&Terms::inertia, 2, 2}, Case{&Terms::spring, 2, 2}, Case{&Terms::delivered, 2, 2},
        Case{&Terms::motor, 5, 5}, Case{&Terms::friction, 5, 5}, Case{&Terms::hysteresis, 5, 5},
        Case{&Terms::harness, 5, 5}, Case{&Terms::adhesion, 5, 5},
        Case{&Terms::acceleration, 0, 11}}) {
    Terms terms;
    terms.available = 1000;
    terms.adhesion = 1; // so that something resists
    terms.*term += 1;
    CHECK(nasa_static_margin(terms, told_apart) ==
          Approx(1000 / (5 + static_factor) - 1).epsilon(1e-14));
    CHECK(nasa_dynamic_margin(terms, told_apart) ==
          Approx(1000 / (5 + dynamic_factor) - 1).epsilon(1e-14));
  }
  const auto factors = [](const NasaFactors& f) {
    return std::array{f.fixed, f.variable, f.acceleration};
  };
  CHECK(factors({}) == std::array{1.5, 3.0, 1.25});
  CHECK(factors(nasa_development_test()) == std::array{1.35, 2.5, 1.15});
  CHECK(factors(nasa_acceptance()) == std::array{1.25, 2.0, 1.1});
  CHECK(factors(nasa_one_spring_out()) == std::array{1.0, 1.0, 1.0});
}

TEST_CASE("the standards are named with their editions", "[motorization]") {
  CHECK(ecss_standard == "ECSS-E-ST-33-01C (6 March 2009)");
  CHECK(nasa_standard == "NASA-STD-5017B (6 December 2022)");
}

TEST_CASE("a hinge's terms: what changes its sense changes its side", "[motorization]") {
  Hinge hinge = hinge_with({2, -1}, {-0.1, 0.3}, 0.02);
  const MotorizationTerms stowed = terms_at(hinge, 0), latched = terms_at(hinge, 1);
  CHECK((stowed.available == 2 && stowed.spring == 0));
  CHECK((latched.available == 0 && latched.spring == 1));
  CHECK(stowed.harness == 0); // it helps there, and is not counted on
  CHECK(latched.harness == 0.3);
  CHECK(latched.friction == 0.02);
  hinge.friction.model = FrictionModel::exact;
  CHECK(terms_at(hinge, 0).friction == 0.02);
  hinge.friction.static_level = 0.05; // holds at rest
  CHECK(terms_at(hinge, 0).friction == 0.05);
  MotorizationTerms other;
  other.adhesion = 0.5, other.hysteresis = 0.25;
  CHECK(terms_at(hinge, 1, other).adhesion == 0.5);
  CHECK(terms_at(hinge, 1, other).hysteresis == 0.25);
  const std::vector<double> points = turning_points(hinge);
  REQUIRE(points.size() == 4);
  CHECK(points[1] == Approx(0.25));
  CHECK(points[2] == Approx(2.0 / 3));
}

TEST_CASE("margins without resistance, and without any torque", "[motorization]") {
  MotorizationTerms terms;
  CHECK(ecss_margin(terms, {}) == -1);
  terms.available = 1;
  CHECK(ecss_margin(terms, {}) == std::numeric_limits<double>::infinity());
  CHECK(nasa_static_margin(terms, {}) == std::numeric_limits<double>::infinity());
}

TEST_CASE("no place of the travel is worse than the turning points", "[motorization]") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> torque(-0.5, 2), level(0, 0.2);
  const auto margins = [](const Hinge& hinge, double x) {
    const MotorizationTerms terms = terms_at(hinge, x);
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
  const MotorizationTerms latched = terms_at(hinge, 1);
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
  const MotorizationTerms terms = terms_at(hinge, 2.0 / 3);
  CHECK(terms.available == Approx(0.8).epsilon(1e-15)); // the mean of the curves at 0.5 rad
  CHECK(terms.friction == Approx(2 * (0.02 + 0.2)).epsilon(1e-15));
  CHECK(terms_at(hinge, 1).available == Approx(0.2).epsilon(1e-15));
}

TEST_CASE("margins of a table are least at its places", "[motorization]") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> torque(-0.5, 2), gap(0.1, 0.3);
  const Interpolation interpolation = GENERATE(Interpolation::linear, Interpolation::monotone);
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
        std::make_shared<const TorqueTable>(angle, deploying, stowing, interpolation);
    const auto margin = [&](double x) { return ecss_margin(terms_at(hinge, x), {}); };
    double least = 1e300, looked = 1e300;
    for (const double x : places_of_least(hinge)) least = std::min(least, margin(x));
    for (int k = 0; k <= 3000; ++k) looked = std::min(looked, margin(k / 3000.0));
    // Linear pieces have their least at an end; a cubic's lies at a knot, or hardly below 1/8 of a piece beside it.
    const double slack = interpolation == Interpolation::linear ? 1e-12 : 2e-2;
    CHECK(looked >= least - slack);
    for (const double x : turning_points(hinge)) // the ends, and where the spring changes its sense
      CHECK((x == 0 || x == 1 || std::abs(torque_at(hinge.spring, hinge, x)) < 1e-12));
  }
}
