/// A campaign in words, for `wingspread check`.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/scene_file/describe_scene.hpp"

#include <string>
#include <string_view>

namespace wingspread {

/// "normal (mean 1, std 0.05) within [0, 2]".
[[nodiscard]] std::string describe(const Distribution& distribution);

/// The SI unit of a dispersion's draws: none of a factor, nor of a draw that acts through tables, nor of targets without
/// a common unit.
[[nodiscard]] std::string_view unit_of_draw(const Dispersion& dispersion);

/// One line each for the scene's parts, every dispersion, case, correlation, the settings and requirements.
[[nodiscard]] std::string describe(const Campaign& campaign);

} // namespace wingspread
