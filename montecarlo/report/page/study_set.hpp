/// Sets of the page without runs: the folders of `margin`, `sensitivity CAMPAIGN` and `rare`.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"

#include <filesystem>
#include <vector>

namespace wingspread {

/// Whether a folder has a margin.json, a design.json or a rare.json, and no campaign.json.
[[nodiscard]] bool is_study_folder(const std::filesystem::path& folder);

/// One set; for a margin study that searches hinge by hinge, one per hinge. The sets have no runs, so the page omits
/// its parts about runs.
/// @throws SpecError if its files are broken
[[nodiscard]] std::vector<Json> study_sets_json(const std::filesystem::path& folder,
                                                const std::string& label);

} // namespace wingspread
