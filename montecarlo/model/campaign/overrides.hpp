/// Settings and changes of the nominal scene that are given beside a file, as options of a command or of a library call.
#pragma once

#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <functional>
#include <string>
#include <vector>

namespace wingspread {

/// Reads settings that were given as options over those that hold, by the rules of the file they
/// otherwise stand in.
/// @param given their keys and values, as a campaign has them; "t_end" stands for --t-end
/// @param read  notes what is wrong
/// @throws SpecError that names the options
void override_settings(const Json& given, const std::function<void(const JsonCursor&)>& read);

/// @throws SpecError with all that is wrong with them
[[nodiscard]] Scene changed_scene(Scene scene, const std::vector<std::string>& changes);
/// Its resolved JSON and its cases follow.
/// @throws as above, and when a case cannot be had any more
void change_scene(Campaign& campaign, const std::vector<std::string>& changes);

} // namespace wingspread
