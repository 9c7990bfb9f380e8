/// Whether the hinges are driven all the way, and held at its end.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/model/input_checks/notice.hpp"

namespace wingspread {

/// A spring that pushes away from the latch; a net static torque (spring less harness less the level that holds at
/// rest) that is negative somewhere on the travel, where a wing that stops does not start again; a hinge without
/// latch, a latch without stiffness.
///
/// Hinges that loops couple are looked at as one drive (drive.hpp). Gravity and the base's motion are left out: they are
/// of the place and the moment.
void notice_torques(const Scene& scene, Notices& notices);

} // namespace wingspread
