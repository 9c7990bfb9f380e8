#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/report/text/outcome_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

namespace wingspread {
namespace {

constexpr std::size_t most_phases = 4;

/// "to 60 s by dopri5"; with several phases "to 60 s: dopri5 to 4.82 s, rosenbrock_w to 60 s".
std::string extent(const Outcome& outcome) {
  const std::string end = fmt::format("to {:.6g} s", outcome.t_end);
  if (outcome.phases.size() <= 1) return fmt::format("{} by {}", end, methods_used(outcome));
  std::vector<std::string> parts;
  for (const Phase& phase :
       std::span(outcome.phases).first(std::min(outcome.phases.size(), most_phases)))
    parts.push_back(fmt::format("{} to {:.4g} s", phase.method, phase.to));
  const std::size_t left = outcome.phases.size() - parts.size();
  return fmt::format("{}: {}", end, fmt::join(parts, ", ")) +
         (left == 0 ? "" : " and " + counted(static_cast<long>(left), "more phase", "more phases"));
}

std::string ending(const Scene& scene, const Outcome& outcome) {
  std::string text = fmt::format("{}: {}", scene.name, spaced(to_string(outcome.status)));
  if (!outcome.reason.empty()) text += fmt::format(" ({})", outcome.reason);
  if (outcome.status == Status::invalid) return text + '\n';
  return text + fmt::format(", integrated {}\n", extent(outcome));
}

/// Seven significant digits at the end of a column, after at least one blank: a time of 3e-5 s keeps its digits, and
/// one of a day does not touch its neighbour.
std::string number(double value, std::size_t width) {
  return right_aligned(fmt::format("{:#.7g}", value), width);
}

std::string latches(const Scene& scene, const Outcome& outcome) {
  if (outcome.latches.empty()) return "\nno hinge latched\n";
  std::string text = fmt::format("\n{:<24}{:>14}{:>16}\n", "LATCH", "time, s", "rate, rad/s");
  for (const LatchEvent& latch : outcome.latches)
    text += fmt::format("  {:<22}{}{}\n", scene.hinges[latch.hinge].name, number(latch.time, 14),
                        number(latch.rates[latch.hinge], 16));
  return text;
}

/// Empty without events.
std::string hinge_events(const char* title, const Scene& scene,
                         const std::vector<HingeEvent>& events) {
  if (events.empty()) return "";
  std::string text = fmt::format("\n{:<24}{:>14}{:>16}\n", title, "time, s", "rate, rad/s");
  for (const HingeEvent& event : events)
    text += fmt::format("  {:<22}{}{}\n", scene.hinges[event.hinge].name, number(event.time, 14),
                        number(event.rate, 16));
  return text;
}

std::string peak_columns(const std::vector<Peak>& peaks, std::size_t hinge) {
  if (peaks.empty()) return fmt::format("{:>14}{:>14}", "–", "–");
  return number(peaks[hinge].value, 14) + number(peaks[hinge].time, 14);
}

/// The moments that holds bore; empty if no hinge is held.
std::string holds(const Scene& scene, const Outcome& outcome) {
  if (outcome.hold_moment.empty() || outcome.status == Status::failed) return "";
  std::string text = fmt::format("\n{:<24}{:>14}{:>14}\n", "HOLD", "moment, N·m", "at, s");
  for (std::size_t i = 0; i < scene.hinges.size(); ++i)
    if (scene.hinges[i].release)
      text +=
          fmt::format("  {:<22}{}\n", scene.hinges[i].name, peak_columns(outcome.hold_moment, i));
  return text;
}

/// The energies of motors; empty if no hinge has one.
std::string motors(const Scene& scene, const Outcome& outcome) {
  if (outcome.motor_energy.empty() || outcome.status == Status::failed) return "";
  std::string text = fmt::format("\n{:<24}{:>14}\n", "MOTOR", "energy, J");
  for (std::size_t i = 0; i < scene.hinges.size(); ++i)
    if (scene.hinges[i].motor)
      text +=
          fmt::format("  {:<22}{}\n", scene.hinges[i].name, number(outcome.motor_energy[i], 14));
  return text;
}

std::string peaks(const Scene& scene, const Outcome& outcome) {
  const bool any = !outcome.peak_moment.empty() || !outcome.peak_force.empty();
  if (!any || outcome.status == Status::failed) return "";
  std::string text = fmt::format("\n{:<24}{:>14}{:>14}{:>14}{:>14}\n", "PEAK", "moment, N·m",
                                 "at, s", "force, N", "at, s");
  for (std::size_t i = 0; i < scene.hinges.size(); ++i)
    text += fmt::format("  {:<22}{}{}\n", scene.hinges[i].name,
                        peak_columns(outcome.peak_moment, i), peak_columns(outcome.peak_force, i));
  for (std::size_t b = 0; b < outcome.bending_moment.size(); ++b)
    if (scene.bodies[b].flexible)
      text += fmt::format("  {:<22}{} bending\n", scene.bodies[b].name,
                          peak_columns(outcome.bending_moment, b));
  return text;
}

std::string final_state(const Scene& scene, const Outcome& outcome) {
  const Configuration& final = outcome.final;
  const bool watched = !outcome.overtravel.empty(), known = outcome.status != Status::failed;
  std::string text = fmt::format("\n{:<24}{:>14}{:>16}{}\n", "END", "angle, deg", "rate, rad/s",
                                 watched ? "  beyond stowed, deg" : "");
  for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
    const bool judged = watched && !scene.hinges[i].joint;
    text += fmt::format(
        "  {:<22}{:>14}{:>16.6g}{}\n", scene.hinges[i].name, degrees_text(final.angles[i]),
        final.rates[i],
        judged ? fmt::format("{:>20}", known ? degrees_text(outcome.overtravel[i]) : "–") : "");
  }
  if (scene.base.motion != BaseMotion::fixed)
    text += fmt::format("  {:<22}{:>14}{:>16.6g}\n", "base", degrees_text(final.base_angle),
                        final.base_rate);
  return text;
}

std::string base_peaks(const Outcome& outcome) {
  if (!outcome.base_peaks || outcome.status == Status::failed) return "";
  return fmt::format("\n{:<24}{:>14}{:>16}\n  {:<22}{:>14}{:>16.6g}\n", "LARGEST CHANGE",
                     "angle, deg", "rate, rad/s", "base", degrees_text(outcome.base_peaks->angle),
                     outcome.base_peaks->rate);
}

std::string warnings(const Scene& scene, const Outcome& outcome) {
  std::string text;
  for (const std::string& line : outcome_warnings(scene, outcome))
    text += "  " + wrapped(line, 2) + '\n';
  return text.empty() ? "" : "\nWARNING\n" + text;
}

/// Whether a hinge may take energy from the motion before it latches.
bool dissipates(const Hinge& hinge) {
  const auto& [stiffness, damping] = hinge.joint.value_or(Joint{});
  const auto rubs = [](const std::optional<Stop>& stop) { return stop && stop->dissipation > 0; };
  return hinge.friction.coulomb > 0 || hinge.friction.viscous > 0 || hinge.damper ||
         (hinge.spring.table && hinge.spring.table->both_ways()) || rubs(hinge.stop) ||
         rubs(hinge.far_stop) || hinge.hold || damping > 0; // a hold that lets go takes its strain
}

bool dissipates(const Scene& scene) {
  const bool air = scene.environment.air_density > 0;
  return std::ranges::any_of(scene.hinges, [](const Hinge& hinge) { return dissipates(hinge); }) ||
         std::ranges::any_of(scene.synchronisations,
                             [](const Synchronisation& loop) { return loop.damping > 0; }) ||
         std::ranges::any_of(scene.bodies, [&](const Body& body) {
           return (air && body.plate) || (body.flexible && body.flexible->damping_ratio > 0);
         });
}

/// The cause of the change of energy before the first latch. A scene that conserves energy shows the integrator's
/// error.
std::string energy_cause(const Scene& scene) {
  const bool motors =
      std::ranges::any_of(scene.hinges, [](const Hinge& hinge) { return hinge.motor.has_value(); });
  const bool driven = scene.base.motion == BaseMotion::prescribed;
  if (motors || driven)
    return fmt::format("dissipated or exchanged with the {}", motors && driven
                                                                  ? "motors and the base"
                                                              : motors ? "motors"
                                                                       : "base");
  return dissipates(scene) ? "dissipated" : "of integration error";
}

std::string effort(const Scene& scene, const Outcome& outcome) {
  const auto& [initial, final, drift] = outcome.energy;
  const auto& [steps, rejected, evaluations] = outcome.work;
  // the limit also counts what the work does not: steps repeated to end at a latch or at another event
  const bool limited = outcome.reason.find("max_steps") != std::string::npos;
  return fmt::format(
      "\nEnergy: {:.6g} J at the start, {:.6g} J at the end, {:.6g} J {} before the first latch.\n"
      "Work: {} steps, {} rejected, {} evaluations.\n{}",
      initial, final, drift, energy_cause(scene), steps, rejected, evaluations,
      limited ? "max_steps counts every trial step: these, and steps repeated to end at an event.\n"
              : "");
}

} // namespace

std::string outcome_text(const Scene& scene, const Outcome& outcome) {
  if (outcome.final.angles.empty()) return ending(scene, outcome); // it did not begin
  return ending(scene, outcome) + hinge_events("RELEASE", scene, outcome.releases) +
         latches(scene, outcome) + hinge_events("PASSED, TOO FAST", scene, outcome.missed) +
         hinge_events("LET GO", scene, outcome.let_go) + peaks(scene, outcome) +
         holds(scene, outcome) + motors(scene, outcome) + final_state(scene, outcome) +
         base_peaks(outcome) + warnings(scene, outcome) + effort(scene, outcome);
}

} // namespace wingspread
