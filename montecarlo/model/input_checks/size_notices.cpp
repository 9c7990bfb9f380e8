#include "montecarlo/model/input_checks/size_notices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace wingspread {
namespace {

constexpr double turn = 2 * std::numbers::pi;
constexpr double most_length = 50; // m
constexpr double most_ratio = 20;  // of a radius of gyration and a distance, either way
constexpr double most_play = 0.1;  // of the travel: a stop's gap, a latch's backlash
constexpr const char* usual_angle =
    "an angle within a turn, ±6.28 rad (degrees are written \"90 deg\")";

bool looks_like_degrees(double angle) { return std::abs(angle) > turn * (1 + 1e-9); }

void notice_angle(const std::string& pointer, double angle, Notices& notices) {
  if (looks_like_degrees(angle)) notices.add(pointer, fmt::format("{} rad", angle), usual_angle);
}

void notice_table(const std::string& pointer, const HingeTorque& torque, Notices& notices) {
  if (!torque.table) return;
  const std::vector<double>& angle = torque.table->angle();
  const auto widest = std::ranges::max_element(angle, {}, [](double a) { return std::abs(a); });
  const char* key = torque.table->both_ways() ? "/measured/angle" : "/table/angle";
  notice_angle(pointer + key, *widest, notices);
}

void notice_play(const std::string& pointer, double play, const Hinge& hinge, Notices& notices) {
  const double travel = std::abs(hinge.latched - hinge.stowed);
  if (play > most_play * travel)
    notices.add(pointer, fmt::format("{:.4g} rad, of a travel of {:.4g} rad", play, travel),
                "play below a tenth of the travel (degrees are written \"0.5 deg\")");
}

void notice_angles(const std::string& at, const Hinge& hinge, Notices& notices) {
  notice_angle(at + "/angle/stowed", hinge.stowed, notices);
  notice_angle(at + "/angle/latched", hinge.latched, notices);
  if (!looks_like_degrees(hinge.stowed) && !looks_like_degrees(hinge.latched) &&
      looks_like_degrees(hinge.latched - hinge.stowed))
    notices.add(at + "/angle",
                fmt::format("a travel of {:.4g} rad", std::abs(hinge.latched - hinge.stowed)),
                "a travel within a turn, 6.28 rad");
  notice_table(at + "/spring", hinge.spring, notices);
  notice_table(at + "/harness", hinge.harness, notices);
  if (hinge.damper && hinge.damper->window)
    for (const std::size_t end : {0U, 1U})
      notice_angle(fmt::format("{}/damper/window/{}", at, end), (*hinge.damper->window)[end],
                   notices);
  if (hinge.stop) notice_play(at + "/stop/gap", hinge.stop->gap, hinge, notices);
  if (hinge.latch) notice_play(at + "/latch/backlash", hinge.latch->backlash, hinge, notices);
}

double radius_of_gyration(double mass, double inertia) { return std::sqrt(inertia / mass); }

/// @return whether the length can be one
bool notice_length(const std::string& pointer, double length, Notices& notices) {
  if (length <= most_length) return true;
  notices.add(pointer, fmt::format("{:.4g} m from the centre of mass", length),
              fmt::format("up to {} m (millimetres are written \"505 mm\")", most_length));
  return false;
}

std::string in_gyration(double radius) {
  return fmt::format("{} to {} times the radius of gyration, √(inertia/mass) = {:.4g} m",
                     1 / most_ratio, most_ratio, radius);
}

/// Of the body behind the hinge: its hinge's distance, and how its mass is spread.
void notice_child(const Scene& scene, std::size_t h, Notices& notices) {
  const Hinge& hinge = scene.hinges[h];
  const Body& body = scene.bodies[hinge.child];
  const std::string at = fmt::format("/hinges/{}/child_point", h);
  const double distance = hinge.child_point.norm();
  const double radius = radius_of_gyration(body.mass, body.inertia);
  const std::string inertia = fmt::format("/bodies/{}/inertia", hinge.child);
  const std::string gyration =
      fmt::format("a radius of gyration, √(inertia/mass), of {:.4g} m", radius);
  if (!notice_length(at, distance, notices)) return;
  if (radius > most_length)
    notices.add(inertia, gyration,
                fmt::format("up to {} m (other units are written \"5e5 kg*mm^2\", \"10000 g\")",
                            most_length));
  else if (distance * 50 * most_ratio < radius)
    notices.add(at, fmt::format("{:.4g} m from the centre of mass of {}", distance, body.name),
                "a hinge at the body's edge: " + in_gyration(radius));
  else if (distance * most_ratio < radius || distance > most_ratio * radius)
    notices.add(inertia, fmt::format("{}, with the hinge at {:.4g} m", gyration, distance),
                fmt::format("{} to {} times the hinge's distance (other units are written \"5e5 "
                            "kg*mm^2\", \"10000 g\", \"505 mm\")",
                            1 / most_ratio, most_ratio));
}

/// Of the body before the hinge: the hinge's distance. A base that is no body has no size.
void notice_parent(const Scene& scene, std::size_t h, Notices& notices) {
  const Hinge& hinge = scene.hinges[h];
  const std::string at = fmt::format("/hinges/{}/parent_point", h);
  const double distance = hinge.parent_point.norm();
  const bool on_base = hinge.parent == base_index;
  if (!notice_length(at, distance, notices) || (on_base && scene.base.motion != BaseMotion::free))
    return;
  const double radius = on_base ? radius_of_gyration(scene.base.mass, scene.base.inertia)
                                : radius_of_gyration(scene.bodies[hinge.parent].mass,
                                                     scene.bodies[hinge.parent].inertia);
  if (distance > most_ratio * radius)
    notices.add(at, fmt::format("{:.4g} m from the centre of mass", distance), in_gyration(radius));
}

void notice_plate(const std::string& at, const Body& body, Notices& notices) {
  if (!body.plate) return;
  const Plate& plate = *body.plate;
  const double radius = radius_of_gyration(body.mass, body.inertia);
  const double reach = std::max(plate.from.norm(), plate.to.norm());
  if (notice_length(at + "/plate", reach, notices) && reach > most_ratio * radius)
    notices.add(at + "/plate", fmt::format("an edge {:.4g} m from the centre of mass", reach),
                in_gyration(radius));
  if (plate.width > most_length)
    notices.add(at + "/plate/width", fmt::format("{:.4g} m", plate.width),
                fmt::format("up to {} m (millimetres are written \"2000 mm\")", most_length));
}

} // namespace

void notice_sizes(const Scene& scene, Notices& notices) {
  if (scene.base.motion != BaseMotion::fixed)
    notice_angle("/base/angle", scene.base.angle, notices);
  for (std::size_t h = 0; h < scene.hinges.size(); ++h) {
    notice_angles(fmt::format("/hinges/{}", h), scene.hinges[h], notices);
    notice_child(scene, h, notices);
    notice_parent(scene, h, notices);
  }
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    notice_plate(fmt::format("/bodies/{}", b), scene.bodies[b], notices);
}

} // namespace wingspread
