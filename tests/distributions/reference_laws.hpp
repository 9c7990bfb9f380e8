/// Laws to test with, and their densities, written down from the definitions in long double.
#pragma once

#include "distributions/continuous_law.hpp"

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <cmath>
#include <numbers>
#include <vector>

namespace wingspread::test {

/// Each law in an everyday, a skewed and an extreme shape.
inline std::vector<ContinuousLaw> reference_laws() {
  return {Normal{0, 1},        Normal{1, 0.05},      Normal{-3, 1e-3},    Uniform{-1, 2},
          Uniform{1000, 1001}, Triangular{0, 0, 1},  Triangular{1, 2, 2}, Triangular{-1, 0.25, 2},
          Lognormal{0.1, 0.3}, Lognormal{0, 2},      Weibull{0.7, 2},     Weibull{3.5, 1.2},
          Weibull{20, 300},    Gamma{0.3, 2},        Gamma{4, 0.5},       Gamma{200, 0.01},
          Beta{2, 3, -1, 4},   Beta{0.5, 0.5, 0, 1}, Beta{0.5, 2, 0, 1},  Beta{1, 1, -1, 0},
          Beta{30, 4, 10, 20}, Exponential{0.25}};
}

using Long = long double;

inline Long density(const Normal& l, Long x) {
  const Long z = (x - l.mean) / l.std;
  return std::exp(-z * z / 2) / (l.std * std::sqrt(2 * std::numbers::pi_v<Long>));
}
inline Long density(const Uniform& l, Long) { return 1 / (Long(l.upper) - l.lower); }
inline Long density(const Triangular& l, Long x) {
  const Long peak = 2 / (Long(l.upper) - l.lower);
  return x < l.mode ? peak * (x - l.lower) / (Long(l.mode) - l.lower)
                    : peak * (l.upper - x) / (Long(l.upper) - l.mode);
}
inline Long density(const Lognormal& l, Long x) {
  return density(Normal{l.mu_log, l.sigma_log}, std::log(x)) / x;
}
inline Long density(const Weibull& l, Long x) {
  const Long t = x / l.scale;
  return l.shape / x * std::exp(l.shape * std::log(t) - std::pow(t, Long(l.shape)));
}
inline Long density(const Gamma& l, Long x) {
  const Long t = x / l.scale;
  return std::exp(l.shape * std::log(t) - t - std::lgamma(Long(l.shape))) / x;
}
inline Long density(const Beta& l, Long x) {
  const Long width = Long(l.upper) - l.lower;
  const Long a = l.alpha;
  const Long b = l.beta;
  return std::exp((a - 1) * std::log((x - l.lower) / width) +
                  (b - 1) * std::log((l.upper - x) / width) + std::lgamma(a + b) - std::lgamma(a) -
                  std::lgamma(b)) /
         width;
}
inline Long density(const Exponential& l, Long x) { return l.rate * std::exp(-l.rate * x); }
inline Long density(const ContinuousLaw& law, Long x) {
  return std::visit([x](const auto& l) { return density(l, x); }, law);
}

/// The probability of [a, b] within the support, by adaptive Gauss-Kronrod quadrature of the
/// density: independent of any distribution function. The rule's error estimate is that of its
/// lower order, so that its 1e-13 stands for far more digits.
inline Long probability(const ContinuousLaw& law, Long a, Long b) {
  const auto* triangle = std::get_if<Triangular>(&law);
  if (triangle && a < triangle->mode && triangle->mode < b) // the rule is for smooth densities
    return probability(law, a, triangle->mode) + probability(law, triangle->mode, b);
  const auto integrand = [&law](Long x) { return density(law, x); };
  return boost::math::quadrature::gauss_kronrod<Long, 61>::integrate(integrand, a, b, 9, 1e-13L);
}

} // namespace wingspread::test
