/// Static margins of torque along the travel: `static_margins` of page/DATA.md.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

namespace wingspread {

/// By the standard that the campaign's first requirement on a static margin names, else by NASA's: of the nominal wing at
/// each place of the travel, and the campaign's lowest quantile over its first draws. Null where nothing drives.
[[nodiscard]] Json static_margins_json(const Campaign& campaign);

} // namespace wingspread
