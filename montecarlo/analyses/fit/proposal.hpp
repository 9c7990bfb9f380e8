/// The fixed proposal of the sampler: a Student law around each mode, bent along the posterior.
///
///   symbol    meaning
///   u*, Σ     a mode and Laplace's covariance there, Σ = L Lᵀ
///   z         u = u* + L z
///   v, V      residuals of least_squares(), with the prior's; their Jacobian at u*, Σ⁻¹ = VᵀV
///   G(z)      (V L)ᵀ v(u* + L z), close to z near the mode
///
/// A posterior may be thin in some directions and as wide as the prior in others. It then bends by more than its
/// thickness, and no normal law follows it. So ξ is drawn from a Student law, and z solves G(z) = ξ: randomize, then
/// optimize (J. M. Bardsley et al., SIAM J. Sci. Comput. 36 (2014) A1895–A1910). The density of z is known exactly for
/// any invertible G, so a polynomial may replace G. A quadratic is fitted to runs with steps of Laplace's width. If its
/// draws would be accepted too seldom, a cubic is fitted to them: about 3 runs for each monomial, 500 for d = 8.
#pragma once

#include "montecarlo/analyses/fit/mode_search.hpp"
#include "montecarlo/analyses/sampler/ensemble_sampler.hpp"

#include <cstdint>

namespace wingspread {

/// @param seed of the draws that choose the cubic's runs @throws Stopped
[[nodiscard]] StudentMixture proposal_about(const std::vector<FitMode>& modes, const FitData& data,
                                            TestRuns& runs, std::uint64_t seed);

} // namespace wingspread
