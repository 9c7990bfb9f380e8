/// Static margins over a campaign's draws: hands the scene of each draw to the study in static_margins.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/static_margins/static_margin_study.hpp"

namespace wingspread {

/// By the campaign's factors, at its quantiles. Cost: as in static_margin_study.hpp.
/// @param nominal the wing without dispersion: the campaign's scene, or the same with other springs
[[nodiscard]] StaticMarginStudy study_static_margins(const Campaign& campaign,
                                                     const Scene& nominal);

} // namespace wingspread
