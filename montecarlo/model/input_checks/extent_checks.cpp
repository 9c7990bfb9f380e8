#include "montecarlo/model/input_checks/extent_checks.hpp"

#include "core/scene/torque.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace wingspread {
namespace {

// Heuristics: a real wing beyond these limits gets a false warning.
constexpr double least_cover = 0.5;    // share of the travel that a table has to cover
constexpr double most_start_rate = 10; // rad/s
constexpr double most_latch_rate = 20; // rad/s; springs bring wings to some rad/s
constexpr double most_gravity = 30;    // m/s²; Jupiter has 25
constexpr double most_sag = 0.5;       // rad, of a latched hinge under spring and harness

struct Extent {
  double from, to;
  [[nodiscard]] double length() const { return std::max(0.0, to - from); }
};

Extent extent_of(double a, double b) { return {std::min(a, b), std::max(a, b)}; }

Extent common(const Extent& a, const Extent& b) {
  return {std::max(a.from, b.from), std::min(a.to, b.to)};
}

std::string text_of(const Extent& extent) {
  return fmt::format("{:.4g} to {:.4g} rad", extent.from, extent.to);
}

void check_table(const std::string& at, const HingeTorque& torque, const Extent& travel,
                 InputWarnings& warnings) {
  if (!torque.table) return;
  const std::vector<double>& angle = torque.table->angle();
  const Extent table = extent_of(angle.front(), angle.back());
  const double cover = common(table, travel).length() / travel.length();
  if (cover >= least_cover) return;
  warnings.add(
      at + (torque.table->both_ways() ? "/measured/angle" : "/table/angle"),
      fmt::format("{}, {:.0f} % of the travel, {}", text_of(table), 100 * cover, text_of(travel)),
      "angles over the whole travel: beyond a table its end value holds");
}

void check_hinge(const std::string& at, const Hinge& hinge, InputWarnings& warnings) {
  const Extent travel = extent_of(hinge.stowed, hinge.latched);
  check_table(at + "/spring", hinge.spring, travel, warnings);
  check_table(at + "/harness", hinge.harness, travel, warnings);
  if (hinge.damper && hinge.damper->window) {
    const Extent window = extent_of((*hinge.damper->window)[0], (*hinge.damper->window)[1]);
    if (!(common(window, travel).length() > 0))
      warnings.add(at + "/damper/window",
                   fmt::format("{}, beside the travel, {}", text_of(window), text_of(travel)),
                   "hinge angles on the travel");
  }
  if (hinge.latch && hinge.latch->stiffness > 0) {
    const double load =
        std::abs(torque_at(hinge.spring, hinge, 1) - torque_at(hinge.harness, hinge, 1));
    if (load > most_sag * hinge.latch->stiffness)
      warnings.add(
          at + "/latch/stiffness",
          fmt::format("{:.4g} N·m/rad: a load of {:.4g} N·m turns the latched hinge by {:.4g} rad",
                      hinge.latch->stiffness, load, load / hinge.latch->stiffness),
          "a latch that holds its hinge at the latched angle (\"1000 N*m/deg\")");
  }
  if (std::abs(hinge.initial_rate) > most_start_rate)
    warnings.add(at + "/initial_rate", fmt::format("{:.4g} rad/s", hinge.initial_rate),
                 fmt::format("up to {} rad/s (write degrees as \"30 deg/s\")", most_start_rate));
}

} // namespace

void check_extents(const Scene& scene, InputWarnings& warnings) {
  for (std::size_t h = 0; h < scene.hinges.size(); ++h)
    if (!scene.hinges[h].joint)
      check_hinge(fmt::format("/hinges/{}", h), scene.hinges[h], warnings);
  if (const double gravity = scene.environment.gravity.norm(); gravity > most_gravity)
    warnings.add("/environment/gravity", fmt::format("{:.4g} m/s²", gravity),
                 "9.81 m/s² on the ground, 0 in orbit");
  const auto has_plate = [](const Body& body) { return body.plate.has_value(); };
  if (scene.environment.air_density > 0 && std::ranges::none_of(scene.bodies, has_plate))
    warnings.add(
        "/environment/air_density",
        fmt::format("{:.4g} kg/m³, and no body with a plate", scene.environment.air_density),
        "a `plate` for each body that the air slows down");
}

void check_arrival(const Outcome& nominal, InputWarnings& warnings) {
  for (const LatchEvent& event : nominal.latches) {
    const double rate = std::abs(event.rates[event.hinge]);
    if (rate > most_latch_rate)
      warnings.add(fmt::format("/hinges/{}/latch", event.hinge),
                   fmt::format("reached at {:.4g} rad/s by the nominal wing", rate),
                   fmt::format("up to {} rad/s: are torques, masses and lengths in their units? "
                               "(\"2 N*mm\", \"500 g\", \"505 mm\")",
                               most_latch_rate));
  }
}

} // namespace wingspread
