#include "montecarlo/outcome_json.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace wingspread {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json vector(const Eigen::Vector2d& v) { return Json::array({number(v.x()), number(v.y())}); }

/// A number for each hinge, by name.
Json by_hinge(const Scene& scene, const std::vector<double>& values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i) json[scene.hinges[i].name] = number(values[i]);
  return json;
}

Json phases_json(const std::vector<Phase>& phases) {
  Json json = Json::array();
  for (const Phase& phase : phases)
    json.push_back({{"method", phase.method},
                    {"from", number(phase.from)},
                    {"to", number(phase.to)},
                    {"steps", phase.steps}});
  return json;
}

Json latches_json(const Scene& scene, const Outcome& outcome) {
  Json json = Json::array();
  for (const LatchEvent& latch : outcome.latches)
    json.push_back({{"hinge", scene.hinges[latch.hinge].name},
                    {"time", number(latch.time)},
                    {"rate", number(latch.rates[latch.hinge])},
                    {"rates", by_hinge(scene, latch.rates)}});
  return json;
}

Json peaks_json(const Scene& scene, const std::vector<Peak>& peaks, Status status) {
  if (peaks.empty() || status == Status::failed) return nullptr;
  Json json = Json::object();
  for (std::size_t i = 0; i < peaks.size(); ++i)
    json[scene.hinges[i].name] = {{"value", number(peaks[i].value)},
                                  {"time", number(peaks[i].time)}};
  return json;
}

Json final_json(const Scene& scene, const Configuration& final) {
  return {{"angles", by_hinge(scene, final.angles)},
          {"rates", by_hinge(scene, final.rates)},
          {"base",
           {{"position", vector(final.base_position)},
            {"angle", number(final.base_angle)},
            {"velocity", vector(final.base_velocity)},
            {"rate", number(final.base_rate)}}}};
}

Json energy_json(const EnergyAudit& energy) {
  return {{"initial", number(energy.initial)},
          {"final", number(energy.final)},
          {"drift_before_first_latch", number(energy.drift_before_first_latch)}};
}

} // namespace

Json outcome_json(const Scene& scene, const Outcome& outcome) {
  const bool ran = outcome.status != Status::invalid;
  const auto if_ran = [ran](const Json& json) { return ran ? json : Json(nullptr); };
  return {{"status", to_string(outcome.status)},
          {"reason", outcome.reason.empty() ? Json(nullptr) : Json(outcome.reason)},
          {"method", if_ran(methods_used(outcome))},
          {"phases", if_ran(phases_json(outcome.phases))},
          {"t_end", if_ran(number(outcome.t_end))},
          {"latches", latches_json(scene, outcome)},
          {"peak_moment", peaks_json(scene, outcome.peak_moment, outcome.status)},
          {"peak_force", peaks_json(scene, outcome.peak_force, outcome.status)},
          {"final", if_ran(final_json(scene, outcome.final))},
          {"energy", if_ran(energy_json(outcome.energy))},
          {"work",
           {{"steps", outcome.work.steps},
            {"rejected", outcome.work.rejected},
            {"rhs_evaluations", outcome.work.rhs_evaluations}}}};
}

} // namespace wingspread
