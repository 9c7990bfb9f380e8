#include "montecarlo/model/campaign/outputs.hpp"

#include "montecarlo/foundation/statistics/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace wingspread {
namespace {

using Quantity = OutputQuantity;

static_assert(std::ranges::all_of(output_families, [](const OutputFamilyInfo& each) {
  return &about(each.family) == &each;
}));

bool is_turnable(const Hinge& hinge) { return !hinge.joint; }
bool has_latch(const Hinge& hinge) { return hinge.latch.has_value(); }
bool has_release(const Hinge& hinge) { return hinge.release && is_turnable(hinge); }
bool has_motor(const Hinge& hinge) { return hinge.motor && is_turnable(hinge); }
bool may_miss(const Hinge& hinge) { return hinge.latch && hinge.latch->can_miss(); }
bool is_any(const Hinge&) { return true; }

/// How many hinges and joints of flexible bodies move.
int freedoms(const Scene& scene) {
  auto count = static_cast<int>(scene.hinges.size());
  for (const Body& body : scene.bodies) count += body.flexible ? body.flexible->joints : 0;
  return count;
}

bool has_run(const Outcome& outcome) {
  return outcome.status != Status::invalid && outcome.status != Status::failed;
}

bool has_not_failed(const Outcome& outcome) { return outcome.status != Status::failed; }

double captures(const OutputColumn& of, const Outcome& outcome) {
  const auto count = std::ranges::count(outcome.latches, of.hinge, &LatchEvent::hinge);
  return has_run(outcome) ? static_cast<double>(count) : undefined;
}

double held(const OutputColumn& of, const Outcome& outcome) {
  if (!has_run(outcome)) return undefined;
  return holding_latch(outcome, of.hinge) != nullptr ? 1 : 0;
}

double latch_time(const OutputColumn& of, const Outcome& outcome) {
  const LatchEvent* latch = holding_latch(outcome, of.hinge);
  return latch ? latch->time : undefined;
}

double latch_rate(const OutputColumn& of, const Outcome& outcome) {
  const LatchEvent* latch = holding_latch(outcome, of.hinge);
  return latch ? latch->rates[of.hinge] : undefined;
}

double rate_at(const OutputColumn& of, const Outcome& outcome) {
  const LatchEvent* latch = holding_latch(outcome, of.other);
  return latch ? latch->rates[of.hinge] : undefined;
}

template <std::vector<Peak> Outcome::*peaks>
double peak(const OutputColumn& of, const Outcome& outcome) {
  const bool known = !(outcome.*peaks).empty() && has_not_failed(outcome);
  return known ? (outcome.*peaks)[of.hinge].value : undefined;
}

template <std::vector<double> Outcome::*numbers>
double number_at_end(const OutputColumn& of, const Outcome& outcome) {
  const bool known = !(outcome.*numbers).empty() && has_run(outcome);
  return known ? (outcome.*numbers)[of.hinge] : undefined;
}

template <double BasePeaks::*quantity>
double base_peak(const OutputColumn&, const Outcome& outcome) {
  const bool known = outcome.base_peaks && has_not_failed(outcome);
  return known ? (*outcome.base_peaks).*quantity : undefined;
}

double frequency(const OutputColumn& of, const Outcome& outcome) {
  const bool known = of.hinge < std::ssize(outcome.mode_frequencies);
  return known ? outcome.mode_frequencies[of.hinge] : undefined;
}

double deployment_time(const OutputColumn&, const Outcome& outcome) {
  return outcome.status == Status::deployed ? outcome.latches.back().time : undefined;
}

/// Where a quantity comes from.
struct Source {
  Quantity quantity;
  std::optional<OutputFamily> family; ///< none: always there
  bool (*has)(const Hinge&);          ///< whether a hinge has it; null: not of one hinge
  double (*value)(const OutputColumn&, const Outcome&);
};

/// In the order of OutputQuantity, which is that of a hinge's columns.
constexpr std::array sources{
    Source{Quantity::latch_time, OutputFamily::latch_time, has_latch, latch_time},
    Source{Quantity::latch_rate, OutputFamily::latch_rate, has_latch, latch_rate},
    Source{Quantity::peak_moment, OutputFamily::peak_moment, is_any, peak<&Outcome::peak_moment>},
    Source{Quantity::peak_force, OutputFamily::peak_force, is_any, peak<&Outcome::peak_force>},
    Source{Quantity::overtravel, OutputFamily::overtravel, is_turnable,
           number_at_end<&Outcome::overtravel>},
    Source{Quantity::hold_moment, OutputFamily::hold_moment, has_release,
           peak<&Outcome::hold_moment>},
    Source{Quantity::captures, OutputFamily::captures, may_miss, captures},
    Source{Quantity::held, OutputFamily::held, may_miss, held},
    Source{Quantity::motor_energy, OutputFamily::motor_energy, has_motor,
           number_at_end<&Outcome::motor_energy>},
    Source{Quantity::final_angle, OutputFamily::final_angle, is_turnable,
           number_at_end<&Outcome::final_angle>},
    Source{Quantity::rate_at, OutputFamily::rate_at, nullptr, rate_at},
    Source{Quantity::peak_bending_moment, OutputFamily::peak_moment, nullptr,
           peak<&Outcome::bending_moment>},
    Source{Quantity::base_peak_angle, OutputFamily::base_motion, nullptr,
           base_peak<&BasePeaks::angle>},
    Source{Quantity::base_peak_rate, OutputFamily::base_motion, nullptr,
           base_peak<&BasePeaks::rate>},
    Source{Quantity::frequency, OutputFamily::frequency, nullptr, frequency},
    Source{Quantity::deployment_time, std::nullopt, nullptr, deployment_time}};
static_assert(sources.size() == output_kinds.size());
static_assert(std::ranges::all_of(sources, [](const Source& source) {
  return &sources[static_cast<std::size_t>(source.quantity)] == &source;
}));

const Source& source_of(Quantity quantity) { return sources[static_cast<std::size_t>(quantity)]; }

bool is_default(const OutputFamilyInfo& family, const Scene* scene) {
  if (family.by_default != ByDefault::with_its_feature) return family.by_default == ByDefault::yes;
  return scene && std::ranges::any_of(sources, [&](const Source& source) {
           return source.family == family.family && source.has &&
                  std::ranges::any_of(scene->hinges, source.has);
         });
}

Outputs default_outputs(const Scene* scene) {
  Outputs outputs;
  for (const OutputFamilyInfo& each : output_families)
    if (is_default(each, scene)) outputs.insert(each.family);
  return outputs;
}

} // namespace

