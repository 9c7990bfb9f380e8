/// The combinations of parameters that the tests determine, and the gain by a further test.
///
/// z are the normal scores of the parameters, with the correlations R of the priors. Let C be their covariance after the
/// tests, and C w = λ R w: λ is the share of the prior's variance that is left of the combination wᵀz. If λ is near 1, the
/// tests do not see it. (By z, not by u: of two correlated priors the second u is only what the first does not explain.)
#pragma once

#include "montecarlo/analyses/fit/mode_search.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// An eigenvector w of length 1, the largest weight positive, and √λ.
struct FitDirection {
  Eigen::VectorXd weights;
  double std_ratio = 0;
};

/// All directions, the least seen first. @param covariance C, over the samples @param prior R
[[nodiscard]] std::vector<FitDirection> directions_of(const Eigen::MatrixXd& covariance,
                                                      const Eigen::MatrixXd& prior);

/// Directions with at least this share of the prior's standard deviation count as unseen. Heuristic: 0.9 is 19 % of the
/// variance explained, less than would change a prediction.
inline constexpr double unseen_ratio = 0.9;
/// Parameters with a smaller weight in a direction are not named. Heuristic: 0.15² = 2 % of the direction.
inline constexpr double named_weight = 0.15;

/// A sentence: "the tests tell spring and friction only by their difference: …".
/// @param covariance, prior C and R: from them the combination that the tests do see
[[nodiscard]] std::string describe(const FitDirection& direction,
                                   const std::vector<std::string>& names,
                                   const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& prior);

/// For each parameter, the factor ≥ 1 by which the spread of the dispersions that are not fitted widens its standard
/// deviation.
///
/// A fit holds these dispersions at their medians. If they are off by one standard deviation of their laws, the mode
/// moves, to first order, by S = −(VᵀV)⁻¹VᵀV_h. V and V_h are the columns of the least squares' Jacobian for fitted and
/// for held dispersions. The factor is √(1 + L S R (L S)ᵀ/C), with R the correlations of the held ones, z = L u, and C the
/// covariance of z.
/// @param runs       of a space in which the held dispersions are parameters too, with normal laws (with_normal_laws)
/// @param at         the mode in that space, with the held dispersions at 0
/// @param fitted     indices of the fitted parameters in that space; all others are held
/// @param covariance C of the fitted parameters, in u
/// @param among_held R, in the order of the held dispersions in that space
/// @param coupling   L, of the fitted parameters
[[nodiscard]] std::vector<double>
widening_by_held(const FitData& data, const Prediction& prediction, TestRuns& runs,
                 const FitPoint& at, const std::vector<std::size_t>& fitted,
                 const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& among_held,
                 const Eigen::MatrixXd& coupling);

/// The gain of a candidate, a test that has not been made.
struct CandidateGain {
  std::string name;
  double information = 0; ///< expected, nats: ½ log of the ratio of determinants of the covariances
  std::vector<double> shrink; ///< of each parameter's standard deviation: after over before
};

/// Gains by the linear model at the mode: Laplace's covariance C becomes (C⁻¹ + JᵀJ/σ²)⁻¹, J the derivative of the
/// predictions. (Not the covariance of the samples: where the posterior is bent, that is far wider across its thin
/// direction than the model at the mode, and a repeated test would seem to tell more than the first.)
/// An unknown offset correlates the numbers of its column, with the covariance s².
/// @param runs of the candidates @param coupling L: z = L u
[[nodiscard]] std::vector<CandidateGain> candidate_gains(std::span<const FitTest> candidates,
                                                         TestRuns& runs, const FitMode& mode,
                                                         const Eigen::MatrixXd& coupling);

} // namespace wingspread
