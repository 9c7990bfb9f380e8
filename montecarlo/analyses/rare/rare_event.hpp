/// The probability of a rare event in a campaign: independent subset simulations over its draws.
///
///   z → point of the stratum (strata.hpp) → u = Φ(z) and 1 − u → copula, quantiles → draws → run → g (limit_state.hpp)
#pragma once

#include "montecarlo/analyses/rare/limit_state.hpp"
#include "montecarlo/analyses/rare/strata.hpp"
#include "montecarlo/analyses/rare/subset_simulation.hpp"
#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/foundation/platform/progress.hpp"

#include <array>
#include <functional>
#include <string_view>
#include <vector>

namespace wingspread {

struct RareOptions {
  RareEvent event{};
  long samples = 2000; ///< runs of a level (N), a multiple of 10, ≥ 100
  long repeats = 5;    ///< independent subset simulations, ≥ 1
  double confidence = 0.95;
  double smallest = 1e-10;
};

/// The sampled run with the event whose point is nearest to the origin of the normal space: the most likely one.
struct LikeliestRun {
  double distance; ///< |z|
  NormalPoint
      z; ///< normal coordinate of each dispersion, before the copula: independent, though draws are correlated
  std::vector<double> draws;
  Status status;
  std::string reason;
};

struct RareResult {
  std::vector<StratumEstimate> strata; ///< without a rare value first
  double left_out = 0; ///< probability of the draws in no stratum; added to the upper bound
  /// Dispersions with values that the first levels may miss, and the expected draws of the rarest one. With any, no
  /// upper bound is below that of plain sampling.
  std::vector<std::pair<std::string, double>> unseen;
  RareEstimate estimate;          ///< over all strata
  std::array<long, 5> statuses{}; ///< of all runs made, in the order of Status
  long cut = 0;                   ///< runs whose peak t_end cut; they count as the event
  std::string_view never_final{}; ///< why no t_end proves peaks final (requirement_checks.hpp)
  long open_latches = 0;          ///< deployed runs whose latches may let go after t_end
  long undeployed =
      0; ///< runs that did not deploy, but have the event's output: they count by its value
  long absent = 0; ///< runs without the event's output; they count as the event
  std::optional<LikeliestRun> likeliest; ///< none if no sampled run has the event
};

/// @param progress called with the progress, one call at a time
/// @throws SpecError for an unknown output, a scene without latches, or a campaign without dispersions;
///   Stopped when the evaluator makes fewer runs than requested
[[nodiscard]] RareResult
estimate_rare_event(const Campaign& campaign, const RareOptions& options, Evaluator& evaluator,
                    const std::function<void(const StudyProgress&)>& progress);

} // namespace wingspread
