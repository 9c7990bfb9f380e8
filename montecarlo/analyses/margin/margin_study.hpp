/// The window of spring strength: between the weakest springs that surely deploy and the strongest
/// that surely keep to the limits.
///
/// At every scale s the same draws are made (common random numbers): run k has the draws that it
/// has in the campaign, and what is to be sized is multiplied by s after all dispersion. So what
/// changes from scale to scale is due to the springs alone, and the runs at a scale are exactly
/// those of the campaign with one dispersion more (`scaled`), a constant factor s. Each requirement
/// is judged at each scale as the campaign judges it (verdict.hpp).
///
/// What an edge's confidence means. A verdict "pass" at a scale that was fixed beforehand holds
/// with the requirement's confidence c. The edge is chosen by looking at many scales. Let s* be the
/// true edge, and let every draw that breaks the requirement at a scale break it at all scales
/// further out. Then the number of draws that break it only grows outwards, and an edge beyond s*
/// takes a pass at s* itself, whose probability is at most 1 − c: so the search costs nothing, and
/// the window lies within the true one with confidence c, requirement by requirement.
/// `out_of_order` counts the draws that behave otherwise; runs of another seed at the recommended
/// scale are looked at besides. A window has two edges, and every requirement in every case its own
/// risk at each: together they hold with 1 − Σ(1 − c) at least (window_confidence).
///
/// The other seed is drawn from the campaign's. The next number would be what a user takes next, to see
/// fresh draws: they would be those that confirmed the scale.
///
/// A run goes only as far as the requirements need. Where none is about a peak it ends at the last
/// latch, so that one which would have failed on the way to its peaks has deployed here, and has failed
/// in `run` of a campaign that asks for peaks.
///
/// A campaign's cases (cold, hot, end of life) are looked at alike, each with its own nominal wing and the
/// same draws: the requirements hold in all of them, and the worst of them sets the edges.
///
/// One spring out: a hinge's torque comes from m equal springs. In one case more for each hinge
/// whose springs are sized, its torque is (m − 1)/m of what was drawn. The requirements hold in these
/// too.
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

/// Finds the window, or those of every hinge.
/// @param progress told how far it has come, one call at a time
/// @param result   filled as it goes on: when stopped it has the scales that were finished
/// @throws SpecError when the campaign asks for no margin or has no requirements, or when so few
///   runs cannot show one; Stopped when the evaluator makes fewer than it is asked for
void find_margin(const Campaign& campaign, Evaluator& evaluator,
                 const std::function<void(const StudyProgress&)>& progress, MarginResult& result);

/// Makes a part of the runs of those looks that do not depend on what others came to: every search's first scales in
/// all cases. What they come to nobody asks: it is for a log, out of which `find_margin` has them again.
/// @param shard which part of each look's runs (part_of_analysis, shard_checkpoints.hpp)
/// @return how many runs were made
/// @throws as find_margin does
long make_first_looks(const Campaign& campaign, const Shard& shard, Evaluator& evaluator,
                      const std::function<void(const StudyProgress&)>& progress);

} // namespace wingspread
