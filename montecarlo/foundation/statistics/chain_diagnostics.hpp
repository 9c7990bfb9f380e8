/// How far Markov chains of one parameter have come: split R̂ and effective sample size.
///
///   symbol   meaning
///   M, N     number of half chains (each chain is split in two), and their length
///   W, B     mean of the half chains' variances; N times the variance of their means
///   ρ_k      autocorrelation at lag k over all half chains, 1 − (W − mean of γ_k)/V, V = (N − 1)/N W + B/N
///
///   R̂   = √(V/W)                                                                              (1)
///   ESS = M N / (1 + 2 Σ ρ_k), the sum as in autocorrelation_time (likelihood.hpp)               (2)
///
/// Source: A. Gelman et al., Bayesian Data Analysis, third edition, section 11.4–11.5.
#pragma once

#include <span>
#include <vector>

namespace wingspread {

struct ChainDiagnostics {
  double r_hat = 0; ///< infinity if no half chain moves
  double ess = 0;   ///< at most M N
};

/// @param chains of equal length, at least 4
[[nodiscard]] ChainDiagnostics diagnose(std::span<const std::vector<double>> chains);

} // namespace wingspread
