#include "distributions/continuous_law.hpp"
#include "tests/distributions/reference_laws.hpp"

#include <boost/math/quadrature/tanh_sinh.hpp>
#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

// Probabilities of one tail, deep ones included.
const std::vector<double> small_tails{1e-300, 1e-100, 1e-30, 0x1p-53, 1e-12, 1e-6,
                                      1e-3,   0.01,   0.1,   0.25,    0.4,   0.5};

double lower_quantile(const ContinuousLaw& law, double p) { return inverse(law, {p, 1 - p}); }
double upper_quantile(const ContinuousLaw& law, double q) { return inverse(law, {1 - q, q}); }

double shifted(double x, int ulps) {
  for (; ulps > 0; --ulps) x = std::nextafter(x, infinity);
  for (; ulps < 0; ++ulps) x = std::nextafter(x, -infinity);
  return x;
}

// The ratio by which a function's value at x ± 4 ulp may differ from the target: how far off the
// function is when an argument rounded to 4 ulp is forgiven.
double backward_error(const std::function<double(double)>& f, double x, double target) {
  const double low = f(shifted(x, -4));
  const double high = f(shifted(x, 4));
  const auto [least, most] = std::minmax(low, high);
  if (least <= target && target <= most) return 0;
  return std::min(std::abs(least / target - 1), std::abs(most / target - 1));
}

} // namespace

// Digits by mpmath 1.3 at 40 digits (root of the regularized incomplete function); the first ones
// are those of the NIST/SEMATECH e-Handbook, 1.3.6.7.
TEST_CASE("quantiles agree with published tables") {
  const auto agrees = [](double x, double published) {
    CAPTURE(x, published);
    CHECK(std::abs(x / published - 1) < 4 * epsilon);
  };
  agrees(upper_quantile(Normal{0, 1}, 0.025), 1.9599639845400542);
  agrees(upper_quantile(Normal{0, 1}, 0.001), 3.0902323061678135);
  agrees(lower_quantile(Normal{0, 1}, 0.001), -3.0902323061678135);
  agrees(upper_quantile(Gamma{0.5, 2}, 0.05), 3.8414588206941260); // χ², 1 degree of freedom
  agrees(upper_quantile(Gamma{5, 2}, 0.05), 18.307038053275147);   // χ², 10 degrees of freedom
  const double t = 2.2281388519862747;                             // Student's t, 10, 0.975
  agrees(lower_quantile(Beta{5, 0.5, 0, 1}, 0.05), 10 / (10 + t * t));
}

TEST_CASE("quantiles agree with closed forms in long double") {
  for (const double p : small_tails) {
    const Long lp = p;
    const auto agrees = [p](double x, Long exact) {
      CAPTURE(p, x, exact);
      CHECK(std::abs(x - exact) <= 4 * epsilon * std::abs(exact));
    };
    agrees(lower_quantile(Uniform{0, 3}, p), 3 * lp);
    agrees(upper_quantile(Exponential{0.25}, p), -4 * std::log(lp));
    agrees(lower_quantile(Exponential{0.25}, p), -4 * std::log1p(-lp));
    agrees(upper_quantile(Weibull{2, 3}, p), 3 * std::sqrt(-std::log(lp)));
    agrees(lower_quantile(Weibull{2, 3}, p), 3 * std::sqrt(-std::log1p(-lp)));
    agrees(lower_quantile(Triangular{0, 1, 2}, p), std::sqrt(2 * lp));
    agrees(lower_quantile(Triangular{0, 0, 2}, p), 2 * lp / (1 + std::sqrt(1 - lp)));
    agrees(upper_quantile(Triangular{-2, 0, 0}, p), -2 * lp / (1 + std::sqrt(1 - lp)));
    agrees(lower_quantile(Beta{1, 3, 0, 2}, p), -2 * std::expm1(std::log1p(-lp) / 3));
    agrees(upper_quantile(Beta{3, 1, -2, 0}, p), 2 * std::expm1(std::log1p(-lp) / 3));
    agrees(upper_quantile(Gamma{1, 2}, p), -2 * std::log(lp));
  }
}

// The tolerance: some epsilon of the functions' own, and what an epsilon of x is worth.
TEST_CASE("tails agree with quadrature of the density") {
  for (const ContinuousLaw& law : reference_laws()) {
    double a = lower_quantile(law, 1e-3);
    for (const double p : {0.01, 0.1, 0.3, 0.5, 0.8, 0.99}) {
      const double x = lower_quantile(law, p);
      CAPTURE(law.index(), a, x);
      const Long reference = probability(law, a, x);
      const double slack = 64 * epsilon * (1 + std::abs(x) * static_cast<double>(density(law, x)));
      CHECK(std::abs(tails(law, x).below - tails(law, a).below - reference) < slack);
      CHECK(std::abs(tails(law, a).above - tails(law, x).above - reference) < slack);
      a = x;
    }
  }
}

