/// One deployment that somebody asked for: of which scene, and integrated how.
#pragma once

#include "core/outcome.hpp"
#include "montecarlo/interfaces/library/wingspread.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace wingspread {

/// @throws SpecError with all that is wrong
[[nodiscard]] std::variant<Scene, Campaign> read_input(const api::Input& input);
/// @throws SpecError with all that is wrong; also when it is a scene
[[nodiscard]] Campaign read_campaign_input(const api::Input& input);

/// A scene to be run by itself.
struct Task {
  Scene scene;
  Integration integration;
};

/// Settings that are not given are the campaign's, or for a scene the defaults of a campaign.
/// @throws SpecError with what is wrong, which names the options of `wingspread simulate`
[[nodiscard]] Task task_of(std::variant<Scene, Campaign> input, const api::Settings& settings);

/// Why a text is neither "event" nor "smoothed:EPS"; empty when it is.
[[nodiscard]] std::string refuse_latch(const std::string& text);

/// Of a trajectory's times. @throws SpecError unless it is a number, s, > 0
void check_interval(double interval);

} // namespace wingspread
