/// Static margins of torque along the travel: `static_margins` of page/DATA.md.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

namespace wingspread {

/// Static margins of the nominal wing along the travel, and their lowest quantile of the campaign over its first draws.
/// The first requirement on a static margin decides the standard; without one it is NASA's. Null if no hinge is driven.
/// A campaign with cases has each hinge once for each case: "root (cold)".
[[nodiscard]] Json static_margins_json(const Campaign& campaign);

} // namespace wingspread
