/// What the estimate of a rare event says: as JSON, and as text for a terminal.
#pragma once

#include "montecarlo/analyses/rare/rare_event.hpp"
#include "montecarlo/foundation/formats/json_parse.hpp"

#include <string>
#include <string_view>

namespace wingspread {

/// What `rare` leaves in its folder.
inline constexpr const char* rare_json_file = "rare.json";

/// @param about the value of "wingspread"
[[nodiscard]] Json rare_json(const RareResult& result, const RareOptions& options,
                             const Campaign& campaign, const Json& about);

[[nodiscard]] std::string rare_text(const RareResult& result, const RareOptions& options,
                                    const Campaign& campaign);

} // namespace wingspread
