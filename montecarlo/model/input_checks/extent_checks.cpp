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
constexpr double most_base_rate = 7;   // rad/s; 67 rpm: spinners turn up to some 60
constexpr double most_push =
    30; // m/s² of a base; launchers reach half of that, and stages deploy no wing
constexpr double most_air = 10;          // kg/m³; the ground has 1.2
constexpr double most_drag = 10;         // a flat plate has 1.2 to 2
constexpr double most_damping = 0.2;     // of critical; bolted panels have 0.01 or less
constexpr double most_dissipation = 100; // s/rad: at 0.01 rad/s damping then equals the spring
constexpr double most_slip = 0.5;        // of the latching rate: friction is then 0.9 of its level

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

void check_latch_numbers(const std::string& at, const Latch& latch, InputWarnings& warnings) {
  if (latch.capture_rate && *latch.capture_rate > most_latch_rate)
    warnings.add(at + "/capture_rate", fmt::format("{:.4g} rad/s", *latch.capture_rate),
                 fmt::format("up to {} rad/s (write degrees as \"30 deg/s\")", most_latch_rate));
  if (latch.dissipation && *latch.dissipation > most_dissipation)
    warnings.add(at + "/dissipation", fmt::format("{:.4g} s/rad", *latch.dissipation),
                 fmt::format("up to {} s/rad: it damps by stiffness · dissipation · deflection",
                             most_dissipation));
}

void check_body_numbers(const std::string& at, const Body& body, InputWarnings& warnings) {
  if (body.plate && body.plate->drag_coefficient > most_drag)
    warnings.add(at + "/plate/drag_coefficient",
                 fmt::format("{:.4g}", body.plate->drag_coefficient), "1.2 to 2 for a flat plate");
  if (body.flexible && body.flexible->damping_ratio > most_damping)
    warnings.add(at + "/flexible/damping_ratio",
                 fmt::format("{:.4g} of critical", body.flexible->damping_ratio),
                 "0.002 to 0.02 for a panel (write 2 % as 0.02)");
}

void check_base_numbers(const Base& base, InputWarnings& warnings) {
  double rate = std::abs(base.rate), push = base.acceleration.norm();
  if (base.table) {
    const double scale = std::abs(base.table_scale);
    for (const double each : base.table->columns().rate)
      rate = std::max(rate, scale * std::abs(each));
    for (const Eigen::Vector2d& each : base.table->columns().acceleration)
      push = std::max(push, scale * each.norm());
  }
  const auto place = [&base](bool by_table, const char* key) {
    return std::string(base.table && by_table ? "/base/table/" : "/base/") + key;
  };
  if (rate > most_base_rate)
    warnings.add(place(rate > std::abs(base.rate), "rate"), fmt::format("{:.4g} rad/s", rate),
                 fmt::format("up to {} rad/s (write degrees as \"3 deg/s\")", most_base_rate));
  if (push > most_push)
    warnings.add(place(push > base.acceleration.norm(), "acceleration"),
                 fmt::format("{:.4g} m/s²", push), fmt::format("up to {} m/s²", most_push));
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
  if (hinge.latch) check_latch_numbers(at + "/latch", *hinge.latch, warnings);
  if (hinge.damper && hinge.damper->law == DamperLaw::eddy_current &&
      hinge.damper->peak_rate > most_latch_rate)
    warnings.add(at + "/damper/peak_rate", fmt::format("{:.4g} rad/s", hinge.damper->peak_rate),
                 fmt::format("up to {} rad/s (write degrees as \"30 deg/s\")", most_latch_rate));
  if (hinge.latch && hinge.far_stop && hinge.far_stop->gap < 0.5 * hinge.latch->backlash)
    warnings.add(
        at + "/stop",
        fmt::format("a gap of {:.4g} rad at the latched side, inside the backlash of ±{:.4g} rad",
                    hinge.far_stop->gap, 0.5 * hinge.latch->backlash),
        "a gap beyond the backlash: the stop bears before the latch does");
  if (hinge.friction.model == FrictionModel::exact &&
      hinge.friction.regularization_rate != Friction{}.regularization_rate)
    warnings.add(at + "/friction/regularization_rate",
                 fmt::format("{:.4g} rad/s, which the exact model does not use",
                             hinge.friction.regularization_rate),
                 "no regularization_rate with the exact model; the regularized one is \"model\": "
                 "\"regularized\"");
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
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    check_body_numbers(fmt::format("/bodies/{}", b), scene.bodies[b], warnings);
  check_base_numbers(scene.base, warnings);
  for (std::size_t k = 0; k < scene.synchronisations.size(); ++k)
    if (scene.synchronisations[k].stiffness == 0)
      warnings.add(fmt::format("/synchronisations/{}/stiffness", k),
                   scene.synchronisations[k].damping == 0
                       ? "0: the loop ties nothing"
                       : "0: the loop slows what its hinges do apart, and brings none back",
                   "the stiffness of the strands");
  if (scene.environment.air_density > most_air)
    warnings.add("/environment/air_density",
                 fmt::format("{:.4g} kg/m³", scene.environment.air_density),
                 "1.2 kg/m³ on the ground, 0 in orbit");
  const auto has_plate = [](const Body& body) { return body.plate.has_value(); };
  if (scene.environment.air_density > 0 && std::ranges::none_of(scene.bodies, has_plate))
    warnings.add(
        "/environment/air_density",
        fmt::format("{:.4g} kg/m³, and no body with a plate", scene.environment.air_density),
        "a `plate` for each body that the air slows down");
}

void check_arrival(const Scene& scene, const Outcome& nominal, InputWarnings& warnings) {
  for (const LatchEvent& event : nominal.latches) {
    const double rate = std::abs(event.rates[event.hinge]);
    const std::string at = fmt::format("/hinges/{}", event.hinge);
    if (rate > most_latch_rate)
      warnings.add(at + "/latch", fmt::format("reached at {:.4g} rad/s by the nominal wing", rate),
                   fmt::format("up to {} rad/s: are torques, masses and lengths in their units? "
                               "(\"2 N*mm\", \"500 g\", \"505 mm\")",
                               most_latch_rate));
    const Hinge& hinge = scene.hinges[event.hinge];
    const Friction& friction = hinge.friction;
    const bool rubs =
        friction.coulomb > 0 || (hinge.spring.table && hinge.spring.table->both_ways());
    if (rubs && friction.model == FrictionModel::regularized &&
        friction.regularization_rate > most_slip * rate)
      warnings.add(at + "/friction/regularization_rate",
                   fmt::format("{0:.4g} rad/s; the nominal wing latches at {1:.4g} rad/s, and "
                               "below {0:.4g} rad/s friction is less than 0.7 of its level",
                               friction.regularization_rate, rate),
                   "a hundredth of the latching rate, or the exact model");
  }
}

} // namespace wingspread
