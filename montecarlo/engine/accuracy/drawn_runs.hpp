/// Draws the runs to repeat for the accuracy of a campaign.
#pragma once

#include "montecarlo/engine/runs/results.hpp"

#include <cstdint>
#include <vector>

namespace wingspread {

/// Draws `count` runs at random, without replacement, from those that neither failed nor were invalid. Whether a run is
/// drawn depends on the seed and on the numbers of the runs only, so threads, shards and interruptions do not matter.
/// Cost O(N log count).
/// @return rows of the results, increasing; fewer than `count` if there are no more
[[nodiscard]] std::vector<std::size_t> drawn_rows(const Results& results, std::uint64_t seed,
                                                  std::size_t count);

} // namespace wingspread