std::optional<Status> status_named(std::string_view name) {
  const auto found =
      std::ranges::find_if(statuses, [&](Status status) { return to_string(status) == name; });
  return found == statuses.end() ? std::nullopt : std::optional(*found);
}

std::optional<OutputFamily> family_of(OutputQuantity quantity) {
  return source_of(quantity).family;
}

std::optional<OutputFamily> family_of(std::string_view output) {
  const OutputKind* kind = parse_output_name(output).kind;
  return kind ? family_of(kind->quantity) : std::nullopt;
}

Outputs default_outputs() { return default_outputs(nullptr); }

Outputs default_outputs(const Scene& scene) { return default_outputs(&scene); }

bool has_peaks(const Outputs& outputs) {
  return outputs.contains(OutputFamily::peak_moment) || outputs.contains(OutputFamily::peak_force);
}

void match_peaks_final(Outputs& outputs) {
  if (has_peaks(outputs))
    outputs.insert(OutputFamily::peaks_final);
  else
    outputs.erase(OutputFamily::peaks_final);
}

Outputs all_outputs() {
  Outputs outputs;
  for (const OutputFamilyInfo& each : output_families) outputs.insert(each.family);
  outputs.erase(OutputFamily::peaks_final);
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
  for (const OutputFamily family : outputs) json.push_back(about(family).name);
  return json;
}

std::vector<OutputColumn> output_columns(const Scene& scene, const Outputs& outputs) {
  std::vector<OutputColumn> columns;
  const auto add = [&](Quantity quantity, const std::string& owner, int index, int other = -1) {
    const std::string second = other < 0 ? "" : scene.hinges[other].name;
    columns.push_back({output_name(quantity, owner, second), quantity, index, other});
  };
  for (int i = 0; i < std::ssize(scene.hinges); ++i) {
    const Hinge& hinge = scene.hinges[i];
    for (const Source& source : sources)
      if (source.has && source.has(hinge) && outputs.contains(*source.family))
        add(source.quantity, hinge.name, i);
    for (int other = 0; outputs.contains(OutputFamily::rate_at) && other < std::ssize(scene.hinges);
         ++other)
      if (other != i && scene.hinges[other].latch && is_turnable(hinge))
        add(Quantity::rate_at, hinge.name, i, other);
  }
  for (int b = 0; b < std::ssize(scene.bodies); ++b)
    if (scene.bodies[b].flexible && outputs.contains(OutputFamily::peak_moment))
      add(Quantity::peak_bending_moment, scene.bodies[b].name, b);
  if (outputs.contains(OutputFamily::base_motion) && scene.base.motion == BaseMotion::free)
    for (const Quantity quantity : {Quantity::base_peak_angle, Quantity::base_peak_rate})
      add(quantity, "base", -1);
  const int modes = std::min(freedoms(scene), most_mode_outputs);
  for (int k = 0; k < modes && outputs.contains(OutputFamily::frequency); ++k)
    add(Quantity::frequency, fmt::format("mode_{}", k + 1), k);
  add(Quantity::deployment_time, "", -1);
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
  return finite_or_none(source_of(column.quantity).value(column, outcome));
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
