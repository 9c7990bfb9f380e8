/// Reads and writes a hinge: its joint, torques, damper, stop and latch.
#pragma once

#include "montecarlo/model/scene_file/scene_tree.hpp"

#include <array>
#include <string_view>

namespace wingspread {

/// The words of `model` and `law`, by the enumerations' values.
inline constexpr std::array<std::string_view, 2> friction_model_names{"regularized", "exact"};
inline constexpr std::array<std::string_view, 3> damper_law_names{"viscous", "power",
                                                                  "eddy_current"};

inline constexpr std::array<std::string_view, 2> release_event_names{"latched", "released"};
inline constexpr std::array<std::string_view, 2> stop_side_names{"stowed", "latched"};

/// Reads a hinge. Returns the names of its ends, for link_hinges.
[[nodiscard]] HingeEnds read_hinge(const JsonCursor& at, Hinge& hinge);

/// The hinge with all defaults explicit.
/// @param scene for the names of bodies and hinges
[[nodiscard]] Json write_hinge(const Scene& scene, const Hinge& hinge);

[[nodiscard]] Json write_vector(const Eigen::Vector2d& vector);

} // namespace wingspread
