/// Confidence bounds of proportions and quantiles from independent draws of any distribution, by the binomial law.
/// Exact for any n. (Dependent draws: replicate_bounds.hpp.)
///
/// Symbols: α = 1 − confidence; every interval leaves α/2 on either side, so each end by itself is a one-sided bound
/// with confidence 1 − α/2.
#pragma once

#include "montecarlo/foundation/statistics/bounds.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <optional>
#include <span>

namespace wingspread {

/// Clopper–Pearson interval of a proportion, from `hits` in `n` independent trials:
/// P(Bin(n, lower) ≥ hits) = P(Bin(n, upper) ≤ hits) = α/2. Covers the proportion with at least `confidence`.
/// [0, 1] for n = 0. Source: C. J. Clopper, E. S. Pearson, Biometrika 26 (1934) 404–413.
/// @pre 0 ≤ hits ≤ n, 0 < confidence < 1
[[nodiscard]] Interval clopper_pearson(long hits, long n, double confidence);

/// One-sided upper bound: the proportion at which `hits` or fewer have probability 1 − confidence. 1 for hits = n.
[[nodiscard]] double clopper_pearson_upper(long hits, long n, double confidence);

/// One-sided lower bound. 0 for hits = 0.
[[nodiscard]] double clopper_pearson_lower(long hits, long n, double confidence);

/// The interval for a share that need not be a whole number of hits; continuous in n.
/// @pre n > 0, 0 ≤ share ≤ 1
[[nodiscard]] Interval clopper_pearson_of_share(double share, double n, double confidence);

/// Ranks, from 1, of the order statistics that bound a quantile; nothing if no rank does.
struct RankBounds {
  std::optional<long> lower, upper;
};

/// The ranks with X_(lower) ≤ ξ_p ≤ X_(upper) with at least the given confidence, whatever the distribution:
/// lower is the largest l with P(Bin(n, p) ≤ l − 1) ≤ α/2, upper the smallest u with
/// P(Bin(n, p) ≥ u) ≤ α/2. Independent draws only. Cost O(log n) binomial probabilities.
/// Source: H. A. David, H. N. Nagaraja, Order Statistics, 3rd ed. (2003), §7.1.
/// @pre n ≥ 0, 0 < p < 1, 0 < confidence < 1
[[nodiscard]] RankBounds quantile_rank_bounds(long n, double p, double confidence);

/// As above over a sample with missing values: ranks among the present ones, none where a missing value has the rank. If
/// missing values may rank at either end, the lower bound has them below, the upper bound above.
[[nodiscard]] RankBounds quantile_rank_bounds(const PartialRanks& ranks, double p,
                                              double confidence);

/// The values at those ranks. @param sorted smallest first, independent draws; the present ones
[[nodiscard]] Bounds quantile_bounds(std::span<const double> sorted, const PartialRanks& ranks,
                                     double p, double confidence);
[[nodiscard]] Bounds quantile_bounds(std::span<const double> sorted, double p, double confidence);

} // namespace wingspread
