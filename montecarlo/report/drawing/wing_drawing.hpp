/// The wing as a picture, before it is run: stowed, half-way and deployed.
#pragma once

#include "core/scene/scene.hpp"

#include <string>

namespace wingspread {

/// An SVG picture of three views. Each shows the bodies, centres of mass, hinge axes, the sense in which each spring
/// turns its child, names, and a scale. A body is drawn along its plate; without a plate from the hinge through the
/// centre of mass. Same scene, same bytes.
/// @pre outward_order(scene) is not empty
[[nodiscard]] std::string draw_wing(const Scene& scene);

} // namespace wingspread
