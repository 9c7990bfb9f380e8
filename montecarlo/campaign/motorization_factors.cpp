#include "montecarlo/campaign/motorization_factors.hpp"

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

} // namespace wingspread
