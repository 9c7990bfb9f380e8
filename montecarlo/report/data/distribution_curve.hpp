/// An empirical distribution function at some of its steps (knots), with its confidence band.
///
/// Independent draws: the band of Dvoretzky, Kiefer and Wolfowitz with Massart's constant, F ± √(ln(2/α)/(2n)). It
/// holds for the whole curve at once, for any distribution and any n.
/// Replicates of a design: the interval of Korn and Graubard at each knot separately (replicate_bounds.hpp).
/// Source: P. Massart, Ann. Probab. 18 (1990) 1269–1283.
#pragma once

#include "montecarlo/foundation/statistics/replicate_bounds.hpp"
#include "montecarlo/results/streaming/population.hpp"

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

struct DistributionCurve {
  std::vector<CurveKnot> knots; ///< ascending; none without values
  bool steps =
      true; ///< whether the knots are all distinct values: the function is constant between them
};

/// The ranks, 1 to n, of the knots of a curve of n values. Half of them are evenly spaced. Towards each end a quarter
/// forms a geometric series, because requirements concern the tails. Ascending, distinct.
/// @pre n ≥ 1, most ≥ 5
[[nodiscard]] std::vector<long> curve_ranks(long n, std::size_t most);

/// @param sorted the values, smallest first
/// @param replicated the same values with their replicates; empty for independent draws
/// @return at most `most` knots: all distinct values if there are no more, else those at curve_ranks
[[nodiscard]] DistributionCurve distribution_curve(std::span<const double> sorted,
                                                   std::span<const ReplicateValue> replicated,
                                                   int replicates, double confidence,
                                                   std::size_t most);

/// The curve of streaming statistics, for independent draws. Each knot is off by at most a bin. It has steps where all
/// values are kept.
[[nodiscard]] DistributionCurve distribution_curve(const RankedPopulation& values,
                                                   double confidence, std::size_t most);

/// The name of the band: "Dvoretzky-Kiefer-Wolfowitz, 95 %".
[[nodiscard]] std::string band_name(int replicates, double confidence);

} // namespace wingspread
