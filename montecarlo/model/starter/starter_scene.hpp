/// The scene of a designed wing, line by line.
#pragma once

#include "core/scene/scene.hpp"
#include "montecarlo/model/starter/annotated_json.hpp"
#include "montecarlo/model/starter/wing_design.hpp"

namespace wingspread {

/// The longest deployment that is tried, s.
inline constexpr double latest_end = 3600;

/// @pre check_design() accepts it, and it has a damper, or 0 for none
[[nodiscard]] AnnotatedLines starter_scene(const WingDesign& design);

/// The scene as `check` reads it.
[[nodiscard]] Scene scene_of(const WingDesign& design);

/// A damper with which the wing takes about twice the time that it takes without: T t/φ, with the root's travel φ, the
/// time t without a damper and the mean torque T of all hinges, referred to the root by the loops. Two digits,
/// N·m·s/rad. 0 if the wing does not deploy.
[[nodiscard]] double suggested_damper(WingDesign design);

/// Rounds to two digits: an engineer's number.
[[nodiscard]] double two_digits(double value);

} // namespace wingspread
