#include "montecarlo/report/data/wing_json.hpp"

#include "montecarlo/model/input_checks/placement.hpp"
#include "montecarlo/model/scene_file/base_json.hpp"
#include "montecarlo/report/data/page_numbers.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace wingspread {
namespace {

using Point = Eigen::Vector2d;

/// The index of the hinge that carries a body.
int hinge_of(const Scene& scene, int body) {
  return static_cast<int>(std::ranges::find(scene.hinges, body, &Hinge::child) -
                          scene.hinges.begin());
}

/// The marks of a body relative to its centre of mass: its own hinge, its children's hinges, its plate's edges.
std::vector<Point> marks_of(const Scene& scene, int body) {
  std::vector<Point> marks{scene.hinges[hinge_of(scene, body)].child_point};
  for (const Hinge& hinge : scene.hinges)
    if (hinge.parent == body) marks.push_back(hinge.parent_point);
  if (const auto& plate = scene.bodies[body].plate)
    marks.insert(marks.end(), {plate->from, plate->to});
  return marks;
}

/// The mark that is furthest from the first mark.
Point furthest(const std::vector<Point>& marks) {
  return *std::ranges::max_element(
      marks, {}, [&](const Point& mark) { return (mark - marks.front()).norm(); });
}

/// Snaps a direction to the nearest axis of the frame if they nearly agree, because the line between two hinges is
/// often slightly oblique to the panel.
Point straightened(Point way) {
  constexpr double slant = 0.2; // heuristic: 11°; if larger, oblique panels are drawn straight
  if (std::abs(way.y()) < slant * std::abs(way.x())) way.y() = 0;
  if (std::abs(way.x()) < slant * std::abs(way.y())) way.x() = 0;
  return way.normalized();
}

BodyOutline panel(const std::vector<Point>& marks, const Point& along) {
  const Point across{-along.y(), along.x()};
  double least = 0, most = 0, thick = 0;
  for (const Point& mark : marks) {
    least = std::min(least, mark.dot(along));
    most = std::max(most, mark.dot(along));
    thick = std::max(thick, std::abs(mark.dot(across)));
  }
  thick = std::max(thick, 0.008 * (most - least));
  const Point from = least * along, to = most * along, side = thick * across;
  return {{from - side, to - side, to + side, from + side}, true};
}

/// Lines from the centre of mass to each mark and back.
BodyOutline star(const std::vector<Point>& marks) {
  BodyOutline outline{{marks.front()}, false};
  for (std::size_t i = 1; i < marks.size(); ++i) {
    outline.points.emplace_back(0, 0);
    outline.points.push_back(marks[i]);
  }
  return outline;
}

/// The outline of a base: a box with its wings on one side, about as large as a panel.
BodyOutline base_outline(const Scene& scene) {
  Point joints{0, 0}, outward{0, 0};
  double reach = 0, count = 0, spread = 0;
  const std::vector<Placement> deployed = place_bodies(scene, latched_angles(scene));
  for (const Hinge& hinge : scene.hinges) {
    if (hinge.parent != base_index) continue;
    joints += hinge.parent_point;
    ++count;
    reach = std::max(reach, 2 * hinge.child_point.norm());
    spread = std::max(spread, hinge.parent_point.norm());
    const Placement& child = deployed[hinge.child];
    outward += (Eigen::Rotation2Dd(child.angle) * -hinge.child_point).normalized();
  }
  joints /= count;
  const double half = 0.15 * reach;
  if (outward.norm() < 0.5 * count ||
      spread > half) { // wings on several sides, or joints that define the box
    const double size = std::max(spread, half);
    return {{{-size, -size}, {size, -size}, {size, size}, {-size, size}}, true};
  }
  const Point along = straightened(outward), across = Point{-along.y(), along.x()} * half;
  const Point inner = joints - 2 * half * along;
  return {{joints - across, joints + across, inner + across, inner - across}, true};
}

Json point_json(const Point& point) { return {page_number(point.x()), page_number(point.y())}; }

Json outline_json(const BodyOutline& outline, const Point& origin) {
  Json json = Json::array();
  for (const Point& point : outline.points) json.push_back(point_json(point - origin));
  return json;
}

/// A point of a body or the base in the page's frame.
Point in_frame(const Scene& scene, int body, const Point& point) {
  return body == base_index ? point
                            : Point(point - scene.hinges[hinge_of(scene, body)].child_point);
}

Json body_json(const Scene& scene, int body) {
  const int h = hinge_of(scene, body);
  const Hinge& hinge = scene.hinges[h];
  const BodyOutline outline = body_outline(scene, body);
  return {{"name", scene.bodies[body].name},
          {"hinge", h},
          {"outline", outline_json(outline, hinge.child_point)},
          {"inner", {0, 0}},
          {"centre", point_json(-hinge.child_point)},
          {"joint_in_parent", point_json(in_frame(scene, hinge.parent, hinge.parent_point))},
          {"closed", outline.closed}};
}

Json base_body_json(const Scene& scene) {
  return {
      {"name", "base"},  {"hinge", -1},      {"outline", outline_json(base_outline(scene), {0, 0})},
      {"inner", {0, 0}}, {"centre", {0, 0}}, {"joint_in_parent", {0, 0}},
      {"closed", true}};
}

Json hinges_json(const Scene& scene) {
  Json json = Json::array();
  for (const Hinge& hinge : scene.hinges)
    json.push_back({{"name", hinge.name},
                    {"stowed", page_number(hinge.stowed)},
                    {"latched", page_number(hinge.latched)},
                    {"latch", hinge.latch.has_value()},
                    {"held", hinge.release.has_value()},
                    {"parent", hinge.parent == base_index ? -1 : hinge_of(scene, hinge.parent)}});
  return json;
}

/// A stop of a hinge at rest.
struct StopAtRest {
  double depth;  ///< δ, rad; < 0: the way to it
  double moment; ///< N·m
};
StopAtRest stop_at_rest(const Stop& stop, double way_to_its_side) {
  const double depth = way_to_its_side - stop.gap;
  return {depth, depth > 0 ? stop.stiffness * depth : 0};
}

/// Notes on how far small swings about its rest describe this hinge.
std::vector<std::string> notes_of(const Hinge& hinge, double rest) {
  constexpr double touching = 1e-9; // rad
  constexpr double far = 0.1; // rad. Heuristic: a latch or a stop that holds the hinge yields less
  std::vector<std::string> notes;
  const double sense = hinge.latched > hinge.stowed ? 1 : -1;
  const auto look_at = [&](const std::optional<Stop>& stop, double way, const char* side) {
    if (!stop) return;
    const auto [depth, moment] = stop_at_rest(*stop, way);
    if (moment > 0)
      notes.push_back(fmt::format("{} presses its stop at the {} side with {:.4g} N·m at rest",
                                  hinge.name, side, moment));
    else if (std::abs(depth) <= touching)
      notes.push_back(fmt::format("{} rests where its stop at the {} side begins: the modes are "
                                  "those of swings away from it, towards it is stiffer",
                                  hinge.name, side));
  };
  look_at(hinge.stop, sense * (hinge.stowed - rest), "stowed");
  look_at(hinge.far_stop, sense * (rest - hinge.latched), "latched");
  if (!hinge.joint && std::abs(rest - hinge.latched) > far && std::abs(rest - hinge.stowed) > far)
    notes.push_back(fmt::format("{} rests at {:.4g} rad, {:.4g} rad from its latched angle",
                                hinge.name, rest, std::abs(rest - hinge.latched)));
  return notes;
}

} // namespace

