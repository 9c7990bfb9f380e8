/// An empirical distribution function at a few of its steps, with its confidence band.
///
/// Independent draws: the band of Dvoretzky, Kiefer and Wolfowitz with Massart's constant, F ± √(ln(2/α)/(2n)). It holds
/// for the whole curve at once, whatever the distribution, and for any n.
/// Replicates of a design: at each knot by itself, the interval of Korn and Graubard (replicate_bounds.hpp).
/// Source: P. Massart, Ann. Probab. 18 (1990) 1269–1283.
#pragma once

#include "montecarlo/foundation/statistics/replicate_bounds.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace wingspread {

struct CurveKnot {
  double x = 0;
  double p = 0; ///< the share of values ≤ x
  Bounds band{};
};

/// Ranks, from 1 to n, of the order statistics that a curve of n values is drawn through: half of them evenly, a quarter
/// towards either end as a geometric series, for there are the values that requirements are about. Ascending, each once.
/// @pre n ≥ 1, most ≥ 5
[[nodiscard]] std::vector<long> curve_ranks(long n, std::size_t most);

/// @param sorted smallest first
/// @param replicated the same with their replicates; empty for independent draws
/// @return at most `most` knots; none without values
[[nodiscard]] std::vector<CurveKnot> distribution_curve(std::span<const double> sorted,
                                                        std::span<const ReplicateValue> replicated,
                                                        int replicates, double confidence,
                                                        std::size_t most);

/// "Dvoretzky-Kiefer-Wolfowitz, 95 %": what the page calls the band.
[[nodiscard]] std::string band_name(int replicates, double confidence);

} // namespace wingspread
