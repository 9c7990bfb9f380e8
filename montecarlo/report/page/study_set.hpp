/// Sets of the page that are no runs of a campaign, but what `margin`, `sensitivity` of a campaign and `rare` left in a
/// folder of theirs.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"

#include <filesystem>
#include <vector>

namespace wingspread {

/// Whether a study left it: it has a margin.json, a design.json or a rare.json, and no campaign.json.
[[nodiscard]] bool is_study_folder(const std::filesystem::path& folder);

/// One set; of margins that were sought hinge by hinge one for each. Of runs they have none: the page leaves out what is
/// about them.
/// @throws SpecError when its files are broken
[[nodiscard]] std::vector<Json> study_sets_json(const std::filesystem::path& folder,
                                                const std::string& label);

} // namespace wingspread
