/// What the nominal deployment shows: bodies that pass through each other on their way.
#pragma once

#include "core/deployment.hpp"
#include "montecarlo/model/input_checks/notice.hpp"

namespace wingspread {

/// Runs the nominal wing up to its last latch, and looks at the bodies' arms (shape_notices.hpp) on the way, wherever a
/// hinge has turned on by a twentieth of a radian. Hinges that are beyond their stowed angle are left out: that is
/// overtravel, which is told of the runs themselves.
/// @return the nominal deployment, with its rates at the latches but without peaks
Outcome notice_way(const Scene& scene, const Integration& integration, Notices& notices);

} // namespace wingspread
