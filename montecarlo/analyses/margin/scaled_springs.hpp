/// A campaign with some parameters multiplied by a factor.
#pragma once

#include "montecarlo/model/campaign/campaign.hpp"

#include <vector>

namespace wingspread {

/// The campaign with one more dispersion at the end: a constant factor on the parameters, named `margin_scale` (or
/// `margin_scale_2`, … if taken). `resolved` has it too, so that a written campaign file reproduces the runs.
[[nodiscard]] Campaign scaled(const Campaign& campaign,
                              const std::vector<SceneParameter>& parameters, double scale);

} // namespace wingspread
