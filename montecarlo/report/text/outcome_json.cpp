#include "core/proofs/natural_modes.hpp"
#include "montecarlo/engine/runs/finality.hpp"
#include "montecarlo/model/input_checks/requirement_checks.hpp"
#include "montecarlo/report/text/outcome_report.hpp"
#include "montecarlo/results/summary/latch_jump.hpp"
#include "montecarlo/results/summary/overtravel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wingspread {
namespace {

bool has_run(const Outcome& outcome) {
  return outcome.status != Status::invalid && outcome.status != Status::failed;
}

Json vector(const Eigen::Vector2d& v) {
  return Json::array({json_number(v.x()), json_number(v.y())});
}

/// A number per hinge, by name.
Json by_hinge(const Scene& scene, const std::vector<double>& values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i)
    json[scene.hinges[i].name] = json_number(values[i]);
  return json;
}

/// The same of the hinges that travel: not of elastic joints.
Json by_travelling_hinge(const Scene& scene, const std::vector<double>& values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!scene.hinges[i].joint) json[scene.hinges[i].name] = json_number(values[i]);
  return json;
}

Json phases_json(const std::vector<Phase>& phases) {
  Json json = Json::array();
  for (const Phase& phase : phases)
    json.push_back({{"method", phase.method},
                    {"from", json_number(phase.from)},
                    {"to", json_number(phase.to)},
                    {"steps", phase.steps}});
  return json;
}

Json latches_json(const Scene& scene, const Outcome& outcome) {
  Json json = Json::array();
  for (const LatchEvent& latch : outcome.latches)
    json.push_back({{"hinge", scene.hinges[latch.hinge].name},
                    {"time", json_number(latch.time)},
                    {"rate", json_number(latch.rates[latch.hinge])},
                    {"rates", by_hinge(scene, latch.rates)}});
  return json;
}

Json events_json(const Scene& scene, const std::vector<HingeEvent>& events) {
  Json json = Json::array();
  for (const HingeEvent& event : events)
    json.push_back({{"hinge", scene.hinges[event.hinge].name},
                    {"time", json_number(event.time)},
                    {"rate", json_number(event.rate)}});
  return json;
}

/// Hold moments of the hinges that have a release.
Json holds_json(const Scene& scene, const Outcome& outcome) {
  if (outcome.hold_moment.empty() || outcome.status == Status::failed) return nullptr;
  Json json = Json::object();
  for (std::size_t i = 0; i < outcome.hold_moment.size(); ++i)
    if (scene.hinges[i].release)
      json[scene.hinges[i].name] = {{"value", json_number(outcome.hold_moment[i].value)},
                                    {"time", json_number(outcome.hold_moment[i].time)}};
  return json;
}

Json peaks_json(const Scene& scene, const std::vector<Peak>& peaks, Status status) {
  if (peaks.empty() || status == Status::failed) return nullptr;
  Json json = Json::object();
  for (std::size_t i = 0; i < peaks.size(); ++i)
    json[scene.hinges[i].name] = {{"value", json_number(peaks[i].value)},
                                  {"time", json_number(peaks[i].time)}};
  return json;
}

/// Bending moments, by flexible body.
Json bending_json(const Scene& scene, const Outcome& outcome) {
  if (outcome.bending_moment.empty() || outcome.status == Status::failed) return nullptr;
  Json json = Json::object();
  for (std::size_t b = 0; b < outcome.bending_moment.size(); ++b)
    if (scene.bodies[b].flexible)
      json[scene.bodies[b].name] = {{"value", json_number(outcome.bending_moment[b].value)},
                                    {"time", json_number(outcome.bending_moment[b].time)}};
  return json;
}

/// Energies of the motors, by hinge.
Json motors_json(const Scene& scene, const Outcome& outcome) {
  if (outcome.motor_energy.empty() || outcome.status == Status::failed) return nullptr;
  Json json = Json::object();
  for (std::size_t i = 0; i < outcome.motor_energy.size(); ++i)
    if (scene.hinges[i].motor) json[scene.hinges[i].name] = json_number(outcome.motor_energy[i]);
  return json;
}

Json overtravel_json(const Scene& scene, const Outcome& outcome) {
  if (outcome.overtravel.empty() || outcome.status == Status::failed) return nullptr;
  return by_travelling_hinge(scene, outcome.overtravel);
}

/// Whether the peaks are final; null without peaks.
Json peaks_final_json(const Outcome& outcome) {
  const bool none = outcome.peak_moment.empty() && outcome.peak_force.empty();
  return none || outcome.status == Status::failed ? Json(nullptr) : Json(outcome.peaks_final);
}

/// The way of a base of prescribed motion is not integrated: its position and velocity are null.
Json final_json(const Scene& scene, const Configuration& final) {
  const bool known = scene.base.motion != BaseMotion::prescribed;
  return {{"angles", by_hinge(scene, final.angles)},
          {"rates", by_hinge(scene, final.rates)},
          {"base",
           {{"position", known ? vector(final.base_position) : Json(nullptr)},
            {"angle", json_number(final.base_angle)},
            {"velocity", known ? vector(final.base_velocity) : Json(nullptr)},
            {"rate", json_number(final.base_rate)}}}};
}

