/// Rank correlations of an output with several columns: of each column alone, with bounds, and of each column given all
/// others (partial correlations).
///
///   symbol  meaning
///   n       rows
///   R       mid-ranks of a column over those rows (1 … n; ties share their mean)
///   ρ       Spearman's coefficient: Pearson's of R(x_j) and R(y)
///   C, c    correlations of the R(x) with each other, and with R(y)
///   b       C⁻¹c, the standardised regression of R(y) on all R(x)
///
///   r_j = b_j / √(b_j² + (1 − c·b) (C⁻¹)_jj)                                                 (1)
///   z = artanh ρ,  s² = (1 + ρ²/2)/(n − 3)                                                   (2)
///   s ≥ √(Σ ψ_i²)/(n (1 − ρ²))                                                               (3)
///
/// (1) is the partial rank correlation coefficient (PRCC): the correlation of x_j and y after the linear part of every
/// other column, in ranks, is subtracted from both. (1) equals the textbook's −P_jy/√(P_jj P_yy), with P the inverse of
/// the matrix of all correlations, but also holds if the columns x determine y completely. Where some of them determine
/// y alone, the others have no coefficient (0/0). (2) holds for independent rows, for ρ only,
/// and for columns that depend on each other about as normal ones do. Where a tenth of the runs have a weak spring and the
/// others an equal one, bounds by (2) of another draw cover 62 % in place of 90. The bounds therefore are the wider of
/// (2) and (3), with ψ_i the influence of row i on ρ (rank_correlation_error), for any law. Applied to partial
/// coefficients, nominal 95 % bounds by (2) cover 87 to 97 %, and with the variance 1/(n − k − 2) down to 79 %; so
/// partial coefficients are bounded by the jackknife (jackknife.hpp), after a correction of their bias (rank_bias.hpp).
/// Sources: R. L. Iman, W. J. Conover, Technometrics 21 (1979) 499–509;
/// (2), Fisher's z with ranks' variance: D. G. Bonett, T. A. Wright, Psychometrika 65 (2000) 23–28; ψ: W. Hoeffding, Ann.
/// Math. Statist. 19 (1948) 293–325, projections of U-statistics.
#pragma once

#include "montecarlo/foundation/platform/spilled.hpp"
#include "montecarlo/foundation/statistics/bounds.hpp"

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace wingspread {

/// Two-sided bounds of Spearman's coefficient, by the wider of (2) and (3); none for n ≤ 3. Of ±1 the inner bound is that
/// of the nearest coefficient of n rows.
/// @param error √(Σ ψ²)/n of the coefficient; 0: by (2) alone
/// @pre −1 ≤ coefficient ≤ 1, from independent rows
[[nodiscard]] Bounds rank_correlation_bounds(double coefficient, long n, double confidence,
                                             double error = 0);

/// The standard error √(Σ ψ_i²)/n of Spearman's coefficient of independent rows, for any law. Cost O(n).
///
///   u, v    mid-ranks of both columns from their mean, divided by n
///   S_uv    mean of u v; ρ = S_uv/√(S_uu S_vv)
///   G_i     mean over j of v_j where u_j > u_i, and of half of it where u_j = u_i
///
///   ψ_uv,i = u_i v_i + G_i(u; v) + G_i(v; u) − 3 S_uv
///   ψ_i = ψ_uv,i/√(S_uu S_vv) − ρ/2 (ψ_uu,i/S_uu + ψ_vv,i/S_vv)
///
/// @param a, b mid-ranks, 1 … n @return 0 if a column is constant
[[nodiscard]] double rank_correlation_error(std::span<const double> a, std::span<const double> b);

/// Partial correlations (1) of a quantity with each of k columns, given all others.
class PartialCorrelations {
public:
  using Matrix = Eigen::MatrixXd;

  /// Cost O(n k² + k³).
  /// @param columns k of them, equally long, finite
  /// @param threads as of thread_count (thread_pool.hpp)
  explicit PartialCorrelations(const std::vector<Spilled<double>>& columns, int threads = 1);

  /// The same columns with other correlations of those that vary. @pre a matrix of the size of correlations()
  [[nodiscard]] PartialCorrelations with(Matrix correlations) const;

  /// How many columns vary.
  [[nodiscard]] long varying() const { return static_cast<long>(varying_.size()); }
  /// The columns that vary.
  [[nodiscard]] std::span<const std::size_t> which_vary() const { return varying_; }
  /// C of the columns that vary.
  [[nodiscard]] const Matrix& correlations() const { return correlations_; }
  /// Whether one varying column is a linear combination of others.
  [[nodiscard]] bool entangled() const { return !inverse_; }

  /// R² of each column explained by all others, adjusted for their number: 1 − (n − 1)/((n − k) (C⁻¹)_jj). NaN for a
  /// constant column, and for all if entangled or n ≤ k.
  [[nodiscard]] std::vector<double> explained() const;

  /// r of each column: NaN for a constant column, and for all if y is constant, columns are entangled, or n ≤ k + 1.
  /// @param plain c: Pearson's correlation of each column with y; cost O(k²)
  [[nodiscard]] std::vector<double> given(std::span<const double> plain) const;

  /// The share of y's variance that the columns leave, 1 − R², adjusted for their number; at least 0. NaN where `given`
  /// is NaN for all.
  [[nodiscard]] double unexplained(std::span<const double> plain) const;

private:
  /// b of the varying columns, and c·b; nothing where `given` is NaN for all.
  struct Regression {
    std::vector<double> b;
    double explained = 0;
  };
  [[nodiscard]] std::optional<Regression> regression(std::span<const double> plain) const;

  std::size_t columns_;
  long rows_;
  std::vector<std::size_t> varying_;
  Matrix correlations_;           ///< C of the varying columns
  std::optional<Matrix> inverse_; ///< C⁻¹
};

} // namespace wingspread
