#include "montecarlo/model/campaign/outputs.hpp"

#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace wingspread {
namespace {

using Quantity = OutputColumn::Quantity;

bool can_miss(const Hinge& hinge) { return hinge.latch && hinge.latch->can_miss(); }

void add_rates_at(const Scene& scene, int hinge, std::vector<OutputColumn>& columns) {
  for (int other = 0; other < std::ssize(scene.hinges); ++other)
    if (other != hinge && scene.hinges[other].latch)
      columns.push_back({scene.hinges[hinge].name + ".rate_at." + scene.hinges[other].name,
                         Quantity::rate_at, hinge, other});
}

/// How many hinges and joints of flexible bodies move.
int freedoms(const Scene& scene) {
  auto count = static_cast<int>(scene.hinges.size());
  for (const Body& body : scene.bodies) count += body.flexible ? body.flexible->joints : 0;
  return count;
}

bool has_run(const Outcome& outcome) {
  return outcome.status != Status::invalid && outcome.status != Status::failed;
}

double captures_of(int hinge, const Outcome& outcome) {
  const auto count = std::ranges::count(outcome.latches, hinge, &LatchEvent::hinge);
  return has_run(outcome) ? static_cast<double>(count) : undefined;
}

double held_of(int hinge, const Outcome& outcome) {
  if (!has_run(outcome)) return undefined;
  return holding_latch(outcome, hinge) != nullptr ? 1 : 0;
}

double final_angle_of(int hinge, const Outcome& outcome) {
  return has_run(outcome) && !outcome.final_angle.empty() ? outcome.final_angle[hinge] : undefined;
}

double motor_energy_of(int hinge, const Outcome& outcome) {
  return has_run(outcome) && !outcome.motor_energy.empty() ? outcome.motor_energy[hinge]
                                                           : undefined;
}

double peak_of(int hinge, const std::vector<Peak>& peaks, Status status) {
  return peaks.empty() || status == Status::failed ? undefined : peaks[hinge].value;
}

double overtravel_of(int hinge, const Outcome& outcome) {
  const bool known = !outcome.overtravel.empty() && outcome.status != Status::failed;
  return known ? outcome.overtravel[hinge] : undefined;
}

double of_base(const Outcome& outcome, double BasePeaks::*quantity) {
  const bool known = outcome.base_peaks && outcome.status != Status::failed;
  return known ? (*outcome.base_peaks).*quantity : undefined;
}

double number_of(const OutputColumn& column, const Outcome& outcome) {
  const auto at_latch = [&](int hinge, auto value) {
    const LatchEvent* latch = holding_latch(outcome, hinge);
    return latch ? value(*latch) : undefined;
  };
  const auto rate = [&](const LatchEvent& latch) { return latch.rates[column.hinge]; };
  switch (column.quantity) {
  case Quantity::latch_time:
    return at_latch(column.hinge, [](const LatchEvent& latch) { return latch.time; });
  case Quantity::latch_rate:
    return at_latch(column.hinge, rate);
  case Quantity::rate_at:
    return at_latch(column.other, rate);
  case Quantity::peak_moment:
    return peak_of(column.hinge, outcome.peak_moment, outcome.status);
  case Quantity::peak_force:
    return peak_of(column.hinge, outcome.peak_force, outcome.status);
  case Quantity::overtravel:
    return overtravel_of(column.hinge, outcome);
  case Quantity::base_peak_angle:
    return of_base(outcome, &BasePeaks::angle);
  case Quantity::base_peak_rate:
    return of_base(outcome, &BasePeaks::rate);
  case Quantity::bending_moment:
    return peak_of(column.hinge, outcome.bending_moment, outcome.status);
  case Quantity::frequency:
    return column.hinge < std::ssize(outcome.mode_frequencies)
               ? outcome.mode_frequencies[column.hinge]
               : undefined;
  case Quantity::deployment_time:
    return outcome.status == Status::deployed ? outcome.latches.back().time : undefined;
  case Quantity::hold_moment:
    return peak_of(column.hinge, outcome.hold_moment, outcome.status);
  case Quantity::captures:
    return captures_of(column.hinge, outcome);
  case Quantity::held:
    return held_of(column.hinge, outcome);
  case Quantity::final_angle:
    return final_angle_of(column.hinge, outcome);
  case Quantity::motor_energy:
    return motor_energy_of(column.hinge, outcome);
  }
  return undefined;
}

} // namespace

std::optional<Status> status_named(std::string_view name) {
  const auto found =
      std::ranges::find_if(statuses, [&](Status status) { return to_string(status) == name; });
  return found == statuses.end() ? std::nullopt : std::optional(*found);
}

Outputs default_outputs() {
  return {OutputFamily::latch_time, OutputFamily::latch_rate, OutputFamily::peak_moment,
          OutputFamily::peak_force, OutputFamily::overtravel};
}

Outputs default_outputs(const Scene& scene) {
  Outputs outputs = default_outputs();
  if (std::ranges::any_of(scene.hinges, [](const Hinge& h) { return h.release.has_value(); }))
    outputs.insert(OutputFamily::hold_moment);
  if (std::ranges::any_of(scene.hinges, [](const Hinge& h) { return h.motor.has_value(); }))
    outputs.insert(OutputFamily::motor_energy);
  if (std::ranges::any_of(scene.hinges, can_miss))
    outputs.insert({OutputFamily::captures, OutputFamily::held});
  return outputs;
}

