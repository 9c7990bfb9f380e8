/// Which dispersions move which outputs, from any campaign's runs: Spearman's and partial rank
/// correlations (rank_correlation.hpp) of every output with every dispersion.
#pragma once

#include "montecarlo/runs/results.hpp"
#include "montecarlo/statistics/rank_correlation.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// NaN and no bounds where there is none: a column does not vary, or there are too few runs.
struct Coefficient {
  double value;
  Bounds bounds;
};

/// What a dispersion does to an output.
struct RankEffect {
  Coefficient spearman, partial;
};

struct OutputRanks {
  std::string output;
  long count = 0, missing = 0;     ///< runs with it, and without: these are left out
  std::vector<RankEffect> effects; ///< of each dispersion, in the campaign's order
  bool entangled = false;          ///< two dispersions rank the runs alike: no partial coefficients
};

struct RankSensitivity {
  long runs = 0;
  double confidence = 0.95;
  std::vector<std::string> dispersions;
  std::vector<OutputRanks> outputs;  ///< the campaign's, then `deployed` when it varies
  std::vector<std::string> unvaried; ///< dispersions whose draws are all the same
  /// Dispersions that vary and move no output that these runs show: of all their coefficients none
  /// differs from 0, at the confidence asked for taken over all outputs together (Bonferroni).
  std::vector<std::string> idle;
};

/// 1 for a run that deployed, 0 for one that stalled or timed out, NaN for the others: what became
/// of them is not known.
[[nodiscard]] Column deployed_column(const Results& results);

/// All outputs with all dispersions. Pure. Cost O(n k²) for the runs' draws, once for all outputs
/// that the same runs have, and O(n k) for each output.
[[nodiscard]] RankSensitivity rank_sensitivity(const Results& results, double confidence);

} // namespace wingspread
