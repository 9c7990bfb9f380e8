/// Input checks: warns of values that are valid but probably not meant, before a scene or campaign is run. No rule
/// warns of the shipped scenes and campaigns; tests/montecarlo/model/input_checks has mistakes that rules must find.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/input_checks/draw_check.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

#include <filesystem>
#include <vector>

namespace wingspread {

/// The place of the scene, for warnings. The file itself may be a scene, contain a scene under "/scene", or name the
/// scene's file.
/// @param file empty for an input without a file
/// @pre the file was read without a problem
[[nodiscard]] ScenePlace scene_place(const std::filesystem::path& file);

/// Checks a scene. Cost: one deployment up to the last latch; with dampers one without them and, if that deploys,
/// one for each damper.
[[nodiscard]] std::vector<InputWarning>
check_input(const Scene& scene, const Integration& integration, const std::filesystem::path& file);

/// Checks a campaign: its nominal scene, the torques of its cases, its dispersions, correlations and requirements.
/// @param draw makes draws of each case, which are looked at too (check_campaign has the campaign's own); empty: none
[[nodiscard]] std::vector<InputWarning> check_input(const Campaign& campaign,
                                                    const std::filesystem::path& file,
                                                    const DrawScenes& draw = {});

/// Checks the campaign's requirements, which are those of this file (read_requirements_file).
[[nodiscard]] std::vector<InputWarning> check_requirements_file(const Campaign& campaign,
                                                                const std::filesystem::path& file);

} // namespace wingspread
