/// The bias of rank correlations in samples of independent rows.
///
///   symbol  meaning
///   n       rows
///   s_ij    sign of x_i − x_j; s'_ij of y
///   A_xy    Σ_i Σ_j Σ_k s_ij s'_ik: four times the sum of products of the centred mid-ranks
///   B_xy    Σ_i Σ_j s_ij s'_ij: the terms of A with j = k
///   τ       B_xy/√(B_xx B_yy), Kendall's τ_b
///   w_x     B_xx/A_xx, the share of those terms in a column's own sum: 3/(n + 1) without ties
///
/// A sample's correlation of ranks is A_xy/√(A_xx A_yy). The population's involves only the n(n − 1)(n − 2) terms with
/// j ≠ k. The n(n − 1) terms with j = k belong to Kendall's τ. So a population with the correlation ρ shows in samples
/// of n rows
///
///   r(ρ) = √((1 − w_x)(1 − w_y)) ρ + √(w_x w_y) τ                                             (1)
///
/// on average, numerator and denominator taken separately. The bias of ρ is small, of order 1/n; that of partial
/// correlations, which divide by 1 − R², is as large as their standard error at n = 100. A function f of correlations is
/// corrected as
///
///   f(r) − (f(r(r)) − f(r)) = 2 f(r) − f(r(r))                                                (2)
///
/// where r(r) stays a matrix of correlations, as f of the unbiased estimate of ρ need not. (1) without ties:
/// W. Hoeffding, Ann. Math. Statist. 19 (1948) 293–325, § 9.
#pragma once

#include <Eigen/Core>

#include <span>
#include <vector>

namespace wingspread {

/// The largest number of rows from which τ and w are computed, always the first ones. The error of τ is then 1/√500,
/// which changes (1) by 0.13/n; (1) itself has a standard error of about 1/√n.
inline constexpr std::size_t rank_bias_rows = 500;

class RankBias {
public:
  /// Cost O(k² m²) for k columns and m = min(n, rank_bias_rows) rows.
  /// @param columns values or ranks, equally long, finite, in an order that does not depend on them
  explicit RankBias(const std::vector<std::span<const double>>& columns);

  /// (1) for the columns x and y. @param correlation ρ; for NaN the result is NaN
  [[nodiscard]] double in_sample(std::size_t x, std::size_t y, double correlation) const;

private:
  Eigen::MatrixXd tau_;
  std::vector<double> weight_; ///< w for n rows
};

} // namespace wingspread
