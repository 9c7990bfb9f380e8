/// What a file holds, in words: for `wingspread check`.
#pragma once

#include "montecarlo/campaign/campaign.hpp"

#include <string>

namespace wingspread {

/// The scene's name, base, bodies and hinges, a line for each.
[[nodiscard]] std::string describe(const Scene& scene);

/// The scene, then a line for each dispersion,
/// and for the sampling, integration, outputs and statistics.
[[nodiscard]] std::string describe(const Campaign& campaign);

} // namespace wingspread
