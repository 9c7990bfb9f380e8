#include "core/scene/torque.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace wingspread;

namespace {

Hinge hinge_from(double stowed, double latched) {
  Hinge hinge;
  hinge.stowed = stowed;
  hinge.latched = latched;
  return hinge;
}

} // namespace

TEST_CASE("a curve is found at every place, its ends and beyond", "[torque]") {
  const Curve line({0, 1, 3}, {2, 4, 0}, Interpolation::linear);
  CHECK(value_at(line, -5) == 2); // constant beyond the ends
  CHECK(value_at(line, 0) == 2);
  CHECK(value_at(line, 0.5) == 3);
  CHECK(value_at(line, 1) == 4);
  CHECK(value_at(line, 2) == 2);
  CHECK(value_at(line, 3) == 0);
  CHECK(value_at(line, 9) == 0);
  const Curve straight({0, 1}, {0, 2}, Interpolation::monotone, Beyond::straight);
  CHECK(value_at(straight, -1) == -2);
  CHECK(value_at(straight, 2) == 4);
}

TEST_CASE("a torque is scale times law plus offset", "[torque]") {
  const Hinge hinge = hinge_from(1, -1);
  HingeTorque torque{2, 1};
  CHECK(torque_at(torque, hinge, 0) == 2);
  CHECK(torque_at(torque, hinge, 1) == 1);
  torque.scale = 3, torque.offset = 0.5;
  CHECK(torque_at(torque, hinge, 0.5) == 5);
  torque.table = std::make_shared<const TorqueTable>(
      std::vector{1.0, 0.0, -1.0}, std::vector{1.0, 2.0, 4.0}, Interpolation::linear);
  CHECK(torque_at(torque, hinge, 0) == 3.5);
  CHECK(torque_at(torque, hinge, 0.25) == 5); // at 0.5 rad, half way from 1 to 2 N·m
  CHECK(torque_at(torque, hinge, 1) == 12.5);
}

TEST_CASE("friction's levels, with what a torque test both ways adds", "[torque]") {
  Hinge hinge = hinge_from(0, 2);
  hinge.friction.coulomb = 0.5;
  CHECK(measured_friction_at(hinge, 0) == 0);
  CHECK(static_level_at(hinge, 0) == 0.5);
  hinge.spring.table = std::make_shared<const TorqueTable>(
      std::vector{0.0, 2.0}, std::vector{1.0, 1.0}, std::vector{1.0, 3.0}, Interpolation::linear);
  hinge.friction.scale = 2;
  CHECK(measured_friction_at(hinge, 0.5) == 1); // 2 times half of 2 − 1
  CHECK(static_level_at(hinge, 0.5) == 2);
  hinge.friction.static_level = 0.75; // regularized friction does not stick
  CHECK(static_level_at(hinge, 0.5) == 2);
  hinge.friction.model = FrictionModel::exact;
  CHECK(static_level_at(hinge, 0.5) == 2.5);
  hinge.friction.static_level.reset(); // sticks by its Coulomb level
  CHECK(static_level_at(hinge, 0.5) == 2);
}

// Noise may make the torque of a test both ways larger deploying than stowing; friction does not drive for that.
TEST_CASE("measured friction is half of what stowing needs more, and none where the tests cross",
          "[torque]") {
  int crossed = 0, rubs = 0;
  for (int seed = 1; seed <= 200; ++seed) {
    oracle::Draws draws(seed);
    Hinge hinge = hinge_from(draws.uniform(-2, 2), draws.uniform(-2, 2));
    std::vector<double> share{0, 0.3, 0.6, 1}, angle, deploying, stowing;
    for (const double x : share) {
      angle.push_back(std::lerp(hinge.stowed, hinge.latched, x));
      deploying.push_back(draws.uniform(0, 2)), stowing.push_back(draws.uniform(0, 2));
    }
    hinge.spring.table =
        std::make_shared<const TorqueTable>(angle, deploying, stowing, Interpolation::linear);
    hinge.friction.scale = draws.uniform(0.5, 2), hinge.friction.coulomb = draws.uniform(0, 1);
    for (std::size_t k = 0; k < share.size(); ++k) {
      const double level = 0.5 * (stowing[k] - deploying[k]);
      const double expected = hinge.friction.scale * std::max(level, 0.0);
      CAPTURE(seed, k, level);
      CHECK(measured_friction_at(hinge, share[k]) == Approx(expected).margin(1e-12));
      CHECK(static_level_at(hinge, share[k]) ==
            Approx(hinge.friction.scale * hinge.friction.coulomb + expected).margin(1e-12));
      ++(level < 0 ? crossed : rubs);
    }
  }
  CHECK(std::min(crossed, rubs) > 100);
}
