/// The likelihood of measured numbers, given predictions.
///
///   symbol   meaning
///   r_i      measured − predicted, i = 1 … n of a channel
///   σ, s     noise of a channel; standard deviation of its constant offset b, a priori N(0, s²)
///   κ        n_eff/n: the share of independent information in the channel (1 unless tempered)
///
/// Known σ, offset integrated out:
///   −log L = κ Σ (r_i − b̂)²/2σ² + b̂²/2s² + const,  b̂ = (κ Σ r_i/σ²) / (1/s² + κ n/σ²)            (1)
/// Unknown σ, with the prior 1/σ integrated out (Student's law):
///   −log L = ½ κ n log Σ r_i² + const                                                             (2)
///
/// (1) is exact: the exponent is quadratic in b, with its minimum at b̂ and a second derivative that is a constant.
#pragma once

#include "montecarlo/analyses/fit/test_runs.hpp"

namespace wingspread {

/// A channel's residuals at a point.
struct ChannelFit {
  double log_likelihood = 0; ///< −∞ if a number is missing
  double sum_of_squares = 0; ///< Σ (r_i − b̂)²
  double chi_squared = 0;    ///< the same over σ²; NaN for unknown σ
  double offset = 0;         ///< b̂
};
[[nodiscard]] ChannelFit fit_of(const FitData& data, const Channel& channel,
                                const Prediction& prediction);

/// The posterior predictive p-value of channels together: the mean over points of the posterior of
/// P(χ²(Σ n_eff) ≥ Σ κ χ²). κ χ² is the sum over n_eff independent numbers.
/// @return NaN if a channel's σ is not known
[[nodiscard]] double p_value_of(const FitData& data, std::span<const Channel> channels,
                                std::span<const Prediction> predictions);

/// Residuals r_i − b̂ of a channel.
[[nodiscard]] std::vector<double> residuals_of(const FitData& data, const Channel& channel,
                                               const Prediction& prediction);

/// The residuals of a channel that lie far from the others: beyond six times the larger of σ and 1.4826 median|r| (the
/// second estimates σ of normal residuals; of a million of these 0.002 lie beyond). None of fewer than five residuals.
/// None if several lie beyond and are more than a twentieth: then the model is wrong, not the samples.
/// @param std σ; nothing: unknown
/// @return indices, the furthest first
[[nodiscard]] std::vector<std::size_t> outliers_of(std::span<const double> residuals,
                                                   std::optional<double> std);

/// log of prior and likelihood at a point, up to a constant.
[[nodiscard]] double log_posterior(const FitData& data, const FitPoint& at,
                                   const Prediction& prediction);

/// The residuals v of a least-squares problem with the same minimum: ½|v|² = −log posterior + const. A channel of
/// unknown σ has the weight κ n/Σ r². Its Σ r² is fixed at the value in `squares`, so the equation holds where Σ r² has
/// this value; the search repeats with new squares until it does.
/// @param squares Σ r² of each channel, for those with unknown σ
[[nodiscard]] Eigen::VectorXd least_squares(const FitData& data, std::span<const double> squares,
                                            const FitPoint& at, const Prediction& prediction);
/// The number of residuals of least_squares().
[[nodiscard]] std::size_t least_squares_size(const FitData& data, std::size_t parameters);

/// τ = 1 + 2 Σ ρ_k of a sequence: so many residuals have the information of one independent residual; at least 1. The
/// sum ends before the first pair ρ_2k + ρ_2k+1 below its noise, 2 √(2/n), and a pair counts at most as much as the
/// pair before (C. J. Geyer, Statist. Sci. 7 (1992) 473–483, who ends at 0: then 106 independent residuals count as
/// 94).
[[nodiscard]] double autocorrelation_time(std::span<const double> values);

/// Sets `effective` of each correlated channel with more than one number from its residuals' autocorrelation.
void temper(std::span<const FitTest> tests, const Prediction& prediction, FitData& data);

} // namespace wingspread
