#include "montecarlo/model/input_checks/shape_checks.hpp"

#include "montecarlo/foundation/formats/text_layout.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wingspread {
namespace {

constexpr double closest =
    1e-3; // of a length: points nearer than that coincide. Heuristic: mm in a 1 m panel

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Whether p and q are on opposite sides of the first line, each further away than `closest` of the second line's
/// length.
bool parts(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Eigen::Vector2d& p,
           const Eigen::Vector2d& q) {
  const Eigen::Vector2d along = to - from;
  const double least = closest * along.norm() * (q - p).norm();
  const double a = cross(along, p - from), b = cross(along, q - from);
  return (a > least && b < -least) || (a < -least && b > least);
}

Eigen::Vector2d placed(const Placement& body, const Eigen::Vector2d& point) {
  return body.position + Eigen::Rotation2Dd(body.angle) * point;
}

/// The hinge that carries a body.
std::size_t hinge_of(const Scene& scene, int body) {
  return static_cast<std::size_t>(std::ranges::find(scene.hinges, body, &Hinge::child) -
                                  scene.hinges.begin());
}

/// Whether a body is another one or is carried by it.
bool is_carried_by(const Scene& scene, int body, int other) {
  while (body != other && body != base_index) body = scene.hinges[hinge_of(scene, body)].parent;
  return body == other;
}

/// The hinge whose angle moves one of two bodies against the other: that of the outer one, wherever it stands in the
/// file; of bodies beside each other the later hinge.
std::size_t hinge_between(const Scene& scene, int a, int b) {
  if (is_carried_by(scene, a, b)) return hinge_of(scene, a);
  if (is_carried_by(scene, b, a)) return hinge_of(scene, b);
  return std::max(hinge_of(scene, a), hinge_of(scene, b));
}

/// Whether the body is modelled without thickness: its hinge points lie on an axis of its frame.
bool is_thin(const Scene& scene, int body) {
  Eigen::Vector2d beyond{0, 0};
  for (const Hinge& hinge : scene.hinges) {
    if (hinge.child == body) beyond = beyond.cwiseMax(hinge.child_point.cwiseAbs());
    if (hinge.parent == body) beyond = beyond.cwiseMax(hinge.parent_point.cwiseAbs());
  }
  return beyond.minCoeff() <= 1e-9 * beyond.maxCoeff();
}

void check_stowed(const Scene& scene, const Arms& arms, InputWarnings& warnings) {
  const std::vector<Placement> bodies = place_bodies(scene, stowed_angles(scene));
  const auto tell = [&](int a, int b, const char* what) {
    warnings.add(
        fmt::format("/hinges/{}/angle/stowed", hinge_between(scene, a, b)),
        fmt::format("{} and {} {} when stowed", scene.bodies[a].name, scene.bodies[b].name, what),
        "bodies side by side (`wingspread check` prints where they are)");
  };
  for (int a = 0; a < std::ssize(bodies); ++a)
    for (int b = a + 1; b < std::ssize(bodies); ++b) {
      const double near = closest * std::min(arms.reach(a), arms.reach(b));
      if ((bodies[a].position - bodies[b].position).norm() < near &&
          !(is_thin(scene, a) && is_thin(scene, b)))
        return tell(a, b, "have their centres of mass in one place");
    }
  if (const auto crossing = arms.first_crossing(bodies))
    tell(crossing->first, crossing->second, "lie across each other");
}

double direction(const Eigen::Vector2d& vector) { return std::atan2(vector.y(), vector.x()); }

/// Whether a whole turn lies strictly between two angles.
bool passes_turn(double from, double to) {
  constexpr double whole = 2 * std::numbers::pi, least = 1e-6;
  const auto [lower, upper] = std::minmax(from, to);
  return std::floor((upper - least) / whole) > std::floor((lower + least) / whole);
}

/// Warns of a body that turns through its parent: seen from their hinge, the two centres of mass are in the same
/// direction somewhere between stowed and latched.
void check_turning(const Scene& scene, std::size_t h, InputWarnings& warnings) {
  const Hinge& hinge = scene.hinges[h];
  if (hinge.parent_point.norm() == 0 || hinge.child_point.norm() == 0) return;
  if (std::abs(hinge.latched - hinge.stowed) > 2 * std::numbers::pi)
    return; // probably degrees, which has its own warning
  const double apart = direction(-hinge.child_point) - direction(-hinge.parent_point);
  if (!passes_turn(apart + hinge.stowed, apart + hinge.latched)) return;
  warnings.add(fmt::format("/hinges/{}/angle", h),
               fmt::format("{} turns through {} on its way from {} to {} deg",
                           scene.bodies[hinge.child].name, scene.bodies[hinge.parent].name,
                           degrees_text(hinge.stowed), degrees_text(hinge.latched)),
               "a rotation on the open side: the other sense, or hinge points of the other sign");
}

/// The vector's larger component: along a panel.
Eigen::Vector2d along(const Eigen::Vector2d& point) {
  return std::abs(point.x()) >= std::abs(point.y()) ? Eigen::Vector2d{point.x(), 0}
                                                    : Eigen::Vector2d{0, point.y()};
}

/// Whether two points are on the same side of the body, each as seen from its centre of mass.
bool same_side(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.dot(b) > 0.5 * a.norm() * b.norm();
}

bool are_mirrored(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (a.cwiseAbs() - b.cwiseAbs()).norm() <= 1e-6 * a.norm();
}

/// Checks a joint between two bodies that latches at 0.
void check_joint(const Scene& scene, std::size_t h, InputWarnings& warnings) {
  const Hinge& hinge = scene.hinges[h];
  const Hinge& before = scene.hinges[hinge_of(scene, hinge.parent)];
  const std::string at = fmt::format("/hinges/{}/", h);
  const std::string& child = scene.bodies[hinge.child].name;
  const std::string& parent = scene.bodies[hinge.parent].name;
  const Eigen::Vector2d step = hinge.parent_point - hinge.child_point;
  if (same_side(hinge.parent_point, before.child_point))
    warnings.add(
        at + "parent_point",
        fmt::format("{} carries {} on the side of its own hinge, {}", parent, child, before.name),
        "the other side: latched at 0, the wing continues straight");
  else if (same_side(hinge.parent_point, hinge.child_point))
    warnings.add(at + "child_point",
                 fmt::format("{} folds back over {} when deployed", child, parent),
                 "a hinge on the parent's side: latched at 0, the wing continues straight");
  else if (are_mirrored(hinge.parent_point, hinge.child_point) &&
           (step - along(step)).norm() > 1e-6 * step.norm())
    warnings.add(at + "child_point",
                 fmt::format("{} stands {:.4g} m beside the line of {} when deployed", child,
                             (step - along(step)).norm(), parent),
                 "a wing in line: latched at 0, with mirror images as hinge points (one has the "
                 "wrong sign)");
}

} // namespace

