#include "montecarlo/model/input_checks/size_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace wingspread {
namespace {

constexpr double turn = 2 * std::numbers::pi;
// Heuristics; most_ratio is derived in the header. A real wing beyond these limits gets a false warning.
constexpr double most_length = 50; // m
constexpr double most_ratio = 20;  // of a radius of gyration and a distance, either way
constexpr double most_play = 0.1;  // a stop's gap or a latch's backlash over the travel
constexpr double most_base = 1000; // of a free base's mass and that of its bodies, either way
constexpr const char* usual_angle =
    "an angle within a turn, ±6.28 rad (write degrees as \"90 deg\")";

bool looks_like_degrees(double angle) { return std::abs(angle) > turn * (1 + 1e-9); }

void check_angle(const std::string& pointer, double angle, InputWarnings& warnings) {
  if (looks_like_degrees(angle)) warnings.add(pointer, fmt::format("{} rad", angle), usual_angle);
}

void check_table(const std::string& pointer, const HingeTorque& torque, InputWarnings& warnings) {
  if (!torque.table) return;
  const std::vector<double>& angle = torque.table->angle();
  const auto widest = std::ranges::max_element(angle, {}, [](double a) { return std::abs(a); });
  const char* key = torque.table->both_ways() ? "/measured/angle" : "/table/angle";
  check_angle(pointer + key, *widest, warnings);
}

void check_play(const std::string& pointer, double play, const Hinge& hinge,
                InputWarnings& warnings) {
  const double travel = std::abs(hinge.latched - hinge.stowed);
  if (play > most_play * travel)
    warnings.add(pointer, fmt::format("{:.4g} rad with a travel of {:.4g} rad", play, travel),
                 "a play below a tenth of the travel (write degrees as \"0.5 deg\")");
}

void check_angles(const std::string& at, const Hinge& hinge, InputWarnings& warnings) {
  check_angle(at + "/angle/stowed", hinge.stowed, warnings);
  check_angle(at + "/angle/latched", hinge.latched, warnings);
  if (!looks_like_degrees(hinge.stowed) && !looks_like_degrees(hinge.latched) &&
      looks_like_degrees(hinge.latched - hinge.stowed))
    warnings.add(at + "/angle",
                 fmt::format("a travel of {:.4g} rad", std::abs(hinge.latched - hinge.stowed)),
                 "a travel within a turn, 6.28 rad");
  check_table(at + "/spring", hinge.spring, warnings);
  check_table(at + "/harness", hinge.harness, warnings);
  if (hinge.damper && hinge.damper->window)
    for (const std::size_t end : {0U, 1U})
      check_angle(fmt::format("{}/damper/window/{}", at, end), (*hinge.damper->window)[end],
                  warnings);
  if (hinge.stop) check_play(at + "/stop/gap", hinge.stop->gap, hinge, warnings);
  if (hinge.far_stop)
    check_play(at + (hinge.stop ? "/stop" : "/stop/gap"), hinge.far_stop->gap, hinge, warnings);
  if (hinge.latch) check_play(at + "/latch/backlash", hinge.latch->backlash, hinge, warnings);
}

double radius_of_gyration(double mass, double inertia) { return std::sqrt(inertia / mass); }

/// Returns false if it has warned.
bool check_length(const std::string& pointer, double length, InputWarnings& warnings) {
  if (length <= most_length) return true;
  warnings.add(pointer, fmt::format("{:.4g} m from the centre of mass", length),
               fmt::format("up to {} m (write millimetres as \"505 mm\")", most_length));
  return false;
}

std::string in_gyration(double radius) {
  return fmt::format("{} to {} times the radius of gyration, √(inertia/mass) = {:.4g} m",
                     1 / most_ratio, most_ratio, radius);
}

/// Checks the hinge's distance from the outer body's centre of mass, and this body's radius of gyration.
void check_child(const Scene& scene, std::size_t h, InputWarnings& warnings) {
  const Hinge& hinge = scene.hinges[h];
  const Body& body = scene.bodies[hinge.child];
  const std::string at = fmt::format("/hinges/{}/child_point", h);
  const double distance = hinge.child_point.norm();
  const double radius = radius_of_gyration(body.mass, body.inertia);
  const std::string inertia = fmt::format("/bodies/{}/inertia", hinge.child);
  const std::string gyration =
      fmt::format("a radius of gyration, √(inertia/mass), of {:.4g} m", radius);
  if (!check_length(at, distance, warnings)) return;
  if (radius > most_length)
    warnings.add(
        inertia, gyration,
        fmt::format("up to {} m (write other units as \"5e5 kg*mm^2\", \"10000 g\")", most_length));
  else if (distance * 50 * most_ratio < radius)
    warnings.add(at, fmt::format("{:.4g} m from the centre of mass of {}", distance, body.name),
                 "a hinge at the body's edge: " + in_gyration(radius));
  else if (distance * most_ratio < radius || distance > most_ratio * radius)
    warnings.add(inertia, fmt::format("{}, with the hinge at {:.4g} m", gyration, distance),
                 fmt::format("{} to {} times the hinge's distance (write other units as \"5e5 "
                             "kg*mm^2\", \"10000 g\", \"505 mm\")",
                             1 / most_ratio, most_ratio));
}

/// The square of the radius of gyration about the centre of mass of a thin body along a line: L²/12 + |middle|², m².
double gyration_of_line(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  return (to - from).squaredNorm() / 12 + (0.5 * (from + to)).squaredNorm();
}

/// The longest line that is known of the hinge's child: its plate, or from its hinge to one that it carries; nothing if
/// it has neither.
std::optional<double> gyration_of_child(const Scene& scene, const Hinge& hinge) {
  if (const auto& plate = scene.bodies[hinge.child].plate)
    return gyration_of_line(plate->from, plate->to);
  std::optional<double> largest;
  for (const Hinge& next : scene.hinges)
    if (next.parent == hinge.child)
      largest =
          std::max(largest.value_or(0), gyration_of_line(hinge.child_point, next.parent_point));
  return largest;
}

/// Checks for an inertia about the hinge, J + m d². A uniform panel has m L²/12 about its centre of mass and four times
/// as much about a hinge at its edge; twice as much is the middle between the two.
void check_inertia(const Scene& scene, std::size_t h, InputWarnings& warnings) {
  const Hinge& hinge = scene.hinges[h];
  const Body& body = scene.bodies[hinge.child];
  const std::optional<double> gyration = gyration_of_child(scene, hinge);
  const double about_hinge = body.mass * hinge.child_point.squaredNorm();
  if (!gyration || body.inertia < about_hinge || body.inertia < 2 * body.mass * *gyration) return;
  warnings.add(
      fmt::format("/bodies/{}/inertia", hinge.child),
      fmt::format(
          "{:.4g} kg·m², more than mass times the squared distance to the hinge {}, {:.4g} kg·m²",
          body.inertia, hinge.name, about_hinge),
      fmt::format(
          "the inertia about the centre of mass, about {:.4g} kg·m² for a uniform body of this "
          "length (about the hinge it is larger by mass times distance²)",
          body.mass * *gyration));
}

/// Checks a free base's mass against that of all bodies.
void check_base(const Scene& scene, InputWarnings& warnings) {
  if (scene.base.motion != BaseMotion::free) return;
  double bodies = 0;
  for (const Body& body : scene.bodies) bodies += body.mass;
  if (scene.base.mass <= most_base * bodies && bodies <= most_base * scene.base.mass) return;
  warnings.add(
      "/base/mass", fmt::format("{:.4g} kg, with bodies of {:.4g} kg", scene.base.mass, bodies),
      fmt::format(
          "1/{0} to {0} times the mass of the bodies (write grams as \"5000 g\", tonnes as \"2000 "
          "kg\"; a much heavier base is as good as \"fixed\")",
          most_base));
}

/// Checks the hinge's distance from the inner body's centre of mass. Only a free base has a mass to compare with.
void check_parent(const Scene& scene, std::size_t h, InputWarnings& warnings) {
  const Hinge& hinge = scene.hinges[h];
  const std::string at = fmt::format("/hinges/{}/parent_point", h);
  const double distance = hinge.parent_point.norm();
  const bool on_base = hinge.parent == base_index;
  if (!check_length(at, distance, warnings) || (on_base && scene.base.motion != BaseMotion::free))
    return;
  const double radius = on_base ? radius_of_gyration(scene.base.mass, scene.base.inertia)
                                : radius_of_gyration(scene.bodies[hinge.parent].mass,
                                                     scene.bodies[hinge.parent].inertia);
  if (distance > most_ratio * radius)
    warnings.add(at, fmt::format("{:.4g} m from the centre of mass", distance),
                 in_gyration(radius));
}

void check_plate(const std::string& at, const Body& body, InputWarnings& warnings) {
  if (!body.plate) return;
  const Plate& plate = *body.plate;
  const double radius = radius_of_gyration(body.mass, body.inertia);
  const double reach = std::max(plate.from.norm(), plate.to.norm());
  if (check_length(at + "/plate", reach, warnings) && reach > most_ratio * radius)
    warnings.add(at + "/plate", fmt::format("an edge {:.4g} m from the centre of mass", reach),
                 in_gyration(radius));
  if (plate.width > most_length)
    warnings.add(at + "/plate/width", fmt::format("{:.4g} m", plate.width),
                 fmt::format("up to {} m (write millimetres as \"2000 mm\")", most_length));
}

} // namespace

void check_sizes(const Scene& scene, InputWarnings& warnings) {
  if (scene.base.motion != BaseMotion::fixed)
    check_angle("/base/angle", scene.base.angle, warnings);
  check_base(scene, warnings);
  for (std::size_t h = 0; h < scene.hinges.size(); ++h) {
    check_angles(fmt::format("/hinges/{}", h), scene.hinges[h], warnings);
    check_child(scene, h, warnings);
    check_inertia(scene, h, warnings);
    check_parent(scene, h, warnings);
  }
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    check_plate(fmt::format("/bodies/{}", b), scene.bodies[b], warnings);
}

} // namespace wingspread
