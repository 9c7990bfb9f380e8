#include "montecarlo/model/static_margins/hinge_terms.hpp"

#include "core/laws/damper.hpp"
#include "core/scene/torque.hpp"
#include "montecarlo/model/static_margins/motor_command.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace wingspread {
namespace {

/// The x at which a linear torque is zero.
std::optional<double> root_of_line(const HingeTorque& torque) {
  const double stowed = torque.scale * torque.torque_stowed + torque.offset;
  const double latched = torque.scale * torque.torque_latched + torque.offset;
  const double x = stowed / (stowed - latched);
  return x > 0 && x < 1 ? std::optional(x) : std::nullopt;
}

/// The x at which a torque is zero, by bisection. @pre the torque has different signs at both ends
double root_between(const HingeTorque& torque, const Hinge& hinge, double from, double to) {
  const bool sense = torque_at(torque, hinge, from) > 0;
  for (double middle = std::midpoint(from, to); from < middle && middle < to;
       middle = std::midpoint(from, to))
    ((torque_at(torque, hinge, middle) > 0) == sense ? from : to) = middle;
  return to;
}

/// Places along the pieces of a motor's table by which a hinge that follows the command passes.
std::vector<double> places_along(const Motor& motor, const Hinge& hinge) {
  constexpr double beyond = 1e-9; // of the way: far above the rounding of its integral
  std::vector<double> knots;
  const auto add = [&](double way) {
    const double x = way / std::abs(hinge.latched - hinge.stowed);
    if (x > 0 && x < 1) knots.push_back(x);
  };
  for (const double time : motor.time) add(commanded_way(motor, std::max(time, 0.0)));
  for (const double way : turning_ways(motor)) // the moment may jump there
    for (const double side : {1 - beyond, 1 + beyond}) add(side * way);
  return parts_between(std::move(knots));
}

/// The x at which the hinge has an angle.
double travel_at(const Hinge& hinge, double angle) {
  return (angle - hinge.stowed) / (hinge.latched - hinge.stowed);
}

/// A table's knots on the travel, and the travel's ends, ascending: between them a curve is monotone.
std::vector<double> places_along(const TorqueTable& table, const Hinge& hinge) {
  std::vector<double> places{0, 1};
  for (const double angle : table.angle())
    if (const double x = travel_at(hinge, angle); x > 0 && x < 1) places.push_back(x);
  std::ranges::sort(places);
  return places;
}

void add_roots(const HingeTorque& torque, const Hinge& hinge, std::vector<double>& points) {
  if (!torque.table) {
    if (const auto x = root_of_line(torque)) points.push_back(*x);
    return;
  }
  const std::vector<double> places = places_along(*torque.table, hinge);
  const auto is_positive_at = [&](double x) { return torque_at(torque, hinge, x) > 0; };
  for (std::size_t k = 1; k < places.size(); ++k)
    if (is_positive_at(places[k - 1]) != is_positive_at(places[k]))
      points.push_back(root_between(torque, hinge, places[k - 1], places[k]));
}

/// Whether the damper acts at x. Both edges of its window count as inside.
bool acts_at(const Damper& damper, const Hinge& hinge, double x) {
  if (!damper.window) return true;
  const auto [from, to] = std::minmax((*damper.window)[0], (*damper.window)[1]);
  constexpr double slack = 1e-9; // rad: the edges' x are rounded
  const double angle = std::lerp(hinge.stowed, hinge.latched, x);
  return from - slack <= angle && angle <= to + slack;
}

/// The resisting torque of damper and viscous friction at a rate, N·m.
double damping_at(const Hinge& hinge, double x, double rate) {
  double torque = hinge.friction.scale * hinge.friction.viscous * rate;
  if (rate > 0 && hinge.damper && acts_at(*hinge.damper, hinge, x))
    torque -= damper_moment(damper_terms<double>(*hinge.damper), rate);
  return torque;
}

} // namespace

double add_terms(const Hinge& hinge, double x, double gear, const HingeExtras& extras,
                 TorqueTerms& terms) {
  const double size = std::abs(gear);
  const double spring = gear * torque_at(hinge.spring, hinge, x);
  const double motor = hinge.motor ? gear * stall_torque_at(hinge, x) : 0;
  const TorqueTerms& other = extras.other;
  terms.available += size * other.available + std::max(spring, 0.0) + std::max(motor, 0.0);
  terms.spring += size * other.spring + std::max(-spring, 0.0) + std::max(-motor, 0.0);
  terms.harness += size * other.harness + std::max(gear * torque_at(hinge.harness, hinge, x), 0.0);
  terms.friction += size * (other.friction + static_level_at(hinge, x));
  terms.damping += size * (other.damping + damping_at(hinge, x, extras.rate));
  terms.inertia += size * other.inertia;
  terms.motor += size * other.motor;
  terms.hysteresis += size * other.hysteresis;
  terms.adhesion += size * other.adhesion;
  terms.acceleration += size * other.acceleration;
  terms.delivered += size * other.delivered;
  return std::max(spring, 0.0);
}

TorqueTerms terms_at(const Hinge& hinge, double x, const HingeExtras& extras) {
  TorqueTerms terms;
  (void)add_terms(hinge, x, 1, extras, terms);
  return terms;
}

std::vector<double> turning_points(const Hinge& hinge) {
  std::vector<double> points{0, 1};
  add_roots(hinge.spring, hinge, points);
  add_roots(hinge.harness, hinge, points);
  std::ranges::sort(points);
  return points;
}

std::vector<double> places_of_least(const Hinge& hinge) {
  std::vector<double> points = turning_points(hinge);
  for (const HingeTorque* torque : {&hinge.spring, &hinge.harness})
    if (torque->table) {
      const std::vector<double> places = places_along(*torque->table, hinge);
      points.insert(points.end(), places.begin(), places.end());
    }
  if (hinge.motor && hinge.motor->table) {
    const std::vector<double> places = places_along(*hinge.motor, hinge);
    points.insert(points.end(), places.begin(), places.end());
  }
  if (hinge.damper && hinge.damper->window)
    for (const double angle : *hinge.damper->window)
      if (const double x = travel_at(hinge, angle); x > 0 && x < 1) points.push_back(x);
  std::ranges::sort(points);
  return points;
}

std::vector<double> parts_between(std::vector<double> knots) {
  // Heuristic: in an eighth of a piece the torque that a loop or a motor's command transmits is nearly a cubic. With fewer
  // parts a cubic fits it worse, and the least margin is sought at a place that is not the least.
  constexpr int parts = 8;
  knots.insert(knots.end(), {0, 1});
  std::ranges::sort(knots);
  std::vector<double> places{0};
  for (std::size_t k = 1; k < knots.size(); ++k)
    for (int part = 1; part <= parts; ++part)
      places.push_back(std::lerp(knots[k - 1], knots[k], static_cast<double>(part) / parts));
  return places;
}

} // namespace wingspread
