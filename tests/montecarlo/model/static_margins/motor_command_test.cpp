#include "montecarlo/model/static_margins/motor_command.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace wingspread;

namespace {

Motor motor_by(std::vector<double> time, std::vector<double> rates,
               Interpolation interpolation = Interpolation::linear) {
  Motor motor{.gain = 20, .torque_limit = 3};
  motor.table = std::make_shared<Curve>(time, rates, interpolation);
  motor.time = std::move(time), motor.rates = std::move(rates);
  return motor;
}

} // namespace

TEST_CASE("the way of a command is the integral of its rate", "[motorization]") {
  CHECK(commanded_way(Motor{.rate = 0.1}, 7) == Approx(0.7));
  const Motor ramp = motor_by({1, 3, 4}, {0.2, 0.6, 0}); // 0.2 before 1 s, 0 after 4 s
  CHECK(commanded_way(ramp, 0) == 0);
  CHECK(commanded_way(ramp, 0.5) == Approx(0.1));
  CHECK(commanded_way(ramp, 2) == Approx(0.2 + 0.3));
  CHECK(commanded_way(ramp, 4) == Approx(0.2 + 0.8 + 0.3));
  CHECK(commanded_way(ramp, 99) == Approx(1.3));
  for (const auto interpolation : {Interpolation::linear, Interpolation::monotone}) {
    Motor motor = motor_by({-1, 2, 3, 7}, {0.1, 0.5, -0.3, 0.2}, interpolation);
    motor.scale = 1.7;
    double sum = 0; // by the rule of rectangles
    constexpr int parts = 200'000;
    for (int k = 0; k < parts; ++k) sum += motor.table->value_at((k + 0.5) * 9 / parts) * 9 / parts;
    CHECK(commanded_way(motor, 9) == Approx(1.7 * sum).epsilon(1e-8));
  }
}

TEST_CASE("the time of a way is the first at which the command has come so far", "[motorization]") {
  CHECK(*time_of_way(Motor{.rate = 0.1}, 0.7) == Approx(7));
  CHECK_FALSE(time_of_way(Motor{.rate = -0.1}, 0.7));
  CHECK(*time_of_way(Motor{.rate = -0.1}, 0) == 0);
  for (const auto interpolation : {Interpolation::linear, Interpolation::monotone}) {
    const Motor motor = motor_by({0, 2, 3, 5, 9}, {0, 0.5, 0.1, -0.4, 0.3}, interpolation);
    double reached = 0, t = 0; // steps in time; the way turns back once and goes on further
    for (const double way : {0.01, 0.4, 0.7, 0.8, 1.5, 4.0}) {
      for (; reached < way; t += 1e-3) reached = std::max(reached, commanded_way(motor, t));
      CHECK(*time_of_way(motor, way) == Approx(t - 1e-3).margin(1.1e-3));
    }
  }
  const Motor ends = motor_by({0, 2}, {0.5, 0});
  CHECK(*time_of_way(ends, 0.499) < 2);
  CHECK_FALSE(time_of_way(ends, 0.501));
}

TEST_CASE("a command turns back where its rate falls to 0", "[motorization]") {
  CHECK(turning_ways(Motor{.rate = 0.1}).empty());
  CHECK(turning_ways(motor_by({0, 4}, {0.1, 0.2})).empty());
  CHECK(turning_ways(motor_by({0, 4}, {-0.1, -0.2})).empty());
  const Motor twice = motor_by({0, 2, 3, 5, 9}, {0.4, 0.4, -0.4, 0.4, 0});
  REQUIRE(turning_ways(twice).size() == 2); // at 2.5 s and at 9 s
  CHECK(turning_ways(twice)[0] == Approx(0.8 + 0.1));
  CHECK(turning_ways(twice)[1] == Approx(0.9 - 0.1 - 0.2 + 0.2 + 0.8));
  Motor back = motor_by({0, 2, 4}, {-0.5, 0.5, 0.5});
  CHECK(turning_ways(back).empty());
  back.scale = -1; // forward, and back from 1 s on
  REQUIRE(turning_ways(back).size() == 1);
  CHECK(turning_ways(back)[0] == Approx(0.25));
}

TEST_CASE("a motor's moments at rest are those of the commands still to come", "[motorization]") {
  Motor motor = motor_by({0, 1, 2}, {-0.05, 0.1, 0}, Interpolation::monotone);
  motor.scale = 0.5;
  CHECK(stall_torques(motor).most == 1);
  CHECK(stall_torques(motor).least == -0.5);
  CHECK(stall_torques(motor, 1.5).most == Approx(20 * 0.5 * motor.table->value_at(1.5)));
  CHECK(stall_torques(motor, 1.5).least == 0);
  for (const double after : {2.0, 9.0, std::numeric_limits<double>::infinity()})
    CHECK((stall_torques(motor, after).most == 0 && stall_torques(motor, after).least == 0));
  motor.scale = -0.5;
  CHECK(stall_torques(motor).most == 0.5);
  CHECK(stall_torques(motor).least == -1);
}