/// The largest changes of a free base's angle and rate.
Json base_peaks_json(const Outcome& outcome) {
  if (!outcome.base_peaks || outcome.status == Status::failed) return nullptr;
  return {{"peak_angle", json_number(outcome.base_peaks->angle)},
          {"peak_rate", json_number(outcome.base_peaks->rate)}};
}

Json energy_json(const EnergyAudit& energy) {
  return {{"initial", json_number(energy.initial)},
          {"final", json_number(energy.final)},
          {"drift_before_first_latch", json_number(energy.drift_before_first_latch)}};
}

} // namespace

namespace {

/// Adds the keys that only scenes with holds, motors, or latches that may miss have.
void add_sequence(const Scene& scene, const Outcome& outcome, Json& json) {
  const auto is_held = [](const Hinge& hinge) { return hinge.release.has_value(); };
  const auto may_miss = [](const Hinge& hinge) { return hinge.latch && hinge.latch->can_miss(); };
  if (std::ranges::any_of(scene.hinges, is_held)) {
    json["releases"] = events_json(scene, outcome.releases);
    json["hold_moment"] = holds_json(scene, outcome);
  }
  if (std::ranges::any_of(scene.hinges, [](const Hinge& h) { return h.motor.has_value(); }))
    json["motor_energy"] = motors_json(scene, outcome);
  if (std::ranges::any_of(scene.hinges, may_miss)) {
    json["missed"] = events_json(scene, outcome.missed);
    json["let_go"] = events_json(scene, outcome.let_go);
    json["latches_final"] = outcome.latches_final;
  }
}

} // namespace

bool has_cut_peaks(const Outcome& outcome) {
  const bool ran = has_run(outcome);
  const bool peaks = !outcome.peak_moment.empty() || !outcome.peak_force.empty();
  return ran && peaks && !outcome.peaks_final;
}

std::string cut_peaks_warning(const Outcome& outcome) {
  return fmt::format("t_end cut the peak{}: it is not proven that none would be exceeded after it",
                     outcome.moments_final  ? " forces"
                     : outcome.forces_final ? " moments"
                                            : "s");
}

std::vector<std::string> outcome_warnings(const Scene& scene, const Outcome& outcome) {
  std::vector<std::string> lines;
  for (const Overtravel& overtravel : overtravels(scene, outcome))
    lines.push_back(warning(overtravel));
  if (const auto jumps = latch_jumps(scene, outcome); !jumps.empty())
    lines.push_back(warning(jumps));
  if (const auto forces = forces_of_jumps(scene, outcome); !forces.empty())
    lines.push_back(warning_of_forces(forces));
  if (has_cut_peaks(outcome)) lines.push_back(cut_peaks_warning(outcome));
  if (!outcome.latches_final)
    lines.push_back("it is not proven that every latch with a holding_moment stays engaged after "
                    "t_end. " +
                    advice_on_t_end(why_never_final(scene)));
  if (outcome.status == Status::failed && outcome.reason.find("max_steps") != std::string::npos)
    if (const auto frequencies = natural_frequencies(scene); !frequencies.empty())
      lines.push_back(fmt::format(
          "steps follow the fastest vibration, {:.4g} Hz with all latches engaged (`wingspread "
          "modes` shows it): a softer latch, fewer joints of flexible bodies or an earlier t_end "
          "take fewer steps, or raise max_steps",
          frequencies.back()));
  return lines;
}

Json outcome_json(const Scene& scene, const Outcome& outcome) {
  const bool ran = outcome.status != Status::invalid;
  const auto if_ran = [ran](const Json& json) { return ran ? json : Json(nullptr); };
  Json json{{"status", to_string(outcome.status)},
            {"reason", outcome.reason.empty() ? Json(nullptr) : Json(outcome.reason)},
            {"method", if_ran(methods_used(outcome))},
            {"phases", if_ran(phases_json(outcome.phases))},
            {"t_end", if_ran(json_number(outcome.t_end))},
            {"latches", latches_json(scene, outcome)},
            {"peak_moment", peaks_json(scene, outcome.peak_moment, outcome.status)},
            {"peak_force", peaks_json(scene, outcome.peak_force, outcome.status)},
            {"peaks_final", peaks_final_json(outcome)},
            {"overtravel", overtravel_json(scene, outcome)},
            {"final_angle", has_run(outcome) && !outcome.final_angle.empty()
                                ? by_travelling_hinge(scene, outcome.final_angle)
                                : Json(nullptr)},
            {"warnings", outcome_warnings(scene, outcome)},
            {"final", if_ran(final_json(scene, outcome.final))},
            {"energy", if_ran(energy_json(outcome.energy))},
            {"work",
             {{"steps", outcome.work.steps},
              {"rejected", outcome.work.rejected},
              {"rhs_evaluations", outcome.work.rhs_evaluations}}}};
  if (std::ranges::any_of(scene.bodies, [](const Body& body) { return body.flexible.has_value(); }))
    json["peak_bending_moment"] = bending_json(scene, outcome);
  if (scene.base.motion == BaseMotion::free) json["base_motion"] = base_peaks_json(outcome);
  add_sequence(scene, outcome, json);
  return json;
}

} // namespace wingspread