bool has_peaks(const Outputs& outputs) {
  return outputs.contains(OutputFamily::peak_moment) || outputs.contains(OutputFamily::peak_force);
}

bool is_peak(std::string_view output) { return peak_kind(output) != PeakKind::none; }

PeakKind peak_kind(std::string_view output) {
  const std::string quantity = parse_output_name(output).quantity;
  if (quantity == "peak_force") return PeakKind::force;
  const bool moment = quantity == "peak_moment" || quantity == "peak_bending_moment";
  return moment ? PeakKind::moment : PeakKind::none;
}

void match_peaks_final(Outputs& outputs) {
  if (has_peaks(outputs))
    outputs.insert(OutputFamily::peaks_final);
  else
    outputs.erase(OutputFamily::peaks_final);
}

Outputs all_outputs() {
  Outputs outputs = default_outputs();
  outputs.insert(OutputFamily::rate_at);
  outputs.insert({OutputFamily::base_motion, OutputFamily::frequency, OutputFamily::hold_moment,
                  OutputFamily::captures, OutputFamily::held, OutputFamily::final_angle,
                  OutputFamily::motor_energy});
  return outputs;
}

void read_outputs(const JsonCursor& at, Outputs& outputs) {
  if (!at.value().is_array()) return void(at.refuse("an array of output families"));
  outputs.clear();
  for (const JsonCursor& element : at.elements()) {
    const auto index = element.choice(output_family_names);
    if (index && !outputs.insert(static_cast<OutputFamily>(*index)).second)
      element.refuse_repeated("each family once");
  }
}

Json write_outputs(const Outputs& outputs) {
  Json json = Json::array();
  for (const OutputFamily family : outputs)
    json.push_back(output_family_names[static_cast<std::size_t>(family)]);
  return json;
}

std::vector<OutputColumn> output_columns(const Scene& scene, const Outputs& outputs) {
  std::vector<OutputColumn> columns;
  for (int i = 0; i < std::ssize(scene.hinges); ++i) {
    const Hinge& hinge = scene.hinges[i];
    const auto add = [&](OutputFamily family, const char* name, Quantity quantity) {
      if (outputs.contains(family)) columns.push_back({hinge.name + '.' + name, quantity, i, -1});
    };
    if (hinge.latch) {
      add(OutputFamily::latch_time, "latch_time", Quantity::latch_time);
      add(OutputFamily::latch_rate, "latch_rate", Quantity::latch_rate);
    }
    add(OutputFamily::peak_moment, "peak_moment", Quantity::peak_moment);
    add(OutputFamily::peak_force, "peak_force", Quantity::peak_force);
    if (hinge.joint) continue;
    add(OutputFamily::overtravel, "overtravel", Quantity::overtravel);
    if (hinge.release) add(OutputFamily::hold_moment, "hold_moment", Quantity::hold_moment);
    if (can_miss(hinge)) {
      add(OutputFamily::captures, "captures", Quantity::captures);
      add(OutputFamily::held, "held", Quantity::held);
    }
    if (hinge.motor) add(OutputFamily::motor_energy, "motor_energy", Quantity::motor_energy);
    add(OutputFamily::final_angle, "final_angle", Quantity::final_angle);
    if (outputs.contains(OutputFamily::rate_at)) add_rates_at(scene, i, columns);
  }
  for (int b = 0; b < std::ssize(scene.bodies); ++b)
    if (scene.bodies[b].flexible && outputs.contains(OutputFamily::peak_moment))
      columns.push_back(
          {scene.bodies[b].name + ".peak_bending_moment", Quantity::bending_moment, b, -1});
  if (outputs.contains(OutputFamily::base_motion) && scene.base.motion == BaseMotion::free) {
    columns.push_back({"base.peak_angle", Quantity::base_peak_angle, -1, -1});
    columns.push_back({"base.peak_rate", Quantity::base_peak_rate, -1, -1});
  }
  const int modes = std::min(freedoms(scene), most_mode_outputs);
  for (int k = 0; k < modes && outputs.contains(OutputFamily::frequency); ++k)
    columns.push_back({fmt::format("mode_{}.frequency", k + 1), Quantity::frequency, k, -1});
  columns.push_back({"deployment_time", Quantity::deployment_time, -1, -1});
  return columns;
}

Goal goal_of(const Outputs& outputs) {
  Goal goal;
  goal.peak_moment = outputs.contains(OutputFamily::peak_moment);
  goal.peak_force = outputs.contains(OutputFamily::peak_force);
  goal.overtravel = outputs.contains(OutputFamily::overtravel);
  goal.hold_moment = outputs.contains(OutputFamily::hold_moment);
  goal.motor_energy = outputs.contains(OutputFamily::motor_energy);
  goal.final_angle = goal.to_rest = outputs.contains(OutputFamily::final_angle);
  goal.audit = goal.end_state = false;
  goal.base_motion = outputs.contains(OutputFamily::base_motion);
  goal.mode_frequencies = outputs.contains(OutputFamily::frequency);
  return goal;
}

double finite_or_none(double value) { return std::isfinite(value) ? value : undefined; }

double output_of(const OutputColumn& column, const Outcome& outcome) {
  return finite_or_none(number_of(column, outcome));
}

std::string latch_order(const Scene& scene, const Outcome& outcome) {
  std::string order;
  for (const LatchEvent& latch : outcome.latches) {
    if (&latch != holding_latch(outcome, latch.hinge)) continue;
    if (!order.empty()) order += '>';
    order += scene.hinges[latch.hinge].name;
  }
  return order;
}

} // namespace wingspread
