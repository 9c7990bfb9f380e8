/// Checks for numbers in other units than SI.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

namespace wingspread {

/// Warns of angles beyond a turn, lengths above 50 m, and a radius of gyration √(J/m) more than 20 times longer or
/// shorter than the distance from the hinge to the centre of mass. Real bodies stay within 20: a uniform panel hinged
/// at its end has 1/√3, a 4 m boom with its mass 10 cm from the hinge has 20. Wrong units exceed it: 1000 (mm, kg·mm²),
/// 100 (cm), √1000 (g).
///
/// Warns of a stop's gap or a latch's backlash above a tenth of the travel, of an inertia about the hinge where the one
/// about the centre of mass is meant, and of a free base lighter or heavier than all its bodies together by more than a
/// factor of 1000.
void check_sizes(const Scene& scene, InputWarnings& warnings);

} // namespace wingspread
