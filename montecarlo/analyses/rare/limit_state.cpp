#include "montecarlo/analyses/rare/limit_state.hpp"

#include "core/scene/torque.hpp"
#include "montecarlo/engine/runs/finality.hpp"
#include "montecarlo/foundation/formats/nearest.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"
#include "montecarlo/model/static_margins/motor_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace wingspread {
namespace {

OutputColumn column_named(const Scene& scene, const std::string& name) {
  std::vector<std::string> known;
  for (const OutputColumn& column : output_columns(scene, all_outputs())) {
    if (column.name == name) return column;
    known.push_back(column.name);
  }
  throw SpecError({{"", "--output", fmt::format("\"{}\"", name),
                    fmt::format("an output of a run, like \"{}\"{}", known.front(),
                                did_you_mean(name, known))}});
}

Goal goal_for(const std::optional<OutputColumn>& column) {
  const auto family = column ? family_of(column->quantity) : std::nullopt;
  Goal goal = goal_of(family ? Outputs{*family} : Outputs{});
  goal.end_state = true;
  return goal;
}

/// Maps a share of any sign monotonically to a value above 0. Above the knee it is the identity; below, an exponential
/// with the same value and slope at the knee.
double positive_part(double share) {
  // Heuristic. A knee far above 0.01 hides differences between runs near the event. With a knee far below, g of these
  // runs is equal in double precision. Both cost runs; neither biases the estimate.
  constexpr double knee = 0.01;
  return share > knee ? share : knee * std::exp(share / knee - 1);
}

/// The hinge's drive minus its static friction at the stowed angle, N·m; with a motor, under its fastest command.
double release_reserve(const Hinge& hinge) {
  const double motor = hinge.motor ? stall_torque_at(hinge, 0) : 0;
  return torque_at(hinge.spring, hinge, 0) + motor - torque_at(hinge.harness, hinge, 0) -
         static_level_at(hinge, 0);
}

bool can_stick_stowed(const Hinge& hinge) {
  return hinge.latch && hinge.friction.model == FrictionModel::exact && hinge.initial_rate == 0;
}

/// The largest remaining share of travel of a hinge with an open latch; 1 if unknown.
double remaining_travel(const Scene& scene, const Outcome& outcome) {
  double most = 0;
  for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
    const Hinge& hinge = scene.hinges[i];
    const bool open = hinge.latch && !holding_latch(outcome, static_cast<int>(i));
    if (open && i < outcome.final.angles.size())
      most = std::max(most, std::abs((outcome.final.angles[i] - hinge.latched) /
                                     (hinge.stowed - hinge.latched)));
  }
  return most > 0 ? most : 1; // the final state is unknown
}

} // namespace

std::string describe(const RareEvent& event) {
  if (event.output.empty()) return "not deployed";
  const char* bar = event.absolute ? "|" : "";
  return fmt::format("{0}{1}{0} {2} {3:.6g}", bar, event.output, event.above ? '>' : '<',
                     event.limit);
}

double level_of(const RareEvent& event, double g) {
  if (event.output.empty()) return g;
  return event.above ? event.limit - g : event.limit + g;
}

LimitState::LimitState(const Campaign& campaign, RareEvent event)
    : campaign_(&campaign), event_(std::move(event)) {
  nominal_ = nominal_scene(campaign);
  const Scene& scene = nominal_;
  if (!event_.output.empty()) {
    column_ = column_named(scene, event_.output);
    goal_ = goal_for(column_);
    return;
  }
  goal_ = goal_for(column_);
  if (std::ranges::none_of(scene.hinges, [](const Hinge& hinge) { return bool(hinge.latch); }))
    throw SpecError({{"", "/scene/hinges", "none with a latch",
                      "a hinge with a latch, or --output with a limit"}});
  const Outcome nominal = Deployment().run(scene, campaign.integration, goal_);
  if (nominal.status != Status::deployed) return;
  energy_ = std::max(nominal.energy.final, 1e-9 * std::abs(nominal.energy.initial));
  time_ = campaign.integration.t_end - nominal.t_end;
}

Measure LimitState::measure() const {
  const Json event{{"output", event_.output},
                   {"limit", event_.limit},
                   {"above", event_.above},
                   {"abs", event_.absolute}};
  return {"g", goal_,
          [this](const Scene& scene, const Outcome& outcome) { return of(scene, outcome); },
          event.dump()};
}

Measure measure_of_recipe(const Campaign& campaign, const std::string& recipe) {
  const Json json = parse_json(recipe, "");
  const RareEvent event{json.at("output").get<std::string>(), json.at("limit").get<double>(),
                        json.at("above").get<bool>(), json.at("abs").get<bool>()};
  const auto state = std::make_shared<const LimitState>(campaign, event);
  Measure measure = state->measure();
  measure.of = [state](const Scene& scene, const Outcome& outcome) {
    return state->of(scene, outcome);
  };
  return measure;
}

double LimitState::of_deployed(const Scene& scene, const Outcome& outcome) const {
  const double time = (campaign_->integration.t_end - outcome.t_end) / time_;
  double least = std::min(outcome.energy.final / energy_, time);
  for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
    const double nominal = release_reserve(nominal_.hinges[i]);
    if (can_stick_stowed(scene.hinges[i]) && nominal > 0)
      least = std::min(least, release_reserve(scene.hinges[i]) / nominal);
  }
  return positive_part(least);
}

double LimitState::of(const Scene& scene, const Outcome& outcome) const {
  if (column_) {
    const double signed_value = output_of(*column_, outcome);
    const double value = event_.absolute ? std::abs(signed_value) : signed_value;
    const double g = event_.above ? event_.limit - value : value - event_.limit;
    // A cut peak may still rise: into an event above the limit, out of one below it.
    const bool open = is_cut(peak(), peaks_final_of(outcome)) && (event_.above || g < 0);
    return open ? std::numeric_limits<double>::quiet_NaN() : g;
  }
  return outcome.status == Status::deployed ? of_deployed(scene, outcome)
                                            : -remaining_travel(scene, outcome);
}

} // namespace wingspread
