/// Checks that every part of a scene acts on the wing, and that rates and accelerations are plausible.
#pragma once

#include "core/outcome.hpp"
#include "core/scene/scene.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"

namespace wingspread {

/// Warns of a damper's window beside the travel, of a table over less than half of it, of a latch that gives way to its
/// hinge's spring, of air without a plate, of a stop inside a latch's backlash, of a loop that ties nothing, and of rates,
/// accelerations, gravity, air, drag, damping ratios and dissipations that no wing has. An elastic joint has no travel.
void check_extents(const Scene& scene, InputWarnings& warnings);

/// Warns of a hinge that reaches its latch faster than those of wings do, or so slowly that its regularized friction is
/// not full.
/// @param nominal the nominal deployment
void check_arrival(const Scene& scene, const Outcome& nominal, InputWarnings& warnings);

} // namespace wingspread
