/// Confidence bounds from replicates of a design: scrambled Sobol' points and Latin hypercubes, where
/// draws depend on each other within a replicate and the replicates are independent. Student's t on
/// the replicates, right for many runs per replicate, assuming no distribution of the values.
///
/// Symbols: R replicates; α = 1 − confidence; every interval leaves α/2 on either side.
#pragma once

#include "montecarlo/foundation/statistics/bounds.hpp"

#include <span>

namespace wingspread {

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
