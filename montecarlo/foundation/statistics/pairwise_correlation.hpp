/// Correlations of columns with columns, each over the rows in which both have a value: Pearson's of the values and
/// of their ranks.
///
/// All columns are read together, a block of rows at a time, so that little is in memory (spilled.hpp). Each sum adds
/// rows in order, so that it has the same bits for one pair alone and for any number of threads.
#pragma once

#include "montecarlo/foundation/statistics/ranked_column.hpp"

#include <span>
#include <vector>

namespace wingspread {

/// A coefficient is NaN if undefined, as in pearson() in statistics.hpp.
struct Correlation {
  long count = 0;  ///< rows in which both have a value
  double pearson;  ///< linear
  double spearman; ///< Pearson's of the mid-ranks: monotone
};

/// Correlates each x with each y, ordered by x and then y. Cost O(n |x| |y|); where values are missing, also 12 bytes
/// of temporary files per row and column.
/// @pre all equally long
[[nodiscard]] std::vector<Correlation> pairwise_correlations(std::span<const RankedColumn> x,
                                                             std::span<const RankedColumn> y,
                                                             int threads = 1);

} // namespace wingspread
