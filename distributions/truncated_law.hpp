/// A continuous law confined to an interval, by inverting its distribution function: one u, one
/// value, as every design needs (a rejection would use up an unknown number of them).
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
  double mass = 1; ///< m; the law can be drawn from when it is at least the smallest normal double
};

/// The law confined to the truncation, which may be wider than the law.
[[nodiscard]] TruncatedLaw truncated(const ContinuousLaw& law, Truncation truncation);

/// The point with the confined law's probability u below it, within [a, b] always:
/// F(x) = F(a) + m·u (1), Q(x) = Q(b) + m·(1 − u) (2), whichever is the smaller and so the exact
/// one. In an interval of 10⁻ⁿ standard deviations about 16 − n digits of its width are resolved;
/// far out, tails below 1e-308 (a normal law's beyond 37.5 σ) lose digits as numbers do there.
[[nodiscard]] double quantile(const TruncatedLaw& law, double u);

/// The point with the confined law's probability q above it.
[[nodiscard]] double quantile_complement(const TruncatedLaw& law, double q);

/// The confined law's P(X ≤ x) and P(X > x); x may be outside of [a, b].
[[nodiscard]] double cdf(const TruncatedLaw& law, double x);
[[nodiscard]] double cdf_complement(const TruncatedLaw& law, double x);

} // namespace wingspread