Arms::Arms(const Scene& scene) : of_body_(scene.bodies.size()) {
  const auto add = [&](int body, const Eigen::Vector2d& point) {
    if (body != base_index && point.norm() > 0)
      of_body_[body].emplace_back(Eigen::Vector2d{0, 0}, point);
  };
  for (const Hinge& hinge : scene.hinges) {
    add(hinge.child, hinge.child_point);
    add(hinge.parent, hinge.parent_point);
  }
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (const auto& plate = scene.bodies[b].plate) of_body_[b].emplace_back(plate->from, plate->to);
  for (const std::vector<Line>& lines : of_body_) {
    double reach = 0;
    for (const auto& [from, to] : lines) reach = std::max({reach, from.norm(), to.norm()});
    reach_.push_back(reach);
  }
}

std::optional<std::pair<int, int>> Arms::first_crossing(std::span<const Placement> bodies) const {
  const auto cross_each_other = [&](int a, int b) {
    for (const auto& [from, to] : of_body_[a])
      for (const auto& [p, q] : of_body_[b]) {
        const Eigen::Vector2d a0 = placed(bodies[a], from), a1 = placed(bodies[a], to),
                              b0 = placed(bodies[b], p), b1 = placed(bodies[b], q);
        if (parts(a0, a1, b0, b1) && parts(b0, b1, a0, a1)) return true;
      }
    return false;
  };
  for (int a = 0; a < std::ssize(bodies); ++a)
    for (int b = a + 1; b < std::ssize(bodies); ++b) {
      const double apart = (bodies[a].position - bodies[b].position).norm();
      if (apart < reach(a) + reach(b) && cross_each_other(a, b)) return std::pair(a, b);
    }
  return std::nullopt;
}

