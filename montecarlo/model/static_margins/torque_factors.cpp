#include "montecarlo/model/static_margins/torque_factors.hpp"

namespace wingspread {

EcssFactors ecss_measured() {
  EcssFactors factors;
  factors.motor = 1.2;
  factors.friction = factors.hysteresis = factors.harness = 1.5;
  return factors;
}

NasaFactors nasa_development_test() { return {1.35, 2.5, 1.15}; }
NasaFactors nasa_acceptance() { return {1.25, 2, 1.1}; }
NasaFactors nasa_one_spring_out() { return {1, 1, 1}; }

PhaseFactors phase_factors(MarginPhase phase) {
  switch (phase) {
  case MarginPhase::preliminary_design:
    return {2, 4};
  case MarginPhase::critical_design:
    return {1.5, 3};
  case MarginPhase::test:
    break;
  }
  return {1.5, 2};
}

} // namespace wingspread
