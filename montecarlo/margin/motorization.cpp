#include "montecarlo/margin/motorization.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wingspread {
namespace {

double torque_at(const LinearTorque& torque, double x) {
  return std::lerp(torque.torque_stowed, torque.torque_latched, x); // exact at the ends
}

double margin(double available, double required) {
  if (required > 0) return available / required - 1;
  return available > 0 ? std::numeric_limits<double>::infinity() : -1;
}

double nasa_required(const MotorizationTerms& t, const NasaFactors& f) {
  return f.fixed * (t.inertia + t.spring + t.delivered) +
         f.variable * (t.motor + t.friction + t.hysteresis + t.harness + t.adhesion);
}

void add_root(const LinearTorque& torque, std::vector<double>& points) {
  const double x = torque.torque_stowed / (torque.torque_stowed - torque.torque_latched);
  if (x > 0 && x < 1) points.push_back(x);
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
  const double spring = torque_at(hinge.spring, x);
  terms.available += std::max(spring, 0.0);
  terms.spring += std::max(-spring, 0.0);
  terms.harness += std::max(torque_at(hinge.harness, x), 0.0);
  const bool exact = hinge.friction.model == FrictionModel::exact;
  const double coulomb = hinge.friction.coulomb;
  terms.friction += exact ? hinge.friction.static_level.value_or(coulomb) : coulomb;
  return terms;
}

std::vector<double> turning_points(const Hinge& hinge) {
  std::vector<double> points{0, 1};
  add_root(hinge.spring, points);
  add_root(hinge.harness, points);
  std::ranges::sort(points);
  return points;
}

} // namespace wingspread
