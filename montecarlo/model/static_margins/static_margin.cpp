#include "montecarlo/model/static_margins/static_margin.hpp"

#include <limits>

namespace wingspread {
namespace {

double margin(double available, double required) {
  if (required > 0) return available / required - 1;
  return available > 0 ? std::numeric_limits<double>::infinity() : -1;
}

double known(const TorqueTerms& t) { return t.inertia + t.spring + t.delivered; }

double variable(const TorqueTerms& t) {
  return t.motor + t.friction + t.hysteresis + t.harness + t.adhesion + t.damping;
}

double nasa_required(const TorqueTerms& t, const NasaFactors& f) {
  return f.fixed * known(t) + f.variable * variable(t);
}

} // namespace

double ecss_required(const TorqueTerms& t, const EcssFactors& f) {
  const double resisting = f.inertia * t.inertia + f.spring * t.spring + f.motor * t.motor +
                           f.friction * (t.friction + t.damping) + f.hysteresis * t.hysteresis +
                           f.harness * t.harness + f.adhesion * t.adhesion;
  return f.motorization * resisting + f.acceleration * t.acceleration + t.delivered;
}

double ecss_margin(const TorqueTerms& t, const EcssFactors& f) {
  return margin(f.available * t.available, ecss_required(t, f));
}

double nasa_static_margin(const TorqueTerms& t, const NasaFactors& f) {
  return margin(t.available, nasa_required(t, f));
}

double nasa_dynamic_margin(const TorqueTerms& t, const NasaFactors& f) {
  return margin(t.available, nasa_required(t, f) + f.acceleration * t.acceleration);
}

double phase_margin(const TorqueTerms& t, const PhaseFactors& f) {
  return margin(t.available, f.known * known(t) + f.variable * variable(t));
}

Margins margins_of(const TorqueTerms& terms, double largest_spring, const StaticMarginSpec& spec) {
  TorqueTerms weakened = terms;
  weakened.available -= largest_spring / static_cast<double>(spec.springs_per_hinge);
  return {ecss_margin(terms, spec.ecss), nasa_static_margin(terms, spec.nasa),
          nasa_static_margin(weakened, nasa_one_spring_out()), phase_margin(terms, spec.gevs),
          phase_margin(terms, spec.aiaa)};
}

} // namespace wingspread
