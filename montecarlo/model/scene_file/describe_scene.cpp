#include "montecarlo/model/scene_file/describe_scene.hpp"

#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/model/scene_file/base_json.hpp"
#include "montecarlo/model/scene_file/torque_json.hpp"

#include <fmt/format.h>

namespace wingspread {
namespace {

std::string describe_vector(const Eigen::Vector2d& vector) {
  return fmt::format("({}, {})", as_written(vector.x(), ""), as_written(vector.y(), ""));
}

/// ", times 1.2, plus 0.1 N·m"; empty parts for 1 and 0.
std::string describe_change(double scale, double offset = 0) {
  return (scale == 1 ? "" : ", times " + as_written(scale, "")) +
         (offset == 0 ? "" : ", plus " + as_written(offset, "N·m"));
}

/// Constant motions, then ", acceleration and rate by a table of 5 times from 0 to 10 s, linear, times 1.2".
std::string describe_prescribed(const Base& base) {
  const BaseTable* table = base.table.get();
  std::string text;
  if (!table || !table->gives_acceleration())
    text += fmt::format(", acceleration {} m/s²", describe_vector(base.acceleration));
  if (!table || !table->gives_turning())
    text += ", angular acceleration " + as_written(base.angular_acceleration, "rad/s²");
  if (!table) return text;
  const std::string turning = table->gives_rate()      ? "rate"
                              : table->gives_turning() ? "angular acceleration"
                                                       : "";
  const char* both = table->gives_acceleration() && table->gives_turning() ? " and " : "";
  const std::vector<double>& time = table->columns().time;
  return text + fmt::format(", {}{}{} by a table of {} times from {} to {} s, {}{}",
                            table->gives_acceleration() ? "acceleration" : "", both, turning,
                            time.size(), as_written(time.front(), ""), as_written(time.back(), ""),
                            interpolation_names[static_cast<std::size_t>(table->interpolation())],
                            describe_change(base.table_scale));
}

std::string describe_base(const Base& base) {
  std::string text(base_motion_names[static_cast<std::size_t>(base.motion)]);
  if (base.motion == BaseMotion::fixed) return text;
  if (base.motion == BaseMotion::free)
    text += fmt::format(", mass {:.6g} kg, inertia {:.6g} kg·m², position {} m, velocity {} m/s",
                        base.mass, base.inertia, describe_vector(base.position),
                        describe_vector(base.velocity));
  else
    text += describe_prescribed(base);
  text += fmt::format(", angle {} deg", degrees_text(base.angle));
  if (base.motion == BaseMotion::prescribed && base.table && base.table->gives_rate()) return text;
  return text + ", rate " + as_written(base.rate, "rad/s");
}

std::string describe_table(const TorqueTable& table) {
  const std::vector<double>& angle = table.angle();
  return fmt::format("{} at {} angles from {} to {} deg, {}",
                     table.both_ways() ? "measured both ways" : "by a table", angle.size(),
                     degrees_text(angle.front()), degrees_text(angle.back()),
                     interpolation_names[static_cast<std::size_t>(table.interpolation())]);
}

/// Empty for a torque that is 0 along the travel.
std::string describe_torque(const char* name, const HingeTorque& torque) {
  const bool is_line = torque.table == nullptr;
  if (is_line && torque.torque_stowed == 0 && torque.torque_latched == 0 && torque.offset == 0)
    return "";
  const std::string law = is_line ? fmt::format("{} to {}", as_written(torque.torque_stowed, ""),
                                                as_written(torque.torque_latched, "N·m"))
                                  : describe_table(*torque.table);
  return fmt::format("; {} {}{}", name, law, describe_change(torque.scale, torque.offset));
}

/// Describes the hysteresis of a spring tested both ways; friction.scale scales it.
std::string describe_hysteresis(const Hinge& hinge) {
  if (!hinge.spring.table || !hinge.spring.table->both_ways()) return "";
  const double scale = hinge.friction.scale;
  return fmt::format(
      ", its hysteresis as friction{}",
      scale == 1 ? "" : fmt::format(", times {} (friction.scale)", as_written(scale, "")));
}

/// Empty for a hinge without friction.
std::string describe_friction(const Friction& friction) {
  const bool exact = friction.model == FrictionModel::exact;
  const double static_level = friction.static_level.value_or(friction.coulomb);
  if (friction.coulomb == 0 && friction.viscous == 0 && static_level == 0) return "";
  const std::string model =
      exact ? "exact, static " + as_written(static_level, "N·m")
            : "regularized at " + as_written(friction.regularization_rate, "rad/s");
  return fmt::format("; friction {}, {}, {}{}", as_written(friction.coulomb, "N·m"),
                     as_written(friction.viscous, "N·m·s/rad"), model,
                     describe_change(friction.scale));
}

std::string describe_damper_law(const Damper& damper) {
  switch (damper.law) {
  case DamperLaw::viscous:
    break;
  case DamperLaw::power:
    return fmt::format("{}^{}, linear below {}", as_written(damper.coefficient, "N·m·(s/rad)"),
                       as_written(damper.exponent, ""),
                       as_written(damper.regularization_rate, "rad/s"));
  case DamperLaw::eddy_current:
    return fmt::format("of eddy currents, {} at {}", as_written(damper.peak_torque, "N·m"),
                       as_written(damper.peak_rate, "rad/s"));
  }
  return as_written(damper.coefficient, "N·m·s/rad");
}

std::string describe_damper(const std::optional<Damper>& damper) {
  if (!damper) return "";
  const std::string window =
      damper->window ? fmt::format(", between {} and {} deg", degrees_text(damper->window->front()),
                                   degrees_text(damper->window->back()))
                     : "";
  return fmt::format("; damper {}{}{}", describe_damper_law(*damper),
                     describe_change(damper->scale), window);
}

std::string describe_stop(const char* name, const std::optional<Stop>& stop) {
  if (!stop) return "";
  return fmt::format("; {} {:.7g} N·m/rad, {}, gap {} deg", name, stop->stiffness,
                     as_written(stop->dissipation, "s/rad"), degrees_text(stop->gap));
}

/// "; held until 0.2 s after root latches, never released".
std::string describe_release(const Scene& scene, const Hinge& hinge) {
  if (!hinge.release) return "";
  const Release& release = *hinge.release;
  const auto other = [&] { return scene.hinges[release.after].name; };
  const auto event = [&]() -> std::string {
    switch (release.event) {
    case Release::Event::time:
      break;
    case Release::Event::latched:
      return other() + " latches";
    case Release::Event::released:
      return other() + " is released";
    case Release::Event::passed:
      return fmt::format("{} has turned by {} deg", other(), degrees_text(release.angle));
    }
    return as_written(release.time, "s");
  };
  const std::string delay = release.delay == 0 ? "" : as_written(release.delay, "s after ");
  const std::string spring =
      hinge.hold ? fmt::format(" by {}, {}", as_written(hinge.hold->stiffness, "N·m/rad"),
                               as_written(hinge.hold->damping, "N·m·s/rad"))
                 : "";
  return fmt::format("; held{} until {}{}{}", spring, delay, event(),
                     release.fails == 0 ? "" : ", but never released (fails)");
}

/// "; motor at 0.05 rad/s, 40 N·m·s/rad up to 3 N·m".
std::string describe_motor(const std::optional<Motor>& motor) {
  if (!motor) return "";
  const std::string rate =
      motor->table
          ? fmt::format("by a table of {} times from {} to {} s, {}{}", motor->time.size(),
                        as_written(motor->time.front(), ""), as_written(motor->time.back(), ""),
                        interpolation_names[static_cast<std::size_t>(motor->interpolation)],
                        describe_change(motor->scale))
          : "at " + as_written(motor->rate, "rad/s");
  return fmt::format("; motor {}, {} up to {}", rate, as_written(motor->gain, "N·m·s/rad"),
                     as_written(motor->torque_limit, "N·m"));
}

std::string describe_latch(const std::optional<Latch>& latch) {
  if (!latch) return "; no latch";
  const std::string backlash =
      latch->backlash == 0
          ? ""
          : fmt::format(", backlash {} deg in all (±{})", degrees_text(latch->backlash),
                        degrees_text(latch->backlash / 2));
  const std::string damping = latch->dissipation
                                  ? "dissipation " + as_written(*latch->dissipation, "s/rad")
                                  : as_written(latch->damping, "N·m·s/rad");
  const std::string capture = latch->capture_rate ? fmt::format(", engages up to {} deg/s",
                                                                degrees_text(*latch->capture_rate))
                                                  : "";
  const std::string holding = latch->holding_moment
                                  ? fmt::format(", lets go of a load towards stowed from {} on",
                                                as_written(*latch->holding_moment, "N·m"))
                                  : "";
  return fmt::format("; latch {:.7g} N·m/rad, {}{}{}{}", latch->stiffness, damping, backlash,
                     capture, holding);
}

std::string describe_flexible(const Body& body) {
  if (!body.flexible) return "";
  const Flexible& flexible = *body.flexible;
  const std::string given = flexible.frequency ? as_written(*flexible.frequency, "Hz clamped")
                                               : as_written(*flexible.bending_stiffness, "N·m²");
  return fmt::format("; bends, {}, damping ratio {}, as {} segments", given,
                     as_written(flexible.damping_ratio, ""), flexible.joints + 1);
}

std::string describe_hinge(const Scene& scene, const Hinge& hinge) {
  const std::string parent = hinge.parent == base_index ? "base" : scene.bodies[hinge.parent].name;
  if (hinge.joint)
    return fmt::format(
        "{}: {} to {}; elastic joint at {} deg, {:.7g} N·m/rad, {}{}", hinge.name, parent,
        scene.bodies[hinge.child].name, degrees_text(hinge.stowed), hinge.joint->stiffness,
        as_written(hinge.joint->damping, "N·m·s/rad"),
        hinge.initial_rate == 0 ? "" : ", from " + as_written(hinge.initial_rate, "rad/s"));
  std::string text =
      fmt::format("{}: {} to {}, {} to {} deg", hinge.name, parent, scene.bodies[hinge.child].name,
                  degrees_text(hinge.stowed), degrees_text(hinge.latched));
  if (hinge.initial_rate != 0) text += ", from " + as_written(hinge.initial_rate, "rad/s");
  return text + describe_torque("spring", hinge.spring) + describe_hysteresis(hinge) +
         describe_torque("harness", hinge.harness) + describe_friction(hinge.friction) +
         describe_damper(hinge.damper) + describe_stop("stop", hinge.stop) +
         describe_stop("stop beyond the latched angle", hinge.far_stop) +
         describe_latch(hinge.latch) + describe_motor(hinge.motor) + describe_release(scene, hinge);
}

std::string describe_body(const Body& body) {
  std::string text =
      fmt::format("{}: mass {:.6g} kg, inertia {:.6g} kg·m²", body.name, body.mass, body.inertia);
  if (const auto& plate = body.plate)
    text += fmt::format("; plate from {} to {} m, {} wide, drag coefficient {}",
                        describe_vector(plate->from), describe_vector(plate->to),
                        as_written(plate->width, "m"), as_written(plate->drag_coefficient, ""));
  return text + describe_flexible(body);
}

std::string describe_loop(const Scene& scene, const Synchronisation& loop) {
  const std::string ratio = loop.table ? fmt::format("by a table of {} travels", loop.travel.size())
                                       : "ratio " + as_written(loop.ratio, "");
  const std::string preload =
      loop.preload ? ", preload " + as_written(*loop.preload, "N·m") : ", never slack";
  return fmt::format("{}: {} to {}, {}; {}, {}{}", loop.name, scene.hinges[loop.first].name,
                     scene.hinges[loop.second].name, ratio, as_written(loop.stiffness, "N·m/rad"),
                     as_written(loop.damping, "N·m·s/rad"), preload);
}

/// Empty without gravity and air.
std::string describe_environment(const Environment& environment) {
  std::string text;
  if (!environment.gravity.isZero(0))
    text += fmt::format("  gravity: {} m/s²\n", describe_vector(environment.gravity));
  if (environment.air_density != 0)
    text += fmt::format("  air: {}\n", as_written(environment.air_density, "kg/m³"));
  return text;
}

} // namespace

std::string describe(const Scene& scene) {
  std::string text =
      fmt::format("scene {}\n  base: {}\n  {}\n", scene.name, describe_base(scene.base),
                  counted(std::ssize(scene.bodies), "body", "bodies"));
  for (const Body& body : scene.bodies) text += fmt::format("    {}\n", describe_body(body));
  text += fmt::format("  {}\n", counted(std::ssize(scene.hinges), "hinge", "hinges"));
  for (const Hinge& hinge : scene.hinges)
    text += fmt::format("    {}\n", describe_hinge(scene, hinge));
  if (!scene.synchronisations.empty())
    text += fmt::format("  {}\n", counted(std::ssize(scene.synchronisations), "synchronisation",
                                          "synchronisations"));
  for (const Synchronisation& loop : scene.synchronisations)
    text += fmt::format("    {}\n", describe_loop(scene, loop));
  return text + describe_environment(scene.environment);
}

} // namespace wingspread
