#include "distributions/continuous_law.hpp"

#include <cmath>
#include <cstddef>
#include <numeric>

namespace wingspread {
namespace {

LawMoments moments_of(const Discrete& law) {
  const double total = std::accumulate(law.weights.begin(), law.weights.end(), 0.);
  LawMoments result;
  for (std::size_t i = 0; i < law.values.size(); ++i)
    result.mean += law.weights[i] / total * law.values[i];
  double variance = 0;
  for (std::size_t i = 0; i < law.values.size(); ++i)
    variance += law.weights[i] / total * std::pow(law.values[i] - result.mean, 2);
  result.standard_deviation = std::sqrt(variance);
  return result;
}

LawMoments moments_of(const Empirical& law) {
  return moments_of(Discrete{law.values, std::vector<double>(law.values.size(), 1.)});
}

LawMoments moments_of(const Constant& law) { return {law.value, 0}; }

template <Continuous L> LawMoments moments_of(const L& law) { return continuous_moments(law); }

} // namespace

LawMoments moments(const Law& law) {
  return std::visit([](const auto& l) { return moments_of(l); }, law);
}

} // namespace wingspread