BodyOutline body_outline(const Scene& scene, int body) {
  std::vector<Point> marks = marks_of(scene, body);
  if (marks.size() == 1) marks.emplace_back(-marks.front()); // the last body of a wing: symmetric
  const Point way = furthest(marks) - marks.front();
  if (way.norm() == 0) return {{{0, 0}, {0, 0}}, false};
  const Point along = straightened(way), across{-along.y(), along.x()};
  const bool bent = std::ranges::any_of(
      marks, [&](const Point& mark) { return std::abs(mark.dot(across)) > 0.2 * way.norm(); });
  return bent ? star(marks) : panel(marks, along);
}

double wing_span(const Scene& scene) {
  Point least{0, 0}, most{0, 0};
  const std::vector<Placement> deployed = place_bodies(scene, latched_angles(scene));
  const Point origin = scene.base.motion == BaseMotion::free ? scene.base.position : Point{0, 0};
  for (std::size_t b = 0; b < deployed.size(); ++b)
    for (const Point& point : body_outline(scene, static_cast<int>(b)).points) {
      const Point there =
          deployed[b].position + Eigen::Rotation2Dd(deployed[b].angle) * point - origin;
      least = least.cwiseMin(there);
      most = most.cwiseMax(there);
    }
  return (most - least).maxCoeff();
}

Json wing_json(const Scene& scene) {
  Json bodies = Json::array({base_body_json(scene)});
  for (const int h : outward_order(scene))
    bodies.push_back(body_json(scene, scene.hinges[h].child));
  const auto motion = static_cast<std::size_t>(scene.base.motion);
  return {
      {"hinges", hinges_json(scene)},
      {"bodies", std::move(bodies)},
      {"scale", page_number(wing_span(scene))},
      {"base",
       {{"kind", base_motion_names[motion]},
        {"angle", page_number(scene.base.motion == BaseMotion::fixed ? 0 : scene.base.angle)}}}};
}

std::vector<std::string> modes_notes(const WingModes& modes) {
  std::vector<std::string> notes;
  for (std::size_t h = 0; h < modes.wing.joints.size(); ++h)
    for (std::string& each : notes_of(modes.wing.scene.hinges[h], modes.rest[h]))
      notes.push_back(std::move(each));
  return notes;
}

} // namespace wingspread
