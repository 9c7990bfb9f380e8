/// How columns of numbers go together, over the rows in which both have a value: Pearson's
/// correlation of the values and of their ranks, of some columns with some others all at once.
///
/// All columns are gone through together, a stretch of rows at a time, so that little of them is in
/// memory (spilled.hpp). Each sum takes its rows in their order: its bits are those of one pair
/// alone, on any number of threads.
#pragma once

#include "montecarlo/foundation/statistics/ranked_column.hpp"

#include <span>
#include <vector>

namespace wingspread {

/// NaN where a correlation is undefined, as of pearson() in statistics.hpp.
struct Correlation {
  long count = 0;  ///< rows in which both have a value
  double pearson;  ///< linear
  double spearman; ///< Pearson's of the mid-ranks: monotone
};

/// Each x with each y, by x and then y. Cost O(n |x| |y|); where values are missing, what it takes
/// of the columns besides is 12 bytes a row of temporary files.
/// @pre all equally long
[[nodiscard]] std::vector<Correlation> pairwise_correlations(std::span<const RankedColumn> x,
                                                             std::span<const RankedColumn> y,
                                                             int threads = 1);

} // namespace wingspread
