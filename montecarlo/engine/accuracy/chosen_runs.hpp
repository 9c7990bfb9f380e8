/// Which runs of a campaign are worth making again to see how accurate it is: a few that stand for what
/// became of all, and those in which a small error has the largest consequence.
///
/// The choice depends on the rows alone: not on threads, shards or interruptions.
#pragma once

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <vector>

namespace wingspread {

/// So many runs, by turns from each of these lists, the next that is not chosen yet:
///
///   1 by status: the first that deployed, stalled, timed out, and on
///   2 by latch order, the most frequent first: the first of each, and on
///   3 nearest to a requirement's limit, on either side of it
///   4 on an edge: the least time between two latches; the slowest latch; the latest deployment
///   5 the most extreme: the largest (x − mean)/std of all peaks, of |.| and all outputs where there are no peaks
///   6 evenly spaced
///
/// Of runs that are equal the first one counts. Runs that failed or were invalid are not chosen: they are
/// counted as such. Cost O(N) for each column; memory: the chosen ones of each list, and a bit a run.
/// @param results with the campaign's columns
/// @return rows of the results, in their order; fewer than `count` where there are no more
[[nodiscard]] std::vector<std::size_t> chosen_rows(const Campaign& campaign, const Results& results,
                                                   std::size_t count);

} // namespace wingspread
