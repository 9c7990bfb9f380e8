#include "core/laws/linear_law.hpp"

#include <catch2/catch.hpp>

#include <optional>

using namespace wingspread;

namespace {
Hinge hinge(double stowed, double latched) {
  Hinge h;
  h.name = "h";
  h.stowed = stowed, h.latched = latched;
  h.spring = {2, 1};
  h.harness = {0.5, 0.25};
  h.friction.coulomb = 0.1, h.friction.viscous = 3, h.friction.regularization_rate = 1e-3;
  h.latch = Latch{1000, 10};
  return h;
}
HingeTerms<double> terms(double stowed, double latched) {
  HingeTerms<double> terms;
  detail::set_hinge(terms, hinge(stowed, latched));
  return terms;
}
} // namespace

TEST_CASE("spring less harness is linear in the travel and acts towards the latched angle") {
  for (const double latched : {1.2, -1.2}) {
    const HingeTerms<double> h = terms(0.2, latched);
    const double s = latched > 0.2 ? 1 : -1;
    const LinearLaw<double> law = linear_law(h, false);
    CHECK(linear_moment(law, 0.2, 0.0) == Approx(s * 1.5));
    CHECK(linear_moment(law, latched, 0.0) == Approx(s * 0.75));
    CHECK(linear_moment(law, 0.5 * (0.2 + latched), 0.0) == Approx(s * 1.125));
  }
}

TEST_CASE("viscous friction and the engaged latch oppose") {
  const HingeTerms<double> h = terms(1, 0);
  CHECK(linear_moment(linear_law(h, false), 0.0, 0.5) == Approx(-0.75 - 3 * 0.5));
  CHECK(linear_moment(linear_law(h, true), -0.01, 0.5) -
            linear_moment(linear_law(h, false), -0.01, 0.5) ==
        Approx(1000 * 0.01 - 10 * 0.5));
}

TEST_CASE("an engaged latch exerts nothing inside its backlash, and bears from its end on") {
  const HingeTerms<double> h = terms(1, 0);
  const auto moment = [&](bool engaged, std::optional<double> side) {
    return linear_moment(linear_law(h, engaged, 0.0, side), 0.002, 0.5);
  };
  CHECK(moment(true, std::nullopt) == moment(false, 0.0));
  CHECK(moment(true, 0.001) - moment(false, 0.0) == Approx(-1000 * 0.001 - 10 * 0.5));
  CHECK(moment(true, -0.001) - moment(false, 0.0) == Approx(-1000 * 0.003 - 10 * 0.5));
}

TEST_CASE("the potential is the moment's integral") {
  const LinearLaw<double> law = linear_law(terms(1, 0), true);
  CHECK(potential(law, 0.0) == 0);
  for (const double angle : {-0.02, 0.3, 1.0}) {
    const double d = 1e-5;
    CHECK((potential(law, angle - d) - potential(law, angle + d)) / (2 * d) ==
          Approx(linear_moment(law, angle, 0.0)).epsilon(1e-7));
  }
}
