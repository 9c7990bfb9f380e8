#include "montecarlo/foundation/statistics/wilks.hpp"

#include "distributions/math_policy.hpp"
#include "montecarlo/foundation/statistics/binomial_bounds.hpp"

#include <boost/math/distributions/binomial.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace wingspread {
namespace {

using Binomial = boost::math::binomial_distribution<double, MathPolicy>;

/// Whether a probability is at most 1 − c, up to round-off.
bool is_at_most_risk(double probability, double c) {
  return probability <= (1 - c) * (1 + 1e-12) + std::numeric_limits<double>::epsilon();
}

/// (1)
bool shows(long n, double p, double c, long k) {
  if (k >= n) return false;
  return is_at_most_risk(cdf(Binomial(static_cast<double>(n), 1 - p), static_cast<double>(k)), c);
}

/// Bisection: the least number in (first, last] for which holds() is true, or `last` if there is none.
/// @pre holds() is false up to some number and true beyond
template <class Holds> long least(long first, long last, const Holds& holds) {
  while (last - first > 1) {
    const long middle = first + (last - first) / 2;
    (holds(middle) ? last : first) = middle;
  }
  return last;
}

/// The least number of runs for which holds() is true. Doubles the number before bisecting, because small numbers are
/// cheaper to test.
template <class Holds> std::optional<long> least_runs(long more_than, const Holds& holds) {
  long last = more_than + 1;
  while (last < most_runs_sized && !holds(last)) last = std::min(2 * last, most_runs_sized);
  if (!holds(last)) return std::nullopt;
  return least(more_than, last, holds);
}

/// The width for a share of hits: decreases with n, unlike the width for whole numbers of hits.
double expected_width(long n, double confidence, double proportion) {
  const Interval interval =
      clopper_pearson_of_share(proportion, static_cast<double>(n), confidence);
  return interval.upper - interval.lower;
}

} // namespace

std::optional<long> allowed_failures(long n, double p, double c) {
  assert(n >= 0 && p > 0 && p < 1 && c > 0 && c < 1);
  if (!shows(n, p, c, 0)) return std::nullopt;
  return least(0, n, [&](long k) { return !shows(n, p, c, k); }) - 1;
}

std::optional<long> runs_to_show(double p, double c, long k) {
  assert(k >= 0 && p > 0 && p < 1 && c > 0 && c < 1);
  if (k >= most_runs_sized) return std::nullopt;
  return least_runs(k, [&](long n) { return shows(n, p, c, k); });
}

std::optional<long> runs_for_width(double width, double confidence, double proportion) {
  assert(width > 0 && width < 1 && proportion >= 0 && proportion <= 1);
  return least_runs(0, [&](long n) { return expected_width(n, confidence, proportion) <= width; });
}

long tolerance_order(long n, Side side, double p, double c) {
  const auto allowed = allowed_failures(n, p, c);
  if (!allowed) return 0;
  return side == Side::both ? (*allowed + 1) / 2 : *allowed + 1;
}

Bounds tolerance_limits(std::span<const double> sorted, Side side, double p, double c) {
  const long n = std::ssize(sorted), order = tolerance_order(n, side, p, c);
  if (order == 0) return {};
  const auto finite = [&](long index) {
    const double value = sorted[static_cast<std::size_t>(index)];
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
  };
  Bounds limits;
  if (side != Side::upper) limits.lower = finite(order - 1);
  if (side != Side::lower) limits.upper = finite(n - order);
  return limits;
}

} // namespace wingspread
