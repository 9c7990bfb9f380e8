/// Bounds of whatever can be worked out of all runs and again without a part of them: coefficients,
/// indices. No formula of its variance is needed.
///
///   symbol  meaning
///   G       groups of runs, independent of each other and about equally large: the replicates of a
///           design, or parts of independent draws
///   θ, θ_g  the number, from all runs and from all but group g's
///   s       standard error of θ
///
///   s² = (G − 1)/G Σ (θ_g − θ̄)²,  θ̄ = Σ θ_g / G                                             (1)
///
/// The bounds are θ ± t s with Student's t for G − 1 degrees of freedom. Source: J. Shao, D. Tu, The
/// Jackknife and Bootstrap (1995), §2.3 (delete-a-group).
#pragma once

#include "montecarlo/foundation/statistics/bounds.hpp"

#include <span>

namespace wingspread {

/// In how many groups independent draws are taken apart: t is within 9 % of the normal quantile at
/// 95 %, and a coefficient has to be worked out that often.
inline constexpr int jackknife_groups = 16;

/// None for G < 2, where a number is missing (NaN), and where all θ_g agree: that says nothing about
/// the error.
/// @param without_each θ_g
[[nodiscard]] Bounds jackknife_bounds(double value, std::span<const double> without_each,
                                      double confidence);

/// The same of a correlation, on the scale of Fisher's z = artanh, where its error is nearly normal:
/// the bounds lie within (−1, 1).
[[nodiscard]] Bounds jackknife_correlation_bounds(double coefficient,
                                                  std::span<const double> without_each,
                                                  double confidence);

} // namespace wingspread
