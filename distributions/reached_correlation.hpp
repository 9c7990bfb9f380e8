/// The rank correlation that draws of a Gaussian copula end up with, ties of discrete laws included.
///
/// With R the mid-rank of a draw as a share (its distribution function, at a tie the middle of its step), normal scores z_1,
/// z_2 correlated by r, p_k the steps of a law, and w_k the jump of its R at the score s_k between two steps,
///
///     ρ = cov(R_1, R_2)/√(V_1 V_2)          V = (1 − Σ p_k³)/12          w_k = (p_k + p_{k+1})/2          (1)
///
///     cov = Σ w_k T(s_k, r/√(2 − r²))          of a law with steps and a continuous one                    (2)
///     cov = Σ Σ w_k w_l ∫ exp(−(s_k² + s_l² − 2 s_k s_l sin θ)/(2 cos² θ)) dθ/2π,  θ from 0 to asin r      (3)
///
/// T is Owen's function: cov(1{z_1 > s}, Φ(z_2)) is that of two normal variables correlated by r/√2, one above s, one
/// above 0. Of two laws with steps, (3) is Plackett's integral of the covariance of 1{z_1 > s} and 1{z_2 > t}. Two
/// continuous laws reach the coefficient asked for.
/// Sources: D. B. Owen, Ann. Math. Statist. 27 (1956) 1075–1090; R. L. Plackett, Biometrika 41 (1954) 351–360.
#pragma once

#include "distributions/distribution.hpp"

namespace wingspread {

/// ρ by (1); of laws with more than 200 values to about 1e-3. @param spearman asked for. @return 0 if a law has a single value
/// @pre laws without faults, |spearman| < 1
[[nodiscard]] double reached_correlation(const Distribution& first, const Distribution& second,
                                         double spearman);

} // namespace wingspread
