/// Numbers that look as if they had another unit than SI.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/model/input_checks/notice.hpp"

namespace wingspread {

/// Angles beyond a whole turn; lengths beyond 50 m; radii of gyration (√(J/m), of the order of half a body's length)
/// that are more than 20 times longer or shorter than the way from the hinge to the centre of mass. The factor lets
/// pass what bodies are: 1/√3 for a uniform panel on an end, 20 where the whole mass of a 4 m boom sits 10 cm from
/// its hinge. A factor of 1000 (mm), 100 (cm), √1000 (g) or 1000 (kg·mm²) does not.
void notice_sizes(const Scene& scene, Notices& notices);

} // namespace wingspread
