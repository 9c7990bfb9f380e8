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

/// A damper with which the nominal wing takes twice the time that it takes without, to a tenth. Two digits, N·m·s/rad.
/// 0 if there is none, because the wing does not deploy without or with so large a damper.
[[nodiscard]] double suggested_damper(WingDesign design);

/// Rounds to two digits: an engineer's number.
[[nodiscard]] double two_digits(double value);

} // namespace wingspread
