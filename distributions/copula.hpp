/// Couples dispersions: a Gaussian copula with given rank correlations.
///
///   symbol  meaning
///   u, u'   a run's coordinates in (0, 1) as the design gives them, and coupled
///   ρ       Spearman's coefficient of two of the u'
///   r       correlation of their normal variables, z' = Φ⁻¹(u')
///   L       Cholesky's factor of the matrix of all r
///
///   r  = 2 sin(πρ/6)                                                                       (1)
///   z' = L Φ⁻¹(u),  u' = Φ(z')                                                             (2)
///
/// Source of (1): K. Pearson (1907); W. H. Kruskal, J. Amer. Statist. Assoc. 53 (1958) 814–861.
/// Each u' is uniform, so every law keeps its shape, also truncated and stepped ones. The draws of continuous laws have
/// the same ρ; in laws with steps, ties reduce it.
#pragma once

#include "distributions/continuous_law.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace wingspread {

/// ρ of two dispersions, by their indices. Pairs that are not named are independent.
struct RankCorrelation {
  std::size_t first = 0, second = 0;
  double spearman = 0;                ///< ρ, > −1 and < 1
  std::optional<double> covariance{}; ///< of two normal laws, if ρ was given by it
};

[[nodiscard]] double normal_correlation(double spearman);   ///< (1)
[[nodiscard]] double spearman_correlation(double normal_r); ///< its inverse

/// The symmetric matrix of all r of `count` dispersions, 1 on the diagonal.
/// @pre no pair is named twice
[[nodiscard]] Eigen::MatrixXd normal_correlations(std::size_t count,
                                                  std::span<const RankCorrelation> correlations);

/// L, lower triangular; nothing if the matrix is not positive definite by more than rounding. Eigen's factorization was
/// ruled out: the order of its sums depends on compiler options, and draws must not.
[[nodiscard]] std::optional<Eigen::MatrixXd> cholesky(const Eigen::MatrixXd& matrix);

/// The correlation matrix nearest to a symmetric one with a unit diagonal, by Frobenius' norm,
/// among those without an eigenvalue below `smallest`: alternating projections with Dykstra's
/// correction. Source: N. J. Higham, IMA J. Numer. Anal. 22 (2002) 329–343, algorithm 3.3.
/// @pre 0 < smallest < 1
[[nodiscard]] Eigen::MatrixXd nearest_correlations(const Eigen::MatrixXd& matrix, double smallest);

/// Couples a run's coordinates. Immutable, so one object serves all threads.
class GaussianCopula {
public:
  /// @param order of elimination, a permutation of the dispersions. A coupled coordinate depends on the dispersions
  ///   before it. So the first of a correlated group, and a dispersion without correlations, keep the design's u.
  /// @pre the matrix of the correlations is positive definite
  GaussianCopula(std::vector<std::size_t> order, std::span<const RankCorrelation> correlations);

  /// Whether no correlation was given.
  [[nodiscard]] bool is_independent() const { return independent_; }

  /// (2), with both tails of each u and u', so that no digits are lost near 1.
  /// @param u       each with both tails > 0
  /// @param coupled output, as long as `u`, not overlapping. Cost: some 50 ns for each u and each correlation
  void couple(std::span<const Tails> u, std::span<Tails> coupled) const;

private:
  /// One dispersion's part of (2).
  struct Row {
    std::size_t target;
    double own;                                          ///< L's diagonal
    std::vector<std::pair<std::size_t, double>> weights; ///< dispersions before it, L's row
  };
  std::vector<Row> rows_;
  bool independent_ = true;
};

} // namespace wingspread
