/// Convergence of a mean and a quantile with the number of runs, in the order of the runs. The mean is over the runs
/// with a value, the quantile over all runs.
#pragma once

#include "montecarlo/foundation/statistics/bounds.hpp"
#include "montecarlo/foundation/statistics/replicate_bounds.hpp"
#include "montecarlo/results/summary/replication.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace wingspread {

struct ConvergencePoint {
  long runs = 0;         ///< number of first runs, also those without a value
  double mean, quantile; ///< NaN where there is none
  Bounds mean_bounds, quantile_bounds;
};

struct Convergence {
  double p = 0; ///< level of the quantile
  std::vector<ConvergencePoint> points;
};

/// A column's values in ascending order, and the convergence of their statistics.
struct SortedWithConvergence {
  std::vector<double> sorted;
  std::vector<ReplicateValue>
      replicated; ///< the same values with their replicates; empty without replicates
  Convergence convergence;
};

/// Numbers of runs, evenly spaced in the logarithm, from `first` (or `all` if smaller) to `all`; ascending, distinct.
[[nodiscard]] std::vector<long> convergence_runs(long all, std::size_t most, long first = 10);

/// Sorts a column and computes its convergence. Cost: one sort and four passes.
/// @param p          level of the quantile, in (0, 1)
/// @param confidence two-sided confidence of every bound
/// @param end where missing values rank
[[nodiscard]] SortedWithConvergence sort_with_convergence(const Column& column, double p,
                                                          double confidence,
                                                          const Replication& replication,
                                                          std::size_t most,
                                                          MissingRank end = MissingRank::above);

} // namespace wingspread
