/// The page's data of a fit's folder.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/foundation/formats/json_parse.hpp"

#include <filesystem>

namespace wingspread {

/// The block "fit" of a set (DATA.md), from fit.json, traces.csv and posterior.csv.
/// @param scene of the campaign, for the units of its parameters; null if unknown
/// @throws SpecError and Json::exception for files that another program changed
[[nodiscard]] Json fit_block(const std::filesystem::path& folder, const Scene* scene);

} // namespace wingspread
