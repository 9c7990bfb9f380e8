#include "distributions/continuous_law.hpp"

#include "distributions/math_policy.hpp"

#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/exponential.hpp>
#include <boost/math/distributions/gamma.hpp>
#include <boost/math/distributions/lognormal.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/uniform.hpp>
#include <boost/math/distributions/weibull.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

namespace wingspread {
namespace {

namespace bm = boost::math;

auto boost_law(const Normal& l) {
  return bm::normal_distribution<double, MathPolicy>(l.mean, l.std);
}
auto boost_law(const Uniform& l) {
  return bm::uniform_distribution<double, MathPolicy>(l.lower, l.upper);
}
auto boost_law(const Lognormal& l) {
  return bm::lognormal_distribution<double, MathPolicy>(l.mu_log, l.sigma_log);
}
auto boost_law(const Weibull& l) {
  return bm::weibull_distribution<double, MathPolicy>(l.shape, l.scale);
}
auto boost_law(const Gamma& l) {
  return bm::gamma_distribution<double, MathPolicy>(l.shape, l.scale);
}
auto boost_law(const Beta& l) { return bm::beta_distribution<double, MathPolicy>(l.alpha, l.beta); }
auto boost_law(const Exponential& l) {
  return bm::exponential_distribution<double, MathPolicy>(l.rate);
}

template <class L> Support support_of(const L& law) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if constexpr (requires { law.lower; })
    return {law.lower, law.upper};
  else
    return {std::same_as<L, Normal> ? -infinity : 0., infinity};
}

template <class L> Tails tails_of(const L& law, double x) {
  const auto boost = boost_law(law);
  return {bm::cdf(boost, x), bm::cdf(bm::complement(boost, x))};
}

// Boost's beta law has the support [0, 1]. Near the upper end only the distance to this end is exact, so there the law
// is mirrored.
Tails tails_of(const Beta& law, double x) {
  const double from_lower = (x - law.lower) / (law.upper - law.lower);
  const double to_upper = (law.upper - x) / (law.upper - law.lower);
  if (from_lower <= to_upper)
    return {bm::ibeta(law.alpha, law.beta, from_lower, MathPolicy()),
            bm::ibetac(law.alpha, law.beta, from_lower, MathPolicy())};
  return {bm::ibetac(law.beta, law.alpha, to_upper, MathPolicy()),
          bm::ibeta(law.beta, law.alpha, to_upper, MathPolicy())};
}

// Boost's triangular law computes one tail as 1 minus the other beyond the mode, which loses digits of a small tail.
// Here each tail is computed from its own end of the triangle: `near` and `far` are the distances of that end and of
// the other end from the mode. Equation (1) is in the distance s from the tail's own end.
//   tail·(near + far) = s²/near within near, else near + t(2 far − t)/far with t = s − near  (1)
double triangular_tail(double near, double far, double s) {
  const double t = s - near;
  return (t <= 0 ? s * s / near : near + t * (2 * far - t) / far) / (near + far);
}

// (1) solved for the distance s from the end.
double triangular_distance(double near, double far, double tail) {
  const double width = near + far;
  const double beyond = tail * width - near;
  if (beyond <= 0) return std::sqrt(tail * width * near);
  return near + beyond * far / (far + std::sqrt(far * std::max(far - beyond, 0.)));
}

Tails tails_of(const Triangular& l, double x) {
  return {triangular_tail(l.mode - l.lower, l.upper - l.mode, x - l.lower),
          triangular_tail(l.upper - l.mode, l.mode - l.lower, l.upper - x)};
}

template <class L> double inverse_of(const L& law, Tails tails) {
  const auto boost = boost_law(law);
  return tails.below <= tails.above ? bm::quantile(boost, tails.below)
                                    : bm::quantile(bm::complement(boost, tails.above));
}

/// A point's distances from both ends of a beta law, in widths of its support.
struct Distances {
  double near; ///< from the end that the tail belongs to
  double far;
};

// Boost's root finder is inaccurate for tiny distances with some half-integer exponents (a = ½, b = 2: wrong by a
// factor of 100). For these distances two terms of the series are enough:
//   tail = x^a/(a B(a, b))·(1 − a(b − 1)/(a + 1) x + …), so x = f + (b − 1)/(a + 1) f² + …  (2)
// with f the solution of the first term. Where f underflows, Boost's result is used.
Distances beta_distances(double a, double b, double tail) {
  const double f = std::pow(tail * a * bm::beta(a, b, MathPolicy()), 1 / a);
  if (f > 0 && f * (1 + b) < 1e-8) {
    const double near = f + (b - 1) / (a + 1) * f * f; // (2); the omitted terms are below epsilon
    return {near, 1 - near};
  }
  double far = 0;
  const double near = bm::ibeta_inv(a, b, tail, &far, MathPolicy());
  return {near, far};
}

double inverse_of(const Beta& law, Tails tails) {
  const bool upwards = tails.below <= tails.above;
  const Distances at = upwards ? beta_distances(law.alpha, law.beta, tails.below)
                               : beta_distances(law.beta, law.alpha, tails.above);
  const double from_lower = upwards ? at.near : at.far;
  const double to_upper = upwards ? at.far : at.near;
  const double width = law.upper - law.lower;
  return from_lower <= to_upper ? law.lower + width * from_lower : law.upper - width * to_upper;
}

double inverse_of(const Triangular& l, Tails tails) {
  if (tails.below <= tails.above)
    return l.lower + triangular_distance(l.mode - l.lower, l.upper - l.mode, tails.below);
  return l.upper - triangular_distance(l.upper - l.mode, l.mode - l.lower, tails.above);
}

template <class L> LawMoments continuous_moments_of(const L& law) {
  const auto boost = boost_law(law);
  return {bm::mean(boost), bm::standard_deviation(boost)};
}

LawMoments continuous_moments_of(const Triangular& l) {
  const double rise = l.mode - l.lower;
  const double fall = l.upper - l.mode;
  return {(l.lower + l.mode + l.upper) / 3,
          std::sqrt((rise * rise + rise * fall + fall * fall) / 18)};
}

LawMoments continuous_moments_of(const Beta& law) {
  const auto boost = boost_law(law);
  const double width = law.upper - law.lower;
  return {law.lower + width * bm::mean(boost), width * bm::standard_deviation(boost)};
}

} // namespace

Support support(const ContinuousLaw& law) {
  return std::visit([](const auto& l) { return support_of(l); }, law);
}

Tails tails(const ContinuousLaw& law, double x) {
  const Support within = support(law);
  if (x <= within.lower) return {0, 1};
  if (x >= within.upper) return {1, 0};
  return std::visit([x](const auto& l) { return tails_of(l, x); }, law);
}

double inverse(const ContinuousLaw& law, Tails tails) {
  const Support within = support(law);
  if (tails.below <= 0) return within.lower;
  if (tails.above <= 0) return within.upper;
  const double x = std::visit([tails](const auto& l) { return inverse_of(l, tails); }, law);
  return std::clamp(x, within.lower, within.upper);
}

LawMoments continuous_moments(const ContinuousLaw& law) {
  return std::visit([](const auto& l) { return continuous_moments_of(l); }, law);
}

} // namespace wingspread
