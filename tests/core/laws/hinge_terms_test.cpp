// The numbers of a hinge that every wing has.
#include "core/laws/hinge_terms.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using oracle::Draws;

// A factor counts as if every number that it scales had been given so much larger.
TEST_CASE(
    "a friction's or a torque's scale stands for all numbers that it scales, either model's") {
  for (int k = 0; k < 200; ++k) {
    Draws draws(600 + k);
    Hinge hinge;
    hinge.stowed = draws.uniform(-1, 1), hinge.latched = hinge.stowed + draws.sign();
    hinge.friction.model = k % 2 == 0 ? FrictionModel::exact : FrictionModel::regularized;
    hinge.friction.coulomb = draws.uniform(0, 1), hinge.friction.viscous = draws.uniform(0, 1);
    if (draws.chance(0.7)) hinge.friction.static_level = draws.uniform(1, 2);
    hinge.spring.torque_stowed = draws.uniform(0, 2),
    hinge.spring.torque_latched = draws.uniform(0, 2);
    hinge.harness.torque_stowed = draws.uniform(0, 2),
    hinge.harness.torque_latched = draws.uniform(0, 2);
    Hinge larger = hinge;
    const double rub = draws.uniform(0.2, 3);
    hinge.friction.scale = rub;
    larger.friction.coulomb *= rub, larger.friction.viscous *= rub;
    if (larger.friction.static_level) *larger.friction.static_level *= rub;
    for (const auto torque : {&Hinge::spring, &Hinge::harness}) {
      const double scale = draws.uniform(0.2, 3);
      (hinge.*torque).scale = scale;
      (larger.*torque).torque_stowed *= scale, (larger.*torque).torque_latched *= scale;
    }
    HingeTerms<double> scaled{}, given{};
    detail::set_hinge(scaled, hinge), detail::set_hinge(given, larger);
    CAPTURE(k);
    CHECK(scaled.kinetic_friction == Approx(given.kinetic_friction));
    CHECK(scaled.static_friction == Approx(given.static_friction));
    CHECK(scaled.regularized_friction == Approx(given.regularized_friction));
    CHECK(scaled.viscous == Approx(given.viscous));
    CHECK(scaled.drive == Approx(given.drive).margin(1e-14));
    CHECK(scaled.drive_slope == Approx(given.drive_slope).margin(1e-14));
    CHECK(scaled.can_stick() == (hinge.friction.model == FrictionModel::exact));
  }
}