namespace {

double travel_of(const Hinge& hinge) { return std::abs(hinge.latched - hinge.stowed); }

constexpr double most_out_of_step = 0.01; // of the travel. Heuristic: far above rounded ratios

double gear_of(const Synchronisation& loop, double travel) {
  return loop.table ? loop.table->value_at(travel) : loop.ratio * travel;
}

/// Checks that two loops between the same hinges agree all along the travel.
void check_both(const Scene& scene, std::size_t k, std::size_t m, InputWarnings& warnings) {
  const Synchronisation &one = scene.synchronisations[k], &other = scene.synchronisations[m];
  const bool turned = one.first == other.second && one.second == other.first;
  if (!turned && (one.first != other.first || one.second != other.second)) return;
  constexpr int steps = 200;
  const double travel = travel_of(scene.hinges[one.first]);
  double worst = 0, where = 0;
  for (int step = 0; step <= steps; ++step) {
    const double x = travel * step / steps, y = gear_of(one, x);
    const double apart = turned ? std::abs(gear_of(other, y) - x) : std::abs(gear_of(other, x) - y);
    if (apart > worst) worst = apart, where = x;
  }
  const Hinge& strained = scene.hinges[turned ? one.first : one.second];
  if (worst <= most_out_of_step * travel_of(strained)) return;
  warnings.add(
      fmt::format("/synchronisations/{}", m),
      fmt::format("a loop {} deg of {} out of step with {} where {} has turned {} deg",
                  degrees_text(worst), strained.name, one.name, scene.hinges[one.first].name,
                  degrees_text(where)),
      "one ratio between two hinges at every angle: else the loops hold them back, which the "
      "static margins do not count");
}

/// Checks that a loop lets both of its hinges reach their latches.
void check_loop(const Scene& scene, std::size_t k, InputWarnings& warnings) {
  const Synchronisation& loop = scene.synchronisations[k];
  const Hinge &first = scene.hinges[loop.first], &second = scene.hinges[loop.second];
  if (!first.latch || !second.latch) return;
  const double given = gear_of(loop, travel_of(first));
  const double needed = travel_of(second);
  if (std::abs(given - needed) <= most_out_of_step * needed) return;
  warnings.add(fmt::format("/synchronisations/{}/ratio", k),
               fmt::format("{} deg of {} where {} latches, after {} deg", degrees_text(given),
                           second.name, first.name, degrees_text(travel_of(first))),
               fmt::format("{} deg, where {} latches: else the cable holds one of them back{}",
                           degrees_text(needed), second.name,
                           loop.table
                               ? ""
                               : fmt::format(" (a ratio of {:.6g})", needed / travel_of(first))));
}

} // namespace

void check_shape(const Scene& scene, InputWarnings& warnings) {
  for (std::size_t k = 0; k < scene.synchronisations.size(); ++k) {
    check_loop(scene, k, warnings);
    for (std::size_t m = k + 1; m < scene.synchronisations.size(); ++m)
      check_both(scene, k, m, warnings);
  }
  check_stowed(scene, Arms(scene), warnings);
  for (std::size_t h = 0; h < scene.hinges.size(); ++h) {
    const Hinge& hinge = scene.hinges[h];
    if (hinge.parent == base_index) continue;
    check_turning(scene, h, warnings);
    if (std::abs(std::remainder(hinge.latched, 2 * std::numbers::pi)) < 1e-9)
      check_joint(scene, h, warnings);
  }
}

} // namespace wingspread
