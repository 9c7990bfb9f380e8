/// What moves what: correlations, effects with their bounds, and the strongest pairs drawn.
#pragma once

#include "montecarlo/report/data/page_detail.hpp"
#include "montecarlo/report/data/page_source.hpp"

#include <cstddef>
#include <vector>

namespace wingspread {

/// Effects of a random design are of its first runs, up to this many: that settles them to a hundredth, and the time
/// that they take does not grow on.
inline constexpr std::size_t most_effect_runs = 10'000;

/// Each draw with each output; null without draws.
[[nodiscard]] Json correlations_json(const PageSource& source, const PageDetail& detail);

/// Rank correlations with their bounds (rank_sensitivity.hpp), the strongest of each output first; null where there is
/// nothing to tell.
[[nodiscard]] Json effects_json(const PageSource& source, const PageDetail& detail);

/// A draw and an output of a set, by their places among its columns.
struct Pair {
  std::size_t draw, output;
  double spearman;
};
/// By the size of their correlation, at most two of an output.
[[nodiscard]] std::vector<Pair> strongest_pairs(const PageSource& source, std::size_t most);

/// Rows that a scatter shows one by one, ascending: those with the least and the largest of either column, then every
/// n-th; at most `most`.
[[nodiscard]] std::vector<std::size_t> scatter_rows(const Column& x, const Column& y,
                                                    std::size_t most);

/// @param threads as of thread_count (team.hpp); the bytes do not depend on them
[[nodiscard]] Json scatters_json(const PageSource& source, const PageDetail& detail, int threads);

} // namespace wingspread
