#include "montecarlo/model/static_margins/motor_command.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace wingspread {
namespace {

/// r(t) of the table before its scale.
double table_rate(const Motor& motor, double time) {
  return std::isinf(time) ? motor.rates.back() : motor.table->value_at(time);
}

/// ∫ of the table from its first knot to `time`.
double integral_to(const Curve& table, double time) {
  const auto& pieces = table.pieces();
  const auto after =
      std::partition_point(pieces.begin() + 1, pieces.end(),
                           [time](const Curve::Piece& piece) { return piece.from <= time; });
  const Curve::Piece& piece = *(after - 1);
  // the first piece is in powers of x − x_0
  const double u = time - (after == pieces.begin() + 1 ? table.knots().front() : piece.from);
  const auto& c = piece.c;
  return piece.integral + u * (c[0] + u * (c[1] / 2 + u * (c[2] / 3 + u * (c[3] / 4))));
}

/// The first place in [from, to] where a condition holds. @pre it does at `to`, and changes once
template <class Condition> double first_where(double from, double to, Condition holds) {
  for (double middle = std::midpoint(from, to); from < middle && middle < to;
       middle = std::midpoint(from, to))
    (holds(middle) ? to : from) = middle;
  return to;
}

bool drives_back(const Motor& motor, double time) {
  return motor.scale * table_rate(motor, time) <= 0;
}

/// The first time in [from, to], between two knots, at which the command drives back; `to` if there is none. Between two
/// knots the rate changes its sign once at most.
double time_of_turn(const Motor& motor, double from, double to) {
  if (!drives_back(motor, to)) return to;
  return first_where(from, to, [&](double time) { return drives_back(motor, time); });
}

} // namespace

double commanded_way(const Motor& motor, double time) {
  if (!motor.table) return motor.rate * time;
  return motor.scale * (integral_to(*motor.table, time) - integral_to(*motor.table, 0));
}

std::optional<double> time_of_way(const Motor& motor, double way) {
  if (!(way > 0)) return 0;
  if (!motor.table) return motor.rate > 0 ? std::optional(way / motor.rate) : std::nullopt;
  const auto there = [&](double time) { return commanded_way(motor, time) >= way; };
  double from = 0;
  for (const double knot : motor.table->knots()) {
    if (knot <= from) continue;
    if (there(knot)) return first_where(from, knot, there);
    const double turn = time_of_turn(motor, from, knot); // the way is longest there
    if (there(turn)) return first_where(from, turn, there);
    from = knot;
  }
  const double last = motor.scale * motor.rates.back();
  if (!(last > 0)) return std::nullopt;
  return from + (way - commanded_way(motor, from)) / last;
}

std::vector<double> turning_ways(const Motor& motor) {
  std::vector<double> ways;
  if (!motor.table) return ways;
  double from = 0;
  for (const double knot : motor.table->knots()) {
    if (knot <= from) continue;
    if (!drives_back(motor, from) && drives_back(motor, knot))
      ways.push_back(commanded_way(motor, time_of_turn(motor, from, knot)));
    from = knot;
  }
  return ways;
}

StallTorques stall_torques(const Motor& motor, double from) {
  double slowest = motor.rate, fastest = motor.rate;
  if (motor.table) { // its curve is largest and smallest at knots
    slowest = fastest = motor.scale * table_rate(motor, from);
    for (std::size_t k = 0; k < motor.time.size(); ++k)
      if (motor.time[k] > from) {
        slowest = std::min(slowest, motor.scale * motor.rates[k]);
        fastest = std::max(fastest, motor.scale * motor.rates[k]);
      }
  }
  const auto at = [&](double rate) {
    return std::clamp(motor.gain * rate, -motor.torque_limit, motor.torque_limit);
  };
  return {at(slowest), at(fastest)};
}

double stall_torque_at(const Hinge& hinge, double x) {
  const double way = x * std::abs(hinge.latched - hinge.stowed);
  const double from =
      time_of_way(*hinge.motor, way).value_or(std::numeric_limits<double>::infinity());
  return stall_torques(*hinge.motor, from).most;
}

} // namespace wingspread
