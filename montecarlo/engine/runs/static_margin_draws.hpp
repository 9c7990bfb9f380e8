/// Static margins over a campaign's draws: passes the scene of each run to study_static_margins().
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/static_margins/static_margin_study.hpp"

namespace wingspread {

/// Uses the campaign's nominal_scene, torque factors and quantiles. Cost: as in static_margin_study.hpp.
[[nodiscard]] StaticMarginStudy study_static_margins(const Campaign& campaign);

} // namespace wingspread
