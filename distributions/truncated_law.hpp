/// A continuous law truncated to an interval. A draw inverts the distribution function, so that one u gives one value,
/// as every design needs. Rejection was ruled out because a draw would take an unknown number of u.
///
///   symbol  meaning
///   F, Q    the law's own tails, P(X ≤ x) and P(X > x)
///   a, b    the interval's ends
///   m       the law's probability of [a, b]
#pragma once

#include "distributions/continuous_law.hpp"

namespace wingspread {

struct TruncatedLaw {
  ContinuousLaw law;
  Support bounds;  ///< [a, b]: the truncation within the law's support
  Tails lower;     ///< the law's tails at a
  Tails upper;     ///< the law's tails at b
  double mass = 1; ///< m; must be at least the smallest normal double
};

/// Truncates a law. The interval may be wider than the support.
[[nodiscard]] TruncatedLaw truncated(const ContinuousLaw& law, Truncation truncation);

/// The point with probability u below it, always within [a, b]:
/// F(x) = F(a) + m·u (1) or Q(x) = Q(b) + m·(1 − u) (2), whichever tail is smaller and so more exact. In an interval of
/// 10⁻ⁿ standard deviations about 16 − n digits of the width are resolved. Tails below 1e-308 (a normal law's beyond
/// 37.5 σ) are subnormal numbers with fewer digits.
[[nodiscard]] double quantile(const TruncatedLaw& law, double u);

/// The point with probability q above it.
[[nodiscard]] double quantile_complement(const TruncatedLaw& law, double q);

/// P(X ≤ x) and P(X > x) of the truncated law; x may be outside [a, b].
[[nodiscard]] double cdf(const TruncatedLaw& law, double x);
[[nodiscard]] double cdf_complement(const TruncatedLaw& law, double x);

} // namespace wingspread
