/// Checks that the hinges are driven along the whole travel, and held at its end.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

namespace wingspread {

/// Warns of a spring that pushes away from the latch, of a negative net static torque (spring and motor less harness
/// less friction at rest) somewhere on the travel, of a hinge without a latch, of a latch without stiffness, and of a
/// wing that nothing moves or whose torques cancel at the start. A wing that stops where the net torque is negative
/// does not start again.
///
/// Hinges coupled by loops are checked as one drive (drive.hpp). Gravity and the base's motion are not counted.
void check_torques(const Scene& scene, InputWarnings& warnings);

} // namespace wingspread
