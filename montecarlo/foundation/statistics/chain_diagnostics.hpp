/// How far Markov chains of one parameter have come: nested split R̂ and
/// effective sample size.
///
///   symbol   meaning
///   M, N     number of half chains (each chain is split in two), and their
///   length W, B     mean of the half chains' variances; N times the variance
///   of their means ρ_k      autocorrelation at lag k over all half chains, 1 −
///   (W − mean of γ_k)/V, V = (N − 1)/N W + B/N K        groups of chains; a
///   group's first halves are a superchain, and its second halves another Wₛ,
///   Bₛ   mean of the superchains' variances (within their half chains, and
///   between those); variance of their means
///
///   ESS = M N / (1 + 2 Σ ρ_k), the sum as in autocorrelation_time
///   (likelihood.hpp)               (1) R̂   = √(1 + Bₛ/Wₛ) (2)
///
/// For chains at their goal, (2) is about √(1 + 2K/ESS). Groups of one chain
/// give the ordinary split R̂: some dozen short chains then need 200 effective
/// samples each to come below 1.01, however many are asked for. Of chains that
/// never move, m a group, (2) is √(1 + 1/m) or more.
///
/// Sources: (1) A. Gelman et al., Bayesian Data Analysis, third edition,
/// section 11.4–11.5; (2) C. Margossian et al., Nested R̂: assessing the
/// convergence of Markov chain Monte Carlo when running many short chains,
/// arXiv:2110.13017.
#pragma once

#include <span>
#include <vector>

namespace wingspread {

struct ChainDiagnostics {
  double r_hat = 0; ///< infinity if no half chain moves
  double ess = 0;   ///< at most M N
};

/// @param chains of equal length, at least 4
/// @param groups K, at most as many as chains; chain c is in group c mod K
[[nodiscard]] ChainDiagnostics diagnose(std::span<const std::vector<double>> chains,
                                        std::size_t groups);

} // namespace wingspread
