#include "montecarlo/model/input_checks/placement.hpp"

#include "montecarlo/foundation/formats/text_layout.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numbers>

namespace wingspread {
namespace {

Eigen::Vector2d turned(const Eigen::Vector2d& vector, double angle) {
  return Eigen::Rotation2Dd(angle) * vector;
}

Placement placement_of(const Base& base) {
  if (base.motion == BaseMotion::fixed) return {};
  return {base.motion == BaseMotion::free ? base.position : Eigen::Vector2d{0, 0}, base.angle};
}

/// In (−180°, 180°]; magnitudes below 1e-9° become 0.
double in_degrees(double angle) {
  const double degrees = std::remainder(angle * 180 / std::numbers::pi, 360.0);
  return std::abs(degrees) < 1e-9 ? 0 : degrees;
}

double in_metres(double length) { return std::abs(length) < 5e-7 ? 0 : length; }

std::string placed(const Placement& body) {
  return fmt::format("{:>12.4f}{:>12.4f}{:>10.2f}", in_metres(body.position.x()),
                     in_metres(body.position.y()), in_degrees(body.angle));
}

} // namespace

std::vector<Placement> place_bodies(const Scene& scene, std::span<const double> angles) {
  std::vector<Placement> bodies(scene.bodies.size());
  const Placement base = placement_of(scene.base);
  for (const int h : outward_order(scene)) {
    const Hinge& hinge = scene.hinges[h];
    const Placement& parent = hinge.parent == base_index ? base : bodies[hinge.parent];
    const double angle = parent.angle + angles[h];
    bodies[hinge.child] = {parent.position + turned(hinge.parent_point, parent.angle) -
                               turned(hinge.child_point, angle),
                           angle};
  }
  return bodies;
}

std::vector<double> stowed_angles(const Scene& scene) {
  std::vector<double> angles;
  std::ranges::transform(scene.hinges, std::back_inserter(angles), &Hinge::stowed);
  return angles;
}

std::vector<double> latched_angles(const Scene& scene) {
  std::vector<double> angles;
  std::ranges::transform(scene.hinges, std::back_inserter(angles), &Hinge::latched);
  return angles;
}

std::string describe_placement(const Scene& scene) {
  const std::vector<Placement> stowed = place_bodies(scene, stowed_angles(scene));
  const std::vector<Placement> deployed = place_bodies(scene, latched_angles(scene));
  std::string text =
      fmt::format("{:<24}{:>34}{:>34}\n{:<24}", "centres of mass", "stowed", "deployed", "");
  for (int k = 0; k < 2; ++k) text += fmt::format("{:>12}{:>12}{:>10}", "x, m", "y, m", "deg");
  double mass = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    mass += scene.bodies[b].mass;
    text +=
        fmt::format("\n  {:<22}{}{}", scene.bodies[b].name, placed(stowed[b]), placed(deployed[b]));
  }
  return text + fmt::format("\nmass of {}: {:.6g} kg\n",
                            counted(std::ssize(scene.bodies), "body", "bodies"), mass);
}

} // namespace wingspread
