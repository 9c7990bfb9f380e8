/// The design for Sobol' indices: N rows of d + 2 points each, as runs of a campaign.
///
/// The points A and B of a row are one point of a design with 2d dimensions, of the campaign's kind and seed. A has the
/// campaign's own coordinates: with independent draws, A of row k is the campaign's run k. SaltelliPoint
/// (sobol_indices.hpp) says which point of which row a run is.
#pragma once

#include "montecarlo/engine/runs/run_plan.hpp"

namespace wingspread {

/// The number of runs, N (d + 2). @throws SpecError on overflow
[[nodiscard]] long saltelli_runs(long rows, std::size_t dispersions);

/// The number of replicates of the rows: that of the campaign, but at most N and at least 1.
[[nodiscard]] long saltelli_replicates(const Sampling& sampling, long rows);

/// The run plan of the design.
/// @param rows N, ≥ 1; the points depend on N for Latin hypercubes only
/// @pre the campaign outlives the plan
/// @throws SpecError without dispersions, or with correlated ones: these have no variance shares of their own
[[nodiscard]] RunPlan saltelli_plan(const Campaign& campaign, long rows);

} // namespace wingspread
