#include "montecarlo/model/static_margins/static_margin.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace wingspread;

// S .05, FR .10, HY .02, HA .03, HD .01, TD .02 N·m: worked by hand from the standard's formula.
TEST_CASE("ECSS: the least torque, and the spring that it takes", "[motorization]") {
  TorqueTerms terms;
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
  const auto alone = [](double TorqueTerms::*term, const EcssFactors& factors) {
    TorqueTerms terms;
    terms.*term = 1;
    return ecss_required(terms, factors);
  };
  using Terms = TorqueTerms;
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
  TorqueTerms terms;
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
  using Terms = TorqueTerms;
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
  CHECK(gevs_standard == "GSFC-STD-7000A (22 April 2013)");
  CHECK(aiaa_standard == "AIAA S-114-2005");
}

TEST_CASE("margins without resistance, and without any torque", "[motorization]") {
  TorqueTerms terms;
  CHECK(ecss_margin(terms, {}) == -1);
  terms.available = 1;
  CHECK(ecss_margin(terms, {}) == std::numeric_limits<double>::infinity());
  CHECK(nasa_static_margin(terms, {}) == std::numeric_limits<double>::infinity());
}

namespace {

/// Of a torque test: what drives, and what resists, known and variable; in lbf for an inch, of no account here.
TorqueTerms torque_test(double available, double known, double variable) {
  TorqueTerms terms;
  terms.available = available, terms.inertia = known, terms.friction = variable;
  return terms;
}

} // namespace

TEST_CASE("GEVS and AIAA: factors by phase", "[motorization]") {
  const auto factors = [](MarginPhase phase) {
    const PhaseFactors f = phase_factors(phase);
    return std::pair{f.known, f.variable};
  };
  CHECK(factors(MarginPhase::preliminary_design) == std::pair{2.0, 4.0});
  CHECK(factors(MarginPhase::critical_design) == std::pair{1.5, 3.0});
  CHECK(factors(MarginPhase::test) == std::pair{1.5, 2.0});
  CHECK((PhaseFactors{}.known == 1.5 && PhaseFactors{}.variable == 3));
}

// The published torque tests of a flown array [Aerospace Mechanisms Symposium 2018, pp. 389-402], torques in lbf·in,
// margins as printed there: two or three decimals, of torques that are rounded themselves, so within 1.5 units of the
// last decimal. Beside them the quotient, worked by hand from the rounded torques.
TEST_CASE("GEVS and AIAA: the published torque tests of a flown array", "[motorization]") {
  struct Row {
    double available, known, variable;
    PhaseFactors factors;
    double published, last_decimal, by_hand;
  };
  const PhaseFactors critical = phase_factors(MarginPhase::critical_design);
  const PhaseFactors test = phase_factors(MarginPhase::test), own{1.25, 3};
  for (const Row& row : {Row{44, 6.50, 5.41, critical, .695, .001, 44 / 25.98 - 1},
                         Row{56, 5.76, 11.32, test, .791, .001, 56 / 31.28 - 1},
                         Row{56, 5.76, 11.32, own, .361, .001, 56 / 41.16 - 1},
                         Row{40, 5.76, 11.32, test, .279, .001, 40 / 31.28 - 1},
                         Row{33, 6.42, 10.65, test, .067, .001, 33 / 30.93 - 1},
                         Row{31.1, 5.55, 10.5, test, .06, .01, 31.1 / 29.325 - 1},
                         Row{54, 12.33, 7.62, critical, .306, .001, 54 / 41.355 - 1},
                         Row{77, 11.37, 13.1, test, .780, .001, 77 / 43.255 - 1},
                         Row{77, 11.37, 13.1, own, .439, .001, 77 / 53.5125 - 1},
                         Row{49, 7.87, 16.6, test, .09, .01, 49 / 45.005 - 1},
                         Row{60.5, 7.85, 33.1, test, -.22, .01, 60.5 / 77.975 - 1}}) {
    const TorqueTerms terms = torque_test(row.available, row.known, row.variable);
    const double margin = phase_margin(terms, row.factors);
    CAPTURE(row.available, row.known, row.variable, row.factors.known, row.factors.variable);
    CHECK(margin == Approx(row.published).margin(1.5 * row.last_decimal));
    CHECK(margin == Approx(row.by_hand).epsilon(1e-13));
  }
}

