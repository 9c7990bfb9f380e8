/// The wing with other springs: a campaign and a scene with parameters multiplied by a factor.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"

#include <vector>

namespace wingspread {

/// The campaign with one dispersion more, after all others: a constant factor on the parameters,
/// `margin_scale` by name (or with a number behind it, if that is taken). Its file says so too.
[[nodiscard]] Campaign scaled(const Campaign& campaign,
                              const std::vector<SceneParameter>& parameters, double scale);
[[nodiscard]] Scene scaled(Scene scene, const std::vector<SceneParameter>& parameters,
                           double scale);

} // namespace wingspread
