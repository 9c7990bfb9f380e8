/// The limit state g of subset simulation: the distance of a run from an event.
///
///   g < 0   the event happened
///   g > 0   it did not; the smaller g, the nearer the run came to the event
///
/// Only the sign of g enters the probability, and the outcome of the run decides the sign. The magnitude of g decides
/// how many runs an estimate takes.
///
/// An output beyond a limit:  g = limit − value (event above) or value − limit (event below), in the output's unit. A
/// run without the output (no deployment time, or a failed run without peaks) counts as the event, just as it breaks a
/// requirement. So does a run whose peak t_end cut (finality.hpp): g is NaN,
/// unless the event is a peak below the limit, and the peak has reached the limit already.
///
/// Not deployed:  for a deployed wing g is the smallest of its reserves, each as a share of the nominal wing's:
///
///   energy   kinetic and potential energy when the last hinge latches: the reserve against a barrier on the way (a
///            harness stronger than its spring, with friction). For a single hinge this energy is the work of all
///            torques over the travel. It tends to 0 for a wing that barely latches, as the remaining travel does for
///            a wing that barely stops short: g is continuous at 0
///   time     from the last latch to t_end: a creeping wing uses it up
///   release  for each hinge that can stick at the stowed angle: drive minus static friction there. Inertia may release
///            the hinge even if this reserve is negative, so positive values replace negative ones
///
/// and for a wing that is not deployed, g is minus the largest remaining share of a hinge's travel.
#pragma once

#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/campaign/outputs.hpp"

#include <optional>
#include <string>

namespace wingspread {

/// An event in a run.
struct RareEvent {
  std::string output;    ///< its name; empty: the event is "not deployed"
  double limit = 0;      ///< limit of the output, in its unit
  bool above = true;     ///< the event is a value above the limit; false: below
  bool absolute = false; ///< the value's magnitude counts
};

/// "root.peak_moment > 400", "|root.latch_rate| > 5" or "not deployed".
[[nodiscard]] std::string describe(const RareEvent& event);

/// The output's value at this g; g itself for "not deployed".
[[nodiscard]] double level_of(const RareEvent& event, double g);

/// The limit state of an event in a campaign's runs. Immutable: one object serves all threads.
class LimitState {
public:
  /// Runs the nominal wing.
  /// @pre the campaign outlives the limit state
  /// @throws SpecError when the scene has no such output, or no latch to be deployed by
  LimitState(const Campaign& campaign, RareEvent event);

  [[nodiscard]] const RareEvent& event() const { return event_; }
  /// The quantities that a run must compute for the event.
  [[nodiscard]] const Goal& goal() const { return goal_; }
  /// The family of the event's output, if it is a peak.
  [[nodiscard]] PeakKind peak() const {
    return column_ ? peak_kind(column_->name) : PeakKind::none;
  }
  /// g of a run; NaN for a run without the output, and for a cut peak that may still rise into the event or out of it
  /// (subset_simulation counts NaN as the event).
  [[nodiscard]] double of(const Scene& scene, const Outcome& outcome) const;
  /// g as a Measure of a RunPlan, with the event as its recipe. @pre the limit state outlives it
  [[nodiscard]] Measure measure() const;

private:
  [[nodiscard]] double of_deployed(const Scene& scene, const Outcome& outcome) const;

  const Campaign* campaign_;
  Scene nominal_;
  RareEvent event_;
  std::optional<OutputColumn> column_;
  Goal goal_;
  double energy_ = 1, time_ = 1; ///< reserves of the nominal wing, J and s
};

/// Rebuilds, in another process, the measure of LimitState::measure from its recipe. Runs the nominal wing.
/// @pre the campaign outlives the measure
/// @throws SpecError as LimitState's constructor does
[[nodiscard]] Measure measure_of_recipe(const Campaign& campaign, const std::string& recipe);

} // namespace wingspread
