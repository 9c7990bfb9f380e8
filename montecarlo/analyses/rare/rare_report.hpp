/// The estimate of a rare event as JSON and as text for a terminal.
#pragma once

#include "montecarlo/analyses/rare/rare_event.hpp"
#include "montecarlo/foundation/formats/json_parse.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// The file of `rare` in its folder.
inline constexpr const char* rare_json_file = "rare.json";

/// @param about the value of the key "wingspread"
[[nodiscard]] Json rare_json(const RareResult& result, const RareOptions& options,
                             const Campaign& campaign, const Json& about);

/// The event as data, so that a reader of the file may use another unit. Null for "not deployed".
[[nodiscard]] Json event_json(const RareEvent& event);

/// Reasons to doubt the estimate, a sentence each.
[[nodiscard]] std::vector<std::string> doubts_of(const RareResult& result);

[[nodiscard]] std::string rare_text(const RareResult& result, const RareOptions& options,
                                    const Campaign& campaign);

} // namespace wingspread
