/// Which dispersions move which outputs, from any campaign's runs: Spearman's and partial rank
/// correlations (rank_correlation.hpp) of every output with every dispersion.
#pragma once

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/foundation/statistics/rank_correlation.hpp"
#include "montecarlo/results/summary/replication.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// NaN and no bounds where there is none: a column does not vary, or there are too few runs. No
/// bounds besides where all runs are of one replicate.
struct Coefficient {
  double value;
  Bounds bounds;
};

/// What a dispersion does to an output.
struct RankEffect {
  Coefficient spearman, partial;
  bool seen =
      true; ///< one of them differs from 0 (RankSensitivity::idle); true where none can tell
};

struct OutputRanks {
  std::string output;
  long count = 0, missing = 0;     ///< runs with it, and without: these are left out
  std::vector<RankEffect> effects; ///< of each dispersion, in the campaign's order
  bool entangled = false;          ///< two dispersions rank the runs alike: no partial coefficients
};

struct RankSensitivity {
  long runs = 0;
  double confidence = 0.95; ///< of all bounds, at whichever of its looks the campaign stopped
  long looks = 1;           ///< numbers of runs at which it could have
  int replicates = 0;       ///< that the bounds come from; 0: all draws are independent
  std::vector<std::string> dispersions;
  std::vector<OutputRanks> outputs;  ///< the campaign's, then `deployed` when it varies
  std::vector<std::string> unvaried; ///< dispersions whose draws are all the same
  /// Dispersions that vary and move no output that these runs show: of all their coefficients none
  /// differs from 0, at the confidence asked for taken over all outputs together (Bonferroni).
  std::vector<std::string> idle;
  /// Dispersions of whose ranks half or more follow from the other dispersions'. What they do
  /// together, a partial coefficient gives to none of them.
  std::vector<std::string> collinear;
};

/// How the runs came about, as far as bounds depend on it.
struct RunsMade {
  Replication replication{};
  long looks = 1; ///< numbers of runs at which the campaign could have stopped
};

/// All outputs with all dispersions. Of independent draws Spearman's bounds are those of
/// rank_correlation.hpp; partial ones, and all bounds of draws that depend on each other, are the
/// jackknife's, over parts of the draws or over their replicates. Pure.
///
/// Cost O(n k²) for the runs' draws, once for all outputs that the same runs have, and O(n k) for each
/// output; 17 times that for the jackknife (or replicates and one).
[[nodiscard]] RankSensitivity rank_sensitivity(const Results& results, double confidence,
                                               const RunsMade& made = {});

} // namespace wingspread
