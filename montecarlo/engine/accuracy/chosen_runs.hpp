/// Chooses the runs to repeat for the accuracy of a campaign: representative ones, and those where a small error has
/// the largest consequence. The choice depends only on the rows, not on threads, shards or interruptions.
#pragma once

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <vector>

namespace wingspread {

/// Chooses `count` runs from six lists. Takes one run from each list in turn, the list's next one not chosen yet:
///
///   1 by status: the first that deployed, stalled, timed out; then the second of each; …
///   2 by latch order, the most frequent first: the first of each; then the second; …
///   3 nearest to a requirement's limit, on either side
///   4 least time between two latches; slowest latch; latest deployment
///   5 most extreme: largest (x − mean)/std of all peaks; without peaks, largest magnitude over all outputs
///   6 evenly spaced
///
/// Ties go to the first run. Failed and invalid runs are not chosen. Cost O(N) per column; memory: up to `count` rows
/// for each list and kind, and one bit per run.
/// @param results with the campaign's columns
/// @return rows of the results, increasing; fewer than `count` if there are no more
[[nodiscard]] std::vector<std::size_t> chosen_rows(const Campaign& campaign, const Results& results,
                                                   std::size_t count);

} // namespace wingspread
