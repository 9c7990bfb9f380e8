/// Correlations, effects with bounds, scatters of the strongest pairs, changes by which a requirement would pass.
#pragma once

#include "montecarlo/report/data/page_detail.hpp"
#include "montecarlo/report/data/page_source.hpp"

#include <cstddef>
#include <vector>

namespace wingspread {

/// Largest number of runs for the effects; of a random design the first ones are used. The standard error of a rank
/// correlation is then 1/√10,000 = 0.01, and the time is bounded.
inline constexpr std::size_t most_effect_runs = 10'000;

/// Correlations of each draw with each output; null without draws, and of fewer than four runs.
[[nodiscard]] Json correlations_json(const PageSource& source, const PageDetail& detail);

/// Rank correlations with bounds (rank_sensitivity.hpp), the strongest of each output first; null without any.
[[nodiscard]] Json effects_json(const PageSource& source, const PageDetail& detail);

/// A draw and an output by their column indices.
struct Pair {
  std::size_t draw, output;
  double spearman;
};
/// The pairs with the largest visible correlation, at most two per output; first those of outputs that fail a
/// requirement.
[[nodiscard]] std::vector<Pair> strongest_pairs(const PageSource& source, std::size_t most);

/// The rows that a scatter shows as points, ascending, at most `most`: the extremes of both columns and every n-th row.
[[nodiscard]] std::vector<std::size_t> scatter_rows(const Column& x, const Column& y,
                                                    std::size_t most);

/// CHANGES of page/DATA.md: changes of inputs by which a failed requirement would pass. Empty for any other verdict,
/// without rows, and for a static margin.
[[nodiscard]] Json changes_json(const PageSource& source, const Verdict& verdict);

/// `unjudged` of page/DATA.md: loads without a requirement that are larger than each judged load of their kind.
[[nodiscard]] Json unjudged_json(const PageSource& source);

/// @param threads as of thread_count (thread_pool.hpp); the bytes do not depend on them
[[nodiscard]] Json scatters_json(const PageSource& source, const PageDetail& detail, int threads);

} // namespace wingspread
