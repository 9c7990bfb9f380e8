/// Torques and friction of a hinge at a place of its travel, one by one: for what looks at a scene without running
/// it. Runs have forms of their own, in core/mechanics.
#pragma once

#include "core/scene/scene.hpp"

namespace wingspread {

/// The function at x. Cost O(log n) for n knots.
[[nodiscard]] double value_at(const Curve& curve, double x);

/// A spring's or a harness's torque, N·m: scale · law + offset.
/// @param travel share of the hinge's way, 0 stowed … 1 latched
[[nodiscard]] double torque_at(const HingeTorque& torque, const Hinge& hinge, double travel);

/// What a torque test both ways adds to the friction of its hinge, N·m; 0 without one. Friction's scale is in it.
[[nodiscard]] double measured_friction_at(const Hinge& hinge, double travel);

/// The Coulomb level that sliding has to overcome, N·m.
[[nodiscard]] double friction_level_at(const Hinge& hinge, double travel);

/// The level that holds at rest, N·m: `static` of the exact friction, else the Coulomb level.
[[nodiscard]] double static_level_at(const Hinge& hinge, double travel);

} // namespace wingspread
