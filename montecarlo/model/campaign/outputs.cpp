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

const LatchEvent* latch_of(int hinge, const Outcome& outcome) {
  const auto found = std::ranges::find(outcome.latches, hinge, &LatchEvent::hinge);
  return found == outcome.latches.end() ? nullptr : &*found;
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
    const LatchEvent* latch = latch_of(hinge, outcome);
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

bool has_peaks(const Outputs& outputs) {
  return outputs.contains(OutputFamily::peak_moment) || outputs.contains(OutputFamily::peak_force);
}

bool is_peak(std::string_view output) {
  const std::string quantity = parse_output_name(output).quantity;
  return quantity == "peak_moment" || quantity == "peak_force" || quantity == "peak_bending_moment";
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
  outputs.insert(OutputFamily::base_motion);
  outputs.insert(OutputFamily::frequency);
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
  goal.audit = goal.end_state = false;
  goal.to_t_end = outputs.contains(OutputFamily::base_motion);
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
    if (!order.empty()) order += '>';
    order += scene.hinges[latch.hinge].name;
  }
  return order;
}

} // namespace wingspread
