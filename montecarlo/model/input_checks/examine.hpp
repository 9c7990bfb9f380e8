/// All that is noticed of a scene or a campaign before it is run.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/input_checks/notice.hpp"

#include <filesystem>
#include <vector>

namespace wingspread {

/// Where the scene stands that a file is or holds: in itself, under "/scene", or in the file that it names.
/// @param file empty where the input was a text: then the scene stands in itself
/// @pre the file was read without a problem
[[nodiscard]] ScenePlace scene_place(const std::filesystem::path& file);

/// Cost: that of a deployment up to its last latch.
[[nodiscard]] std::vector<Notice> examine(const Scene& scene, const Integration& integration,
                                          const std::filesystem::path& file);

/// Of its nominal scene, the torques of its cases, its dispersions, correlations and requirements.
[[nodiscard]] std::vector<Notice> examine(const Campaign& campaign,
                                          const std::filesystem::path& file);

} // namespace wingspread
