#include "core/laws/friction.hpp"
#include "core/laws/real_hinge.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <memory>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("regularized friction is the Coulomb level at speed and linear in the rate at rest") {
  HingeTerms<double> h{};
  h.regularized_friction = 0.1, h.slip_rate = 1e-3;
  CHECK(regularized_friction_moment(h, 10.0) == Approx(-0.1));
  CHECK(regularized_friction_moment(h, -10.0) == Approx(0.1));
  CHECK(regularized_friction_moment(h, 0.0) == 0);
  CHECK(regularized_friction_moment(h, 1e-3) == Approx(-0.1 / std::sqrt(2.0)));
}

TEST_CASE("regularized friction damps small changes as its slope says") {
  HingeTerms<double> h{};
  h.regularized_friction = 0.1, h.slip_rate = 1e-3;
  for (const double rate : {0.0, 3e-4, -1e-3, 0.02}) {
    const double d = 1e-8; // rounding of the moments leaves 1e-7 of the smallest slope
    CHECK((regularized_friction_moment(h, rate - d) - regularized_friction_moment(h, rate + d)) /
              (2 * d) ==
          Approx(regularized_friction_damping(h, rate)).epsilon(1e-5));
  }
}

TEST_CASE("regularized friction stays in its range, and its change in that of its slope") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Draws draws(seed);
    HingeTerms<double> hinge{};
    hinge.regularized_friction = draws.log_uniform(0.01, 10);
    hinge.slip_rate = draws.log_uniform(1e-3, 1);
    const double v = draws.uniform(-2, 2) * hinge.slip_rate;
    const ValueRange<double> rate{v, v + draws.log_uniform(1e-2, 10) * hinge.slip_rate};
    const double a = draws.uniform(-2, 2);
    const ValueRange<double> acceleration{a, a + draws.uniform(0, 2)};
    const ValueRange<double> range = regularized_friction_range(hinge, rate);
    const ValueRange<double> change = regularized_friction_change(hinge, rate, acceleration);
    const double close = 1e-7 * largest_magnitude_of(change); // differences, rounding
    CAPTURE(seed, rate.low, rate.high);
    for (int k = 0; k <= 40; ++k) {
      const double w = rate.low + (rate.high - rate.low) * k / 40, d = 1e-5 * hinge.slip_rate;
      const double m = regularized_friction_moment(hinge, w);
      REQUIRE(range.low <= m);
      REQUIRE(m <= range.high);
      const double slope =
          (regularized_friction_moment(hinge, w + d) - regularized_friction_moment(hinge, w - d)) /
          (2 * d);
      for (const double p : {acceleration.low, acceleration.high}) {
        REQUIRE(change.low - close <= slope * p);
        REQUIRE(slope * p <= change.high + close);
      }
    }
  }
}

TEST_CASE("measured friction whose level falls to 0 has no bounds of its slopes there") {
  const Curve level({0, 1, 2, 3}, {1, -1, 1, 2}, Interpolation::linear); // 0 from 0.5 to 1.5
  const double sliding = -1;
  MeasuredFrictionTerms<double> terms{&level, 2, 0.1, false, 4};
  const MeasuredFriction<double> law{terms, sliding};
  const auto moment = [&](double angle) {
    double m = 0;
    law.add_moment(m, angle, -1.0);
    return m;
  };
  CHECK(moment(0.25) == Approx(2 * 0.5).epsilon(1e-14));
  CHECK(moment(1.0) == 0);
  CHECK(moment(2.5) == Approx(2 * 1.5).epsilon(1e-14));
  CHECK(law.has_slopes({0.1, 0.4}));
  CHECK(law.has_slopes({1.6, 2.9}));
  for (const ValueRange<double> angle :
       {ValueRange<double>{0.4, 0.6}, {0.9, 1.1}, {1.4, 1.6}, {0.1, 2.9}})
    CHECK_FALSE(law.has_slopes(angle));
  for (const ValueRange<double> angle : {ValueRange<double>{0.1, 0.4}, {1.6, 2.9}}) {
    MomentSlopes<double> slopes;
    law.add_slopes(slopes, angle, {-1, -0.5});
    const double d = 1e-6, middle = (angle.low + angle.high) / 2;
    const double quotient = (moment(middle + d) - moment(middle - d)) / (2 * d);
    CHECK(slopes.by_angle.low <= quotient + 1e-6);
    CHECK(quotient - 1e-6 <= slopes.by_angle.high);
  }
  terms.regularized = true;
  CHECK_FALSE(law.has_slopes({0.1, 0.4}));
}

// Half the difference of two monotone curves need not be monotone between knots: its largest value may lie between them.
TEST_CASE(
    "what two torque tests measure of friction is nowhere above its most, and nearly reaches it") {
  int between = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Draws draws(seed);
    std::vector<double> angle{0}, deploying{draws.uniform(-1, 1)}, stowing{draws.uniform(-1, 1)};
    for (int k = 0; k < 4; ++k) {
      angle.push_back(angle.back() + draws.log_uniform(0.05, 1));
      deploying.push_back(draws.uniform(-1, 1)), stowing.push_back(draws.uniform(-1, 1));
    }
    const auto how = draws.chance(0.8) ? Interpolation::monotone : Interpolation::linear;
    Hinge hinge;
    hinge.latched = angle.back();
    hinge.spring.table = std::make_shared<const TorqueTable>(angle, deploying, stowing, how);
    hinge.friction.scale = draws.log_uniform(0.1, 10);
    if (draws.chance(0.5)) hinge.friction.model = FrictionModel::exact;
    const RealHingeTerms<double> terms = real_hinge_terms<double>(hinge, 1.0);
    double largest = 0, at_knots = 0;
    for (int k = 0; k <= 2000; ++k) {
      const double x = (1.2 * k / 2000 - 0.1) * angle.back();
      largest = std::max(largest, measured_friction(terms.friction, x));
    }
    for (const double x : angle)
      at_knots = std::max(at_knots, measured_friction(terms.friction, x));
    between += largest > 1.001 * at_knots;
    CAPTURE(seed, largest, at_knots);
    CHECK(largest <= terms.friction.most * (1 + 1e-12));
    // the excess between two knots may count twice: beside another knot, and from a lower one
    CHECK(terms.friction.most <= largest + 2 * hinge.friction.scale);
  }
  CHECK(between >= 20);
}
