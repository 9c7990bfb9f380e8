/// Input checks: warns of values that are valid but probably not meant, before a scene or campaign is run. Every rule
/// is silent on the shipped scenes and campaigns; tests/montecarlo/model/input_checks has its mistakes.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

#include <filesystem>
#include <vector>

namespace wingspread {

/// The place of the scene that a file is, holds under "/scene", or names.
/// @param file empty for an input without a file
/// @pre the file was read without a problem
[[nodiscard]] ScenePlace scene_place(const std::filesystem::path& file);

/// Checks a scene. Cost: one deployment up to the last latch.
[[nodiscard]] std::vector<InputWarning>
check_input(const Scene& scene, const Integration& integration, const std::filesystem::path& file);

/// Checks a campaign: its nominal scene, the torques of its cases, its dispersions, correlations and requirements.
[[nodiscard]] std::vector<InputWarning> check_input(const Campaign& campaign,
                                                    const std::filesystem::path& file);

} // namespace wingspread
