#include "montecarlo/model/static_margins/static_margin.hpp"

#include <fmt/format.h>

#include <limits>

namespace wingspread {
namespace {

double margin(const TorqueQuotient& torques) {
  if (torques.required > 0) return torques.available / torques.required - 1;
  return torques.available > 0 ? std::numeric_limits<double>::infinity() : -1;
}

double known(const TorqueTerms& t) { return t.inertia + t.spring + t.delivered; }

double variable(const TorqueTerms& t) {
  return t.motor + t.friction + t.hysteresis + t.harness + t.adhesion + t.damping;
}

double nasa_required(const TorqueTerms& t, const NasaFactors& f) {
  return f.fixed * known(t) + f.variable * variable(t);
}

double phase_required(const TorqueTerms& t, const PhaseFactors& f) {
  return f.known * known(t) + f.variable * variable(t);
}

} // namespace

double ecss_required(const TorqueTerms& t, const EcssFactors& f) {
  const double resisting = f.inertia * t.inertia + f.spring * t.spring + f.motor * t.motor +
                           f.friction * (t.friction + t.damping) + f.hysteresis * t.hysteresis +
                           f.harness * t.harness + f.adhesion * t.adhesion;
  return f.motorization * resisting + f.acceleration * t.acceleration + t.delivered;
}

double ecss_margin(const TorqueTerms& t, const EcssFactors& f) {
  return margin({f.available * t.available, ecss_required(t, f)});
}

double nasa_static_margin(const TorqueTerms& t, const NasaFactors& f) {
  return margin({t.available, nasa_required(t, f)});
}

double nasa_dynamic_margin(const TorqueTerms& t, const NasaFactors& f) {
  return margin({t.available, nasa_required(t, f) + f.acceleration * t.acceleration});
}

double phase_margin(const TorqueTerms& t, const PhaseFactors& f) {
  return margin({t.available, phase_required(t, f)});
}

std::array<TorqueQuotient, margin_kind_names.size()>
torque_quotients(const TorqueTerms& terms, double largest_spring, const StaticMarginSpec& spec) {
  const double weakened =
      terms.available - largest_spring / static_cast<double>(spec.springs_per_hinge);
  return {{{spec.ecss.available * terms.available, ecss_required(terms, spec.ecss)},
           {terms.available, nasa_required(terms, spec.nasa)},
           {weakened, nasa_required(terms, nasa_one_spring_out())},
           {terms.available, phase_required(terms, spec.gevs)},
           {terms.available, phase_required(terms, spec.aiaa)}}};
}

Margins margins_of(const TorqueTerms& terms, double largest_spring, const StaticMarginSpec& spec) {
  const auto quotients = torque_quotients(terms, largest_spring, spec);
  Margins margins;
  for (std::size_t kind = 0; kind < margins.size(); ++kind) margins[kind] = margin(quotients[kind]);
  return margins;
}

std::string formula_of(MarginKind kind, const StaticMarginSpec& spec) {
  const auto by_class = [](double fixed, double variable) {
    return fmt::format("T / ({:.4g} ΣT_fixed + {:.4g} ΣT_variable) − 1", fixed, variable);
  };
  const EcssFactors& f = spec.ecss;
  switch (kind) {
  case MarginKind::ecss:
    return fmt::format(
        "{:.4g} T / T_min − 1, T_min = {:.4g} ({:.4g} I + {:.4g} S + {:.4g} HM + {:.4g} FR + "
        "{:.4g} HY + {:.4g} HA + {:.4g} HD) + {:.4g} TD + TL",
        f.available, f.motorization, f.inertia, f.spring, f.motor, f.friction, f.hysteresis,
        f.harness, f.adhesion, f.acceleration);
  case MarginKind::nasa:
    return by_class(spec.nasa.fixed, spec.nasa.variable);
  case MarginKind::nasa_one_spring_out:
    return fmt::format("(T − T_s/{}) / (ΣT_fixed + ΣT_variable) − 1, T_s the largest spring torque "
                       "of one hinge",
                       spec.springs_per_hinge);
  case MarginKind::gevs:
    return by_class(spec.gevs.known, spec.gevs.variable);
  case MarginKind::aiaa:
    break;
  }
  return by_class(spec.aiaa.known, spec.aiaa.variable);
}

} // namespace wingspread
