/// The rank correlation that draws of a Gaussian copula end up with, ties of discrete laws included.
///
/// With R the mid-rank of a draw as a share (its distribution function, at a tie the middle of its step),
/// normal scores z_1, z_2 correlated by r, and p_k the steps of a law,
///
///     ρ = (E[R_1 R_2] − 1/4)/√(V_1 V_2)          V = (1 − Σ p_k³)/12                       (1)
///     E[R_1 R_2] = ∫ E[R_1 | z_2] R_2(z_2) φ(z_2) dz_2
///
/// For a continuous law E[R_1 | z_2] = Φ(r z_2/√(2 − r²)), and without steps ρ is the coefficient asked for.
#pragma once

#include "distributions/distribution.hpp"

namespace wingspread {

/// ρ by (1), to about 1e-3. @param spearman asked for. @return 0 if a law has a single value
/// @pre laws without faults, |spearman| < 1
[[nodiscard]] double reached_correlation(const Distribution& first, const Distribution& second,
                                         double spearman);

} // namespace wingspread
