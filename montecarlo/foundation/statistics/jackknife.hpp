/// Bounds of any statistic (a coefficient, an index) that can be computed from all runs and again without a part of the
/// runs. No formula of the statistic's variance is needed.
///
///   symbol  meaning
///   G       groups of runs, independent and about equally large: replicates of a design, or parts of the draws
///   θ, θ_g  the number from all runs, and from all but group g
///   s       standard error of θ
///
///   s² = (G − 1)/G Σ (θ_g − θ̄)²,  θ̄ = Σ θ_g / G                                             (1)
///
/// The bounds are θ ± t s with Student's t for G − 1 degrees of freedom. Source: J. Shao, D. Tu, The Jackknife and
/// Bootstrap (1995), §2.3 (delete-a-group).
#pragma once

#include "montecarlo/foundation/statistics/bounds.hpp"

#include <span>

namespace wingspread {

/// Groups that independent draws are split into. Heuristic: t for 15 degrees of freedom is within 9 % of the normal
/// quantile at 95 %, and the statistic is computed 16 times. Fewer groups widen the bounds, more take time.
inline constexpr int jackknife_groups = 16;

/// The bounds of θ. None for G < 2, if any θ_g is NaN, or if all θ_g are equal, which says nothing about the error.
/// @param without_each θ_g
[[nodiscard]] Bounds jackknife_bounds(double value, std::span<const double> without_each,
                                      double confidence);

/// Bounds of a correlation from those of its Fisher's z.
[[nodiscard]] Bounds from_z(const Bounds& z);

/// Bounds of a correlation, within (−1, 1): computed for Fisher's z = artanh(θ), whose error is nearly normal.
[[nodiscard]] Bounds jackknife_correlation_bounds(double coefficient,
                                                  std::span<const double> without_each,
                                                  double confidence);

} // namespace wingspread
