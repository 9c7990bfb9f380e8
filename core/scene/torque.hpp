/// Torques and friction of a hinge at one place of its travel, for static checks of a scene. Runs use core/laws.
#pragma once

#include "core/scene/scene.hpp"

namespace wingspread {

/// Value of the curve at x. Cost O(log n) for n knots.
[[nodiscard]] double value_at(const Curve& curve, double x);

/// A spring's or a harness's torque, N·m: scale · law + offset.
/// @param travel share of the hinge's way, 0 stowed … 1 latched
[[nodiscard]] double torque_at(const HingeTorque& torque, const Hinge& hinge, double travel);

/// Friction level measured by a torque test both ways, times friction's scale, N·m; 0 without such a test.
[[nodiscard]] double measured_friction_at(const Hinge& hinge, double travel);

/// The level that holds at rest, N·m: `static` of the exact friction, else the Coulomb level.
[[nodiscard]] double static_level_at(const Hinge& hinge, double travel);

} // namespace wingspread