TEST_CASE("GEVS and AIAA: every term counts with the factor of its class", "[motorization]") {
  using Terms = TorqueTerms;
  for (const auto& [term, factor] :
       {std::pair{&Terms::inertia, 2.0}, std::pair{&Terms::spring, 2.0},
        std::pair{&Terms::delivered, 2.0}, std::pair{&Terms::motor, 5.0},
        std::pair{&Terms::friction, 5.0}, std::pair{&Terms::hysteresis, 5.0},
        std::pair{&Terms::harness, 5.0}, std::pair{&Terms::adhesion, 5.0},
        std::pair{&Terms::damping, 5.0}, std::pair{&Terms::acceleration, 0.0}}) {
    Terms terms;
    terms.available = 1000;
    terms.adhesion = 1; // so that something resists
    terms.*term += 1;
    CHECK(phase_margin(terms, {2, 5}) == Approx(1000 / (5 + factor) - 1).epsilon(1e-14));
  }
  Terms nothing;
  CHECK(phase_margin(nothing, {}) == -1);
}

TEST_CASE("damping counts with friction's factor of ECSS, and as variable by NASA",
          "[motorization]") {
  TorqueTerms terms;
  terms.damping = 1;
  CHECK(ecss_required(terms, {}) == 6);
  CHECK(ecss_required(terms, ecss_measured()) == 3);
  terms.available = 12;
  CHECK(nasa_static_margin(terms, {}) == 3);
}

TEST_CASE("margins of all kinds are each by its own factors", "[motorization]") {
  StaticMarginSpec spec;
  spec.springs_per_hinge = 4;
  spec.aiaa = phase_factors(MarginPhase::test);
  const TorqueTerms terms = torque_test(12, 1, 1);
  const Margins margins = margins_of(terms, 8, spec); // 4 of the 12 are a motor's, or other hinges'
  CHECK(margins[0] == Approx(0.8 * 12 / (2 * (1.1 + 3)) - 1).epsilon(1e-14));
  CHECK(margins[1] == Approx(12 / 4.5 - 1).epsilon(1e-14));
  CHECK(margins[2] ==
        Approx(10 / 2.0 - 1).epsilon(1e-14)); // one of four springs takes 2, factors 1
  CHECK(margins[3] == Approx(12 / 4.5 - 1).epsilon(1e-14));
  CHECK(margins[4] == Approx(12 / 3.5 - 1).epsilon(1e-14));
}

TEST_CASE("the formula of a margin has the campaign's factors", "[motorization]") {
  StaticMarginSpec spec;
  spec.nasa = nasa_development_test();
  CHECK(formula_of(MarginKind::nasa, spec) == "T / (1.35 ΣT_fixed + 2.5 ΣT_variable) − 1");
  spec.gevs.known = 1.75, spec.aiaa.variable = 4;
  CHECK(formula_of(MarginKind::gevs, spec) == "T / (1.75 ΣT_fixed + 3 ΣT_variable) − 1");
  CHECK(formula_of(MarginKind::aiaa, spec) == "T / (1.5 ΣT_fixed + 4 ΣT_variable) − 1");
  spec.springs_per_hinge = 3;
  CHECK(formula_of(MarginKind::nasa_one_spring_out, spec).starts_with("(T − T_s/3) / "));
  // numbers that differ, each beside its symbol
  spec.ecss = {.inertia = 1.01,
               .spring = 1.02,
               .motor = 1.03,
               .friction = 1.04,
               .hysteresis = 1.05,
               .harness = 1.06,
               .adhesion = 1.07,
               .motorization = 2.5,
               .acceleration = 1.08,
               .available = 0.9};
  CHECK(formula_of(MarginKind::ecss, spec) ==
        "0.9 T / T_min − 1, T_min = 2.5 (1.01 I + 1.02 S + 1.03 HM + 1.04 FR + 1.05 HY + 1.06 HA + "
        "1.07 HD) + 1.08 TD + TL");
}
