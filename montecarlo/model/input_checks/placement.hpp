/// The bodies' positions at given hinge angles, to compare with the drawing.
///
/// | symbol | meaning                                                          | unit |
/// |--------|------------------------------------------------------------------|------|
/// | θ_i    | absolute angle of body i: θ_i = θ_p + φ_i                        | rad  |
/// | r_i    | centre of mass of body i: r_i = r_p + R(θ_p) c_pi − R(θ_i) c_ii  | m    |
#pragma once

#include "core/scene/scene.hpp"

#include <span>
#include <string>
#include <vector>

namespace wingspread {

struct Placement {
  Eigen::Vector2d position{0, 0}; ///< of the centre of mass, inertial axes, m
  double angle = 0;               ///< rad
};

/// Places all bodies, in the scene's order, with the base at its initial position; a fixed base is at the origin.
/// @param angles of the hinges, in the scene's order, rad
/// @pre outward_order(scene) is not empty
[[nodiscard]] std::vector<Placement> place_bodies(const Scene& scene,
                                                  std::span<const double> angles);

[[nodiscard]] std::vector<double> stowed_angles(const Scene& scene);
[[nodiscard]] std::vector<double> latched_angles(const Scene& scene);

/// A table of all bodies stowed and deployed, in m and degrees, and their total mass.
[[nodiscard]] std::string describe_placement(const Scene& scene);

} // namespace wingspread
