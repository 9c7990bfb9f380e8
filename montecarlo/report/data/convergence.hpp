/// How a mean and a quantile settle as runs are added, in the order of the runs.
#pragma once

#include "montecarlo/foundation/statistics/bounds.hpp"
#include "montecarlo/foundation/statistics/replicate_bounds.hpp"
#include "montecarlo/results/summary/replication.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace wingspread {

struct ConvergencePoint {
  long runs = 0; ///< the first so many, those without a value among them
  double mean, quantile;
  Bounds mean_bounds, quantile_bounds;
};

struct Convergence {
  double p = 0; ///< of the quantile
  std::vector<ConvergencePoint> points;
};

/// A column's present values, smallest first, and how their statistics came there.
struct SettledColumn {
  std::vector<double> sorted;
  std::vector<ReplicateValue> replicated; ///< the same with their replicates, where there are any
  Convergence convergence;
};

/// Numbers of runs, evenly in the logarithm, from `first` or fewer up to all; ascending, each once.
[[nodiscard]] std::vector<long> convergence_runs(long all, std::size_t most, long first = 10);

/// Cost: that of sorting the column, and four passes through it; memory: that of sorting.
/// @param p          of the quantile, in (0, 1)
/// @param confidence of all bounds, two-sided
[[nodiscard]] SettledColumn settle(const Column& column, double p, double confidence,
                                   const Replication& replication, std::size_t most);

} // namespace wingspread
