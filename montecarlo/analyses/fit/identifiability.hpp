/// Which combinations of parameters the tests see, and how much a further test would tell.
///
/// In u the prior's covariance is the identity. An eigenvalue λ of the posterior's covariance is the share of the prior's
/// variance that is left along its eigenvector: near 1, the tests do not see this direction.
#pragma once

#include "montecarlo/analyses/fit/mode_search.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// An eigenvector, the largest weight positive, and √λ.
struct FitDirection {
  Eigen::VectorXd weights;
  double std_ratio = 0;
};

/// All directions, the least seen first. @param covariance of u, over the samples
[[nodiscard]] std::vector<FitDirection> directions_of(const Eigen::MatrixXd& covariance);

/// Directions with at least this share of the prior's standard deviation count as unseen. Heuristic: 0.9 is 19 % of the
/// variance explained, less than would change a prediction.
inline constexpr double unseen_ratio = 0.9;
/// Smaller weights are not named.
inline constexpr double named_weight = 0.15;

/// A sentence: "the tests see only the difference of spring and friction: …".
/// @param covariance for the combination that is seen in place of the unseen one
[[nodiscard]] std::string describe(const FitDirection& direction,
                                   const std::vector<std::string>& names,
                                   const Eigen::MatrixXd& covariance);

/// By how much the spread of dispersions that are not fitted widens each parameter's standard deviation, at least 1.
///
/// A fit holds them at their medians. To first order the mode moves by S = −(VᵀV)⁻¹VᵀV_h for one standard deviation of
/// each of them, with V and V_h the columns of the least squares' Jacobian of fitted and of held dispersions: √(1 + ΣS²/C)
/// @param runs       of a space in which the held ones are parameters too
/// @param at         the mode in that space, held ones at 0
/// @param fitted     places of the fitted parameters in that space; all others are held
/// @param covariance C of the fitted parameters, in u
[[nodiscard]] std::vector<double> widening_by_held(const FitData& data,
                                                   const Prediction& prediction, TestRuns& runs,
                                                   const FitPoint& at,
                                                   const std::vector<std::size_t>& fitted,
                                                   const Eigen::MatrixXd& covariance);

/// What a test that has not been made would tell.
struct CandidateGain {
  std::string name;
  double information = 0; ///< expected, nats: ½ log of the ratio of determinants of the covariances
  std::vector<double> shrink; ///< of each parameter's standard deviation: after over before
};

/// By the linear model at the mode: covariance C becomes (C⁻¹ + JᵀJ/σ²)⁻¹. An offset adds s² to all its numbers.
/// @param runs of the candidates
[[nodiscard]] std::vector<CandidateGain> candidate_gains(std::span<const FitTest> candidates,
                                                         TestRuns& runs, const FitPoint& mode,
                                                         const Eigen::MatrixXd& covariance);

} // namespace wingspread
