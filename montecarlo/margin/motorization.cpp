#include "montecarlo/margin/motorization.hpp"

#include "core/scene/torque.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace wingspread {
namespace {

double margin(double available, double required) {
  if (required > 0) return available / required - 1;
  return available > 0 ? std::numeric_limits<double>::infinity() : -1;
}

double nasa_required(const MotorizationTerms& t, const NasaFactors& f) {
  return f.fixed * (t.inertia + t.spring + t.delivered) +
         f.variable * (t.motor + t.friction + t.hysteresis + t.harness + t.adhesion);
}

/// Where a torque that is linear in the travel is zero.
std::optional<double> root_of_line(const HingeTorque& torque) {
  const double stowed = torque.scale * torque.torque_stowed + torque.offset;
  const double latched = torque.scale * torque.torque_latched + torque.offset;
  const double x = stowed / (stowed - latched);
  return x > 0 && x < 1 ? std::optional(x) : std::nullopt;
}

/// Where a torque is zero that changes its sense between two places.
double root_between(const HingeTorque& torque, const Hinge& hinge, double from, double to) {
  const bool sense = torque_at(torque, hinge, from) > 0;
  for (double middle = std::midpoint(from, to); from < middle && middle < to;
       middle = std::midpoint(from, to))
    ((torque_at(torque, hinge, middle) > 0) == sense ? from : to) = middle;
  return to;
}

/// The share of the way at which the hinge has an angle.
double travel_at(const Hinge& hinge, double angle) {
  return (angle - hinge.stowed) / (hinge.latched - hinge.stowed);
}

/// The ends of the travel and the knots of a table between them, and places between these.
std::vector<double> places_along(const TorqueTable& table, const Hinge& hinge) {
  constexpr int parts = 8; // of a cubic piece: its least lies hardly below that of their ends
  std::vector<double> knots{0, 1};
  for (const double angle : table.angle())
    if (const double x = travel_at(hinge, angle); x > 0 && x < 1) knots.push_back(x);
  std::ranges::sort(knots);
  std::vector<double> places{0};
  for (std::size_t k = 1; k < knots.size(); ++k)
    for (int part = 1; part <= parts; ++part)
      places.push_back(std::lerp(knots[k - 1], knots[k], static_cast<double>(part) / parts));
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

} // namespace

double ecss_required(const MotorizationTerms& t, const EcssFactors& f) {
  const double resisting = f.inertia * t.inertia + f.spring * t.spring + f.motor * t.motor +
                           f.friction * t.friction + f.hysteresis * t.hysteresis +
                           f.harness * t.harness + f.adhesion * t.adhesion;
  return f.motorization * resisting + f.acceleration * t.acceleration + t.delivered;
}

double ecss_margin(const MotorizationTerms& t, const EcssFactors& f) {
  return margin(f.available * t.available, ecss_required(t, f));
}

double nasa_static_margin(const MotorizationTerms& t, const NasaFactors& f) {
  return margin(t.available, nasa_required(t, f));
}

double nasa_dynamic_margin(const MotorizationTerms& t, const NasaFactors& f) {
  return margin(t.available, nasa_required(t, f) + f.acceleration * t.acceleration);
}

MotorizationTerms terms_at(const Hinge& hinge, double x, const MotorizationTerms& other) {
  MotorizationTerms terms = other;
  const double spring = torque_at(hinge.spring, hinge, x);
  terms.available += std::max(spring, 0.0);
  terms.spring += std::max(-spring, 0.0);
  terms.harness += std::max(torque_at(hinge.harness, hinge, x), 0.0);
  terms.friction += static_level_at(hinge, x);
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
  std::ranges::sort(points);
  return points;
}

} // namespace wingspread
