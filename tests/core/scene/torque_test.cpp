#include "core/scene/torque.hpp"

#include <catch2/catch.hpp>

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
}
