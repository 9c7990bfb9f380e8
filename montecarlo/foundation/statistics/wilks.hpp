/// Guarantees from n independent runs, for any distribution: how many runs may break a requirement, how many runs are
/// needed, and tolerance limits.
///
/// Symbols: n runs; p the probability to be shown (the content of a tolerance interval); c the confidence; k runs
/// that break the requirement. "P ≥ p with confidence c" is shown if so few failures would be rare for P = p:
///
///   (1)  P(Bin(n, 1 − p) ≤ k) ≤ 1 − c
///
/// The order r of a tolerance limit is k + 1: (1) also states that the r-th largest of n values is at least the p
/// quantile with confidence c. Two-sided limits of order r leave out r − 1 on either side; k = 2r − 1. Sources: S.
/// S. Wilks, Ann. Math. Statist. 12 (1941) 91–96; H. A. David, H. N. Nagaraja, Order Statistics, 3rd ed. (2003),
/// §7.2.
#pragma once

#include "montecarlo/foundation/statistics/bounds.hpp"

#include <optional>
#include <span>

namespace wingspread {

/// The side of the values on which a limit lies.
enum class Side { upper, lower, both };

/// Largest n considered: for larger n the binomial law is computed with too few correct digits.
inline constexpr long most_runs_sized = 1'000'000'000'000;

/// The largest k of (1); nothing if n runs are too few even for k = 0. Cost O(log n) binomial probabilities.
/// @pre n ≥ 0, 0 < p < 1, 0 < c < 1
[[nodiscard]] std::optional<long> allowed_failures(long n, double p, double c);

/// The smallest n of (1) for k failures; nothing if above most_runs_sized.
/// @pre k ≥ 0, 0 < p < 1, 0 < c < 1
[[nodiscard]] std::optional<long> runs_to_show(double p, double c, long k);

/// The smallest n whose Clopper–Pearson interval is at most `width` wide for an observed share `proportion`; nothing
/// if above most_runs_sized. A half is the worst case.
/// @pre 0 < width < 1, 0 < confidence < 1, 0 ≤ proportion ≤ 1
[[nodiscard]] std::optional<long> runs_for_width(double width, double confidence,
                                                 double proportion);

/// The order r of the tolerance limits of n values; 0 if n is too small for any.
[[nodiscard]] long tolerance_order(long n, Side side, double p, double c);

/// The tolerance limits of n values: the narrowest that (1) allows, so that a share p of all possible draws lies within
/// them with confidence c. Two-sided limits leave out the same number of values on either side. No limit if n is too
/// small, or if the limit falls on an infinite value.
/// @param sorted smallest first, independent draws; ±∞ for values worse than any number
[[nodiscard]] Bounds tolerance_limits(std::span<const double> sorted, Side side, double p,
                                      double c);

} // namespace wingspread
