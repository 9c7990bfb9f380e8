/// The window of spring strength: from the weakest springs that deploy to the strongest that keep to the limits, both
/// with the required confidence.
///
/// Method. The same draws are made at every scale s (common random numbers): run k has the draws of the campaign's run
/// k, and the scaled parameters are multiplied by s after all dispersion. So differences between scales are due to the
/// springs alone. The runs at a scale are those of the campaign with one more dispersion, the constant factor s
/// (`scaled`). Each requirement is judged at each scale as the campaign judges it (verdict.hpp).
///
/// Confidence of an edge. A verdict "pass" at a scale fixed beforehand holds with the requirement's confidence c. The
/// search chooses the edge from many scales, yet this choice costs no confidence. Suppose that every draw that breaks
/// the requirement at a scale breaks it at all scales further out. The number of runs that break it then only grows
/// outwards. So the search puts the edge beyond the true edge s* only if the runs at s* pass. The probability of that
/// pass is at most 1 − c. `out_of_order` counts the draws that contradict the supposition; runs of another seed confirm
/// the recommended scale. The joint confidence of all requirements in all cases at both edges is at least 1 − Σ(1 − c)
/// (window_confidence).
///
/// The confirmation seed is derived from the campaign's seed. It is not seed + 1, because users often take seed + 1 for
/// fresh draws, and would then get the draws that confirmed the scale.
///
/// A run ends when the outputs of the requirements are known. If none is a peak, it ends at the last latch. A run that
/// would fail numerically after its last latch then counts as deployed here, and as failed in `run` with peaks.
///
/// The campaign's cases (cold, hot, end of life) have their own nominal wing and the same draws. The requirements hold
/// in all cases; the worst case sets the edge.
///
/// One spring out: m equal springs drive a hinge. One more case per sized hinge has (m − 1)/m of the drawn torque.
#pragma once

#include "montecarlo/analyses/margin/margin_result.hpp"
#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/foundation/platform/progress.hpp"
#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/results/checkpoint/shard_checkpoints.hpp"

#include <functional>

namespace wingspread {

/// The seed of the runs that confirm a recommended scale.
[[nodiscard]] std::uint64_t confirmation_seed(std::uint64_t seed);

/// Bounds of a study's number of runs, over all searches, scales and cases.
struct MarginRuns {
  long least; ///< at the scales that are always evaluated
  long most;  ///< if no cell between them is ruled out: studies usually need far fewer
};
/// @pre the campaign has a /margin
[[nodiscard]] MarginRuns margin_runs(const Campaign& campaign);

/// Finds the window of all springs together, or one window per hinge (MarginSpec::mode).
/// @param progress called with the progress, one call at a time
/// @param result   filled scale by scale: after Stopped it has the finished scales
/// @throws SpecError without /margin, without requirements, or with too few runs to show a requirement; Stopped when
///   the evaluator makes fewer runs than requested
void find_margin(const Campaign& campaign, Evaluator& evaluator,
                 const std::function<void(const StudyProgress&)>& progress, MarginResult& result);

/// Makes a shard of the runs at the first scales of every search (window_search.hpp), in all cases; these scales do not
/// depend on any result. The runs go to the evaluator's checkpoint, from which `find_margin` reads them.
/// @param shard the part of each scale's runs (part_of_analysis, shard_checkpoints.hpp)
/// @return the number of runs made
/// @throws as find_margin does
long run_first_scales(const Campaign& campaign, const Shard& shard, Evaluator& evaluator,
                      const std::function<void(const StudyProgress&)>& progress);

} // namespace wingspread
