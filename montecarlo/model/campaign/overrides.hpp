/// Settings and changes of the nominal scene given as options of a command or a library call, in addition to a file.
#pragma once

#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <functional>
#include <string>
#include <vector>

namespace wingspread {

/// Reads options by the rules of the campaign's keys.
/// @param given the options as an object with the campaign's keys: "t_end" for --t-end
/// @param read  reads the object and notes problems
/// @throws SpecError that names options instead of pointers
void override_settings(const Json& given, const std::function<void(const JsonCursor&)>& read);

/// Applies changes "PATH=VALUE". @throws SpecError with all problems
[[nodiscard]] Scene changed_scene(Scene scene, const std::vector<std::string>& changes);
/// The same for a campaign's nominal scene; the campaign is validated again.
/// @throws as above, if a dispersion sets a changed parameter in every run, and if a case no longer fits the scene
void change_scene(Campaign& campaign, const std::vector<std::string>& changes);

/// Replaces "scale" and "range" of the campaign's margin, which it need not have.
/// @param scale paths; empty: keeps the campaign's. If none is a spring's torque, the case of a lost spring is left out
/// @param range lower and upper scale; empty: keeps the campaign's
/// @throws SpecError that names the options
void override_margin(Campaign& campaign, const std::vector<std::string>& scale,
                     const std::vector<double>& range);

} // namespace wingspread
