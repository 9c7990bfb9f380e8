/// Influence of dispersions on outputs from any campaign's runs: Spearman's and partial rank correlations
/// (rank_correlation.hpp) of every output with every dispersion.
#pragma once

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/foundation/statistics/interim_analyses.hpp"
#include "montecarlo/foundation/statistics/rank_correlation.hpp"
#include "montecarlo/results/summary/replication.hpp"

#include <map>
#include <string>
#include <vector>

namespace wingspread {

/// A correlation with its bounds. NaN without bounds if a column is constant or has too few runs. A value without
/// bounds if all runs belong to one replicate.
struct Coefficient {
  double value;
  Bounds bounds;
};

/// With fewer runs no effect is visible: Fisher's z has the variance 1/(n − 3).
inline constexpr long least_runs_for_effects = 4;

/// The effect of a dispersion on an output.
struct RankEffect {
  Coefficient spearman, partial;
  bool seen = true; ///< a coefficient differs from 0 (RankSensitivity::idle); true without bounds
};

struct OutputRanks {
  std::string output;
  long count = 0, missing = 0;     ///< runs with a value, and without one (left out)
  std::vector<RankEffect> effects; ///< per dispersion, in the campaign's order
  bool entangled = false;          ///< ranks are linearly dependent: no partial coefficients
  long cut = 0;                    ///< runs whose peak t_end cut (finality.hpp)
};

struct RankSensitivity {
  long runs = 0;
  double confidence = 0.95;  ///< at which a bound holds at all analyses together
  InterimAnalyses interim{}; ///< which share the risk of every bound
  int replicates = 0;        ///< replicates behind the bounds; 0: independent draws
  std::vector<std::string> dispersions;
  std::vector<OutputRanks> outputs;  ///< the campaign's, then `deployed` when it varies
  std::vector<std::string> unvaried; ///< dispersions with constant draws; none of too few runs
  /// Dispersions that vary without a visible effect: none of their coefficients differs from 0 at the confidence shared
  /// over all outputs (Bonferroni). None of too few runs.
  std::vector<std::string> idle;
  /// Dispersions whose ranks are explained by those of the others (R² ≥ 0.5). Partial coefficients omit their joint
  /// effect.
  std::vector<std::string> collinear;
  std::map<std::string, std::vector<std::string>> rows; ///< as in RunsMade
  long open_latches =
      0; ///< deployed runs of which it is not proven that their latches stay engaged
  std::string_view never_final{}; ///< as in RunsMade
};

/// How the runs were made, as far as the bounds depend on it.
struct RunsMade {
  Replication replication{};
  InterimAnalyses interim{};
  /// Columns of each `rows`: they take the same row of a file, so the file decides how they depend on each other.
  std::map<std::string, std::vector<std::string>> rows{};
  std::string_view never_final{}; ///< why no t_end proves peaks final (requirement_checks.hpp)
};

/// The coefficients of all outputs with all dispersions. Pure.
/// Bounds for independent draws: by rank_correlation.hpp for Spearman's coefficient, by the jackknife over parts of the
/// runs for the partial one. Bounds for replicates: by the jackknife over the replicates.
///
/// Cost for n runs and k dispersions: O(n k²) for each group of outputs that are present in the same runs, and O(n k)
/// for each output. The jackknife multiplies it by 17 (16 parts and the whole), or by the number of replicates plus
/// one.
[[nodiscard]] RankSensitivity rank_sensitivity(const Results& results, double confidence,
                                               const RunsMade& made = {});

} // namespace wingspread