// The tolerance: some epsilon of the functions' own, and that of a tail like exp(−t), which loses
// t = −log p of them (it is the exponent whose relative error is epsilon).
TEST_CASE("the tail at a quantile is the probability asked for") {
  for (const ContinuousLaw& law : reference_laws())
    for (const double p : small_tails) {
      CAPTURE(law.index(), std::log10(p));
      const double tolerance = (16 - 4 * std::log(p)) * epsilon;
      const auto below = [&](double x) { return tails(law, x).below; };
      const auto above = [&](double x) { return tails(law, x).above; };
      CHECK(backward_error(below, lower_quantile(law, p), p) < tolerance);
      CHECK(backward_error(above, upper_quantile(law, p), p) < tolerance);
    }
}

TEST_CASE("the quantile of a point's tails is the point") {
  for (const ContinuousLaw& law : reference_laws())
    for (const double p : small_tails)
      for (const double x : {lower_quantile(law, p), upper_quantile(law, p)}) {
        const Tails at = tails(law, x);
        const double smaller = std::min(at.below, at.above);
        if (smaller < std::numeric_limits<double>::min()) continue;
        CAPTURE(law.index(), std::log10(p), x);
        const auto point = [&](double tail) {
          return at.below <= at.above ? lower_quantile(law, tail) : upper_quantile(law, tail);
        };
        const Support scale = support(law);
        const double size = std::isinf(scale.lower) ? std::abs(x) + std::get<Normal>(law).std : x;
        CHECK(backward_error(point, smaller, x) * std::abs(x / size) < 64 * epsilon);
      }
}

// There the inverse is a series of two terms, and beyond it a root finder.
TEST_CASE("the quantile of a point's tails is the point: points close to an end of a beta law") {
  std::mt19937_64 random(7);
  const auto log_uniform = [&](double lower, double upper) {
    return lower * std::pow(upper / lower, std::ldexp(static_cast<double>(random() >> 11), -53));
  };
  for (int k = 0; k < 400; ++k) {
    const Beta law{log_uniform(0.5, 20), log_uniform(0.5, 20), 0, 1};
    const Beta turned{law.beta, law.alpha, -1, 0}; // its upper end is the other's lower one
    const double x = log_uniform(1e-10, 1e-6) / (1 + law.beta);
    const Tails at = tails(law, x), at_turned = tails(turned, -x);
    CAPTURE(law.alpha, law.beta, x);
    CHECK(inverse(law, at) == Approx(x).epsilon(1e-12));
    CHECK(-inverse(turned, at_turned) == Approx(x).epsilon(1e-12));
  }
}

TEST_CASE("outside of the support there is no probability") {
  for (const ContinuousLaw& law : reference_laws()) {
    const Support within = support(law);
    CHECK(tails(law, -infinity).below == 0);
    CHECK(tails(law, -infinity).above == 1);
    CHECK(tails(law, infinity).below == 1);
    CHECK(tails(law, infinity).above == 0);
    CHECK(tails(law, within.lower - 1).below == 0);
    CHECK(tails(law, within.upper + 1).above == 0);
    CHECK(inverse(law, {0, 1}) == within.lower);
    CHECK(inverse(law, {1, 0}) == within.upper);
  }
}

TEST_CASE("supports are what the laws' definitions say") {
  CHECK(support(Normal{1, 2}).lower == -infinity);
  CHECK(support(Normal{1, 2}).upper == infinity);
  CHECK(support(Gamma{1, 2}).lower == 0);
  CHECK(support(Gamma{1, 2}).upper == infinity);
  CHECK(support(Beta{1, 2, -3, 4}).lower == -3);
  CHECK(support(Beta{1, 2, -3, 4}).upper == 4);
}

// ∫ x(u) du and ∫ (x(u) − mean)² du over (0, 1), the upper half through the complement.
TEST_CASE("moments agree with quadrature of the quantile") {
  boost::math::quadrature::tanh_sinh<double> rule;
  for (const ContinuousLaw& law : reference_laws()) {
    const auto [mean, standard_deviation] = continuous_moments(law);
    const auto moment = [&](int power) {
      const auto both = [&](double p) {
        return std::pow(lower_quantile(law, p) - mean, power) +
               std::pow(upper_quantile(law, p) - mean, power);
      };
      return rule.integrate(both, 0., 0.5);
    };
    CAPTURE(law.index(), mean, standard_deviation);
    CHECK(std::abs(moment(1)) < 1e-9 * standard_deviation);
    CHECK(std::abs(moment(2) / std::pow(standard_deviation, 2) - 1) < 1e-9);
  }
}
