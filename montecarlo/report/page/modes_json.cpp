#include "montecarlo/report/page/modes_json.hpp"

#include "core/proofs/natural_modes.hpp"
#include "montecarlo/model/input_checks/placement.hpp"
#include "montecarlo/report/data/page_numbers.hpp"
#include "montecarlo/report/data/wing_json.hpp"

#include <utility>
#include <vector>

namespace wingspread {
namespace {

constexpr std::size_t most_shapes = 6;

/// The common centre of mass with the hinges off rest by `amplitude` times the mode's angles. @pre a free base
Eigen::Vector2d center_of_mass(const WingModes& modes, const NaturalMode& mode, double amplitude) {
  Scene scene = modes.wing.scene;
  scene.base.angle += amplitude * mode.base_angle;
  std::vector<double> angles = modes.rest;
  for (std::size_t h = 0; h < angles.size(); ++h) angles[h] += amplitude * mode.shape[h];
  const std::vector<Placement> bodies = place_bodies(scene, angles);
  Eigen::Vector2d moment = scene.base.mass * scene.base.position;
  double mass = scene.base.mass;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    moment += scene.bodies[b].mass * bodies[b].position;
    mass += scene.bodies[b].mass;
  }
  return moment / mass;
}

/// Motion of a free base for a unit of the mode, by which the common centre of mass stays at rest.
Json base_json(const WingModes& modes, const NaturalMode& mode) {
  if (modes.wing.scene.base.motion != BaseMotion::free) return nullptr;
  constexpr double small = 1e-4; // rad: a difference of first order
  const Eigen::Vector2d shift =
      (center_of_mass(modes, mode, -small) - center_of_mass(modes, mode, small)) / (2 * small);
  return {{"x", page_number(shift.x())},
          {"y", page_number(shift.y())},
          {"angle", page_number(mode.base_angle)}};
}

} // namespace

Json modes_json(const Scene& scene) {
  if (!unphysical(scene).empty()) return nullptr;
  const std::optional<WingModes> modes = natural_modes(scene);
  if (!modes) return nullptr;
  Json list = Json::array();
  for (const NaturalMode& mode : modes->modes) {
    if (list.size() == most_shapes) break;
    list.push_back({{"frequency", page_number(mode.frequency)},
                    {"damping_ratio", page_number(mode.damping_ratio)},
                    {"shape", page_numbers(mode.shape)},
                    {"base", base_json(*modes, mode)}});
  }
  return {{"wing", wing_json(modes->wing.scene)},
          {"rest", page_numbers(modes->rest)},
          {"notes", modes_notes(*modes)},
          {"modes", std::move(list)}};
}

} // namespace wingspread
