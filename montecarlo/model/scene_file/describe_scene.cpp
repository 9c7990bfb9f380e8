#include "montecarlo/model/scene_file/describe_scene.hpp"

#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/model/scene_file/base_json.hpp"
#include "montecarlo/model/scene_file/torque_json.hpp"

#include <fmt/format.h>

namespace wingspread {
namespace {

std::string describe_vector(const Eigen::Vector2d& vector) {
  return fmt::format("({}, {})", vector.x(), vector.y());
}

/// ", times 1.2, plus 0.1 N·m"; empty parts for 1 and 0.
std::string describe_change(double scale, double offset = 0) {
  return (scale == 1 ? "" : fmt::format(", times {}", scale)) +
         (offset == 0 ? "" : fmt::format(", plus {} N·m", offset));
}

/// Constant motions, then ", acceleration and rate by a table of 5 times from 0 to 10 s, linear, times 1.2".
std::string describe_prescribed(const Base& base) {
  const BaseTable* table = base.table.get();
  std::string text;
  if (!table || !table->gives_acceleration())
    text += fmt::format(", acceleration {} m/s²", describe_vector(base.acceleration));
  if (!table || !table->gives_turning())
    text += fmt::format(", angular acceleration {} rad/s²", base.angular_acceleration);
  if (!table) return text;
  const std::string turning = table->gives_rate()      ? "rate"
                              : table->gives_turning() ? "angular acceleration"
                                                       : "";
  const char* both = table->gives_acceleration() && table->gives_turning() ? " and " : "";
  const std::vector<double>& time = table->columns().time;
  return text + fmt::format(", {}{}{} by a table of {} times from {} to {} s, {}{}",
                            table->gives_acceleration() ? "acceleration" : "", both, turning,
                            time.size(), time.front(), time.back(),
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
  return text + fmt::format(", rate {} rad/s", base.rate);
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
  const std::string law =
      is_line ? fmt::format("{} to {} N·m", torque.torque_stowed, torque.torque_latched)
              : describe_table(*torque.table);
  return fmt::format("; {} {}{}", name, law, describe_change(torque.scale, torque.offset));
}

/// Of a spring tested both ways, which friction.scale scales.
std::string describe_hysteresis(const Hinge& hinge) {
  if (!hinge.spring.table || !hinge.spring.table->both_ways()) return "";
  const double scale = hinge.friction.scale;
  return fmt::format(", its hysteresis as friction{}",
                     scale == 1 ? "" : fmt::format(", times {} (friction.scale)", scale));
}

/// Empty for a hinge without friction.
std::string describe_friction(const Friction& friction) {
  const bool exact = friction.model == FrictionModel::exact;
  const double static_level = friction.static_level.value_or(friction.coulomb);
  if (friction.coulomb == 0 && friction.viscous == 0 && static_level == 0) return "";
  const std::string model =
      exact ? fmt::format("exact, static {} N·m", static_level)
            : fmt::format("regularized at {} rad/s", friction.regularization_rate);
  return fmt::format("; friction {} N·m, {} N·m·s/rad, {}{}", friction.coulomb, friction.viscous,
                     model, describe_change(friction.scale));
}

std::string describe_damper_law(const Damper& damper) {
  switch (damper.law) {
  case DamperLaw::viscous:
    break;
  case DamperLaw::power:
    return fmt::format("{} N·m·(s/rad)^{}, linear below {} rad/s", damper.coefficient,
                       damper.exponent, damper.regularization_rate);
  case DamperLaw::eddy_current:
    return fmt::format("of eddy currents, {} N·m at {} rad/s", damper.peak_torque,
                       damper.peak_rate);
  }
  return fmt::format("{} N·m·s/rad", damper.coefficient);
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
  return fmt::format("; {} {:.7g} N·m/rad, {} s/rad, gap {} deg", name, stop->stiffness,
                     stop->dissipation, degrees_text(stop->gap));
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
    return fmt::format("{} s", release.time);
  };
  const std::string delay = release.delay == 0 ? "" : fmt::format("{} s after ", release.delay);
  const std::string spring = hinge.hold ? fmt::format(" by {} N·m/rad, {} N·m·s/rad",
                                                      hinge.hold->stiffness, hinge.hold->damping)
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
                        motor->time.front(), motor->time.back(),
                        interpolation_names[static_cast<std::size_t>(motor->interpolation)],
                        describe_change(motor->scale))
          : fmt::format("at {} rad/s", motor->rate);
  return fmt::format("; motor {}, {} N·m·s/rad up to {} N·m", rate, motor->gain,
                     motor->torque_limit);
}

std::string describe_latch(const std::optional<Latch>& latch) {
  if (!latch) return "; no latch";
  const std::string backlash =
      latch->backlash == 0
          ? ""
          : fmt::format(", backlash {} deg in all (±{})", degrees_text(latch->backlash),
                        degrees_text(latch->backlash / 2));
  const std::string damping = latch->dissipation
                                  ? fmt::format("dissipation {} s/rad", *latch->dissipation)
                                  : fmt::format("{} N·m·s/rad", latch->damping);
  const std::string capture = latch->capture_rate ? fmt::format(", engages up to {} deg/s",
                                                                degrees_text(*latch->capture_rate))
                                                  : "";
  const std::string holding =
      latch->holding_moment
          ? fmt::format(", lets go of a load towards stowed from {} N·m on", *latch->holding_moment)
          : "";
  return fmt::format("; latch {:.7g} N·m/rad, {}{}{}{}", latch->stiffness, damping, backlash,
                     capture, holding);
}

std::string describe_flexible(const Body& body) {
  if (!body.flexible) return "";
  const Flexible& flexible = *body.flexible;
  const std::string given = flexible.frequency
                                ? fmt::format("{} Hz clamped", *flexible.frequency)
                                : fmt::format("{} N·m²", *flexible.bending_stiffness);
  return fmt::format("; bends, {}, damping ratio {}, as {} segments", given, flexible.damping_ratio,
                     flexible.joints + 1);
}

std::string describe_hinge(const Scene& scene, const Hinge& hinge) {
  const std::string parent = hinge.parent == base_index ? "base" : scene.bodies[hinge.parent].name;
  if (hinge.joint)
    return fmt::format(
        "{}: {} to {}; elastic joint at {} deg, {:.7g} N·m/rad, {} N·m·s/rad{}", hinge.name, parent,
        scene.bodies[hinge.child].name, degrees_text(hinge.stowed), hinge.joint->stiffness,
        hinge.joint->damping,
        hinge.initial_rate == 0 ? "" : fmt::format(", from {} rad/s", hinge.initial_rate));
  std::string text =
      fmt::format("{}: {} to {}, {} to {} deg", hinge.name, parent, scene.bodies[hinge.child].name,
                  degrees_text(hinge.stowed), degrees_text(hinge.latched));
  if (hinge.initial_rate != 0) text += fmt::format(", from {} rad/s", hinge.initial_rate);
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
    text += fmt::format("; plate from {} to {} m, {} m wide, drag coefficient {}",
                        describe_vector(plate->from), describe_vector(plate->to), plate->width,
                        plate->drag_coefficient);
  return text + describe_flexible(body);
}

std::string describe_loop(const Scene& scene, const Synchronisation& loop) {
  const std::string ratio = loop.table ? fmt::format("by a table of {} travels", loop.travel.size())
                                       : fmt::format("ratio {}", loop.ratio);
  const std::string preload =
      loop.preload ? fmt::format(", preload {} N·m", *loop.preload) : ", never slack";
  return fmt::format("{}: {} to {}, {}; {} N·m/rad, {} N·m·s/rad{}", loop.name,
                     scene.hinges[loop.first].name, scene.hinges[loop.second].name, ratio,
                     loop.stiffness, loop.damping, preload);
}

/// Empty without gravity and air.
std::string describe_environment(const Environment& environment) {
  std::string text;
  if (!environment.gravity.isZero(0))
    text += fmt::format("  gravity: {} m/s²\n", describe_vector(environment.gravity));
  if (environment.air_density != 0)
    text += fmt::format("  air: {} kg/m³\n", environment.air_density);
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
