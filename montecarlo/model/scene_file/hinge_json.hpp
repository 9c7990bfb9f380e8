/// A hinge from JSON and back: its joint, and all that acts across it.
#pragma once

#include "montecarlo/model/scene_file/scene_tree.hpp"

#include <array>
#include <string_view>

namespace wingspread {

/// The words for each enumeration, in the order of its values.
inline constexpr std::array<std::string_view, 2> friction_model_names{"regularized", "exact"};
inline constexpr std::array<std::string_view, 3> damper_law_names{"viscous", "power",
                                                                  "eddy_current"};

/// Reads a hinge but for its ends, whose names it returns.
[[nodiscard]] HingeEnds read_hinge(const JsonCursor& at, Hinge& hinge);

/// The hinge in full.
/// @param scene that knows the names of its bodies
[[nodiscard]] Json write_hinge(const Scene& scene, const Hinge& hinge);

[[nodiscard]] Json write_vector(const Eigen::Vector2d& vector);

} // namespace wingspread
