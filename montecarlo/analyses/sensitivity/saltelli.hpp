/// The design for Sobol' indices: N rows of d + 2 points each, as runs of a campaign.
///
/// In each row the points A and B are one point of a 2d-dimensional design of the campaign's kind
/// and seed: A's coordinates are the campaign's own, so that with independent draws A of row k is
/// the campaign's run k. Which point of which row a run is: sobol_indices.hpp.
#pragma once

#include "montecarlo/engine/runs/run_plan.hpp"

namespace wingspread {

/// How many runs the rows take. @throws SpecError when that is more than can be counted
[[nodiscard]] long saltelli_runs(long rows, std::size_t dispersions);

/// In how many replicates of the campaign's design the rows are: as many as its runs, but no more than
/// there are rows.
[[nodiscard]] long saltelli_replicates(const Sampling& sampling, long rows);

/// The plan of a campaign whose runs are the design's.
/// @param rows N, ≥ 1; what they are depends on it for Latin hypercubes alone
/// @pre the campaign outlives the plan
/// @throws SpecError when the campaign has no dispersions, or some of them are correlated: then
///   variance has no shares that belong to one of them
[[nodiscard]] RunPlan saltelli_plan(const Campaign& campaign, long rows);

} // namespace wingspread
