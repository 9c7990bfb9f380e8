/// Confidence bounds that assume no distribution: proportions and quantiles.
///
/// Two kinds of sample. Independent draws: binomial bounds, exact for any n. Replicates (scrambled
/// Sobol', Latin hypercubes, where draws depend on each other within a replicate and the replicates
/// are independent): Student's t on the replicates, right for many runs per replicate.
///
/// Symbols: α = 1 − confidence; every interval leaves α/2 on either side, so that each end on its
/// own is a one-sided bound with confidence 1 − α/2. R replicates.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace wingspread {

struct Interval {
  double lower, upper;
};

/// An interval whose ends may not exist: the sample is too small for them.
struct Bounds {
  std::optional<double> lower, upper;
};

/// Clopper–Pearson interval of a proportion of which `hits` of `n` independent trials were seen:
/// P(Bin(n, lower) ≥ hits) = P(Bin(n, upper) ≤ hits) = α/2. Never covers less than `confidence`.
/// [0, 1] for n = 0. Source: C. J. Clopper, E. S. Pearson, Biometrika 26 (1934) 404–413.
/// @pre 0 ≤ hits ≤ n, 0 < confidence < 1
[[nodiscard]] Interval clopper_pearson(long hits, long n, double confidence);

/// One-sided: the proportion above which `hits` or fewer would be seen with probability
/// 1 − confidence at most. 1 for hits = n.
[[nodiscard]] double clopper_pearson_upper(long hits, long n, double confidence);

/// One-sided, from below. 0 for hits = 0.
[[nodiscard]] double clopper_pearson_lower(long hits, long n, double confidence);

/// The same for a share that need not come to a whole number of hits; changes steadily with n.
/// @pre n > 0, 0 ≤ share ≤ 1
[[nodiscard]] Interval clopper_pearson_of_share(double share, double n, double confidence);

/// Ranks, from 1, of the order statistics that bound a quantile; none where no rank does.
struct RankBounds {
  std::optional<long> lower, upper;
};

/// X_(lower) ≤ ξ_p ≤ X_(upper) with the confidence asked for at least, whatever the distribution:
/// lower is the largest l with P(Bin(n, p) ≤ l − 1) ≤ α/2, upper the smallest u with
/// P(Bin(n, p) ≥ u) ≤ α/2. Independent draws only. Cost O(log n) binomial probabilities.
/// Source: H. A. David, H. N. Nagaraja, Order Statistics, 3rd ed. (2003), §7.1.
/// @pre n ≥ 0, 0 < p < 1, 0 < confidence < 1
[[nodiscard]] RankBounds quantile_rank_bounds(long n, double p, double confidence);

/// The values at those ranks. @param sorted smallest first, independent draws.
[[nodiscard]] Bounds quantile_bounds(std::span<const double> sorted, double p, double confidence);

/// A value and the replicate it comes from.
struct ReplicateValue {
  double value;
  int replicate; ///< in [0, R)
};

/// Bounds of a quantile from replicates: the values at which the pooled distribution function F is
/// p ∓ t s, where s is the standard error of F at the quantile itself, from the replicates' own
/// functions, as that of a ratio where they differ in size, and t Student's quantile for R − 1
/// degrees of freedom. (The mean of the replicates' quantiles would be biased. An s of each bound's
/// own place was ruled out: it is smallest where the replicates agree by chance, and the search
/// finds that place; bounds from two replicates missed in 10 to 20 % of all cases in place of 2.5.)
/// No bound where p ∓ t s is not within F, and none for R < 2 or where all replicates agree.
/// Cost O(n). Source: R. S. Woodruff, J. Amer. Statist. Assoc. 47 (1952) 635–646.
/// @param sorted smallest value first.
[[nodiscard]] Bounds replicate_quantile_bounds(std::span<const ReplicateValue> sorted,
                                               int replicates, double p, double confidence);

/// Standard error of the mean of all values, from the replicates' own means: √s² with
/// s² = R/(R − 1) · Σ_r (Σ_{i in r} (x_i − x̄))² / n², which is right for replicates that differ in
/// size too (a ratio estimator). NaN for R < 2 and without values. Cost O(n).
[[nodiscard]] double replicate_mean_error(std::span<const ReplicateValue> values, int replicates,
                                          double mean);

/// A proportion's interval from replicates: that of Clopper and Pearson for as many independent
/// draws as would have the standard error seen, fewer by (t_{n−1}/t_{R−1})² for its uncertainty. So
/// it holds for few hits too, where F ± t s would be too narrow above.
/// No bounds for R < 2, nor where all replicates agree: that says nothing about the error.
/// Source: E. L. Korn, B. I. Graubard, Survey Methodology 24 (1998) 193–201.
/// @param hits, sizes per replicate.
[[nodiscard]] Bounds replicate_proportion_bounds(std::span<const long> hits,
                                                 std::span<const long> sizes, double confidence);

} // namespace wingspread
