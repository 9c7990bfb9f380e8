/// How far a run is from an event: the limit state g of subset simulation.
///
///   g < 0   the event happened
///   g > 0   it did not, and the smaller g, the nearer the run came to it
///
/// Which side a run is on is its outcome's word alone. How near it came decides only how many runs
/// an estimate takes, not what it tends to.
///
/// An output beyond a limit:  g = limit − value (above it), or value − limit (below it), in the
/// output's unit. A run without the output (a wing that did not deploy has no deployment time; a
/// run that failed has no peak) counts as the event, as it counts against a requirement.
///
/// Not deployed:  of a wing that deployed, g is the least of what it had left, each as a share of
/// what the nominal wing has:
///
///   energy   kinetic and potential, when the last hinge latched: what a barrier on the way (a
///            harness that outweighs its spring, with friction) would have had to take besides. Of
///            a single hinge it is what the work of all torques over the travel comes to, which is
///            also by how much one lacks that stops short: there g runs on through 0
///   time     from the last latch to t_end: a wing that creeps runs out of it
///   release  of each hinge that sticks, the torque by which its drive exceeds its static friction
///            where it is stowed. A hinge may be shaken loose all the same: so this one is bent to
///            stay above 0
///
/// and of one that did not, minus the largest part of its travel that a hinge has left.
#pragma once

#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/campaign/outputs.hpp"

#include <optional>
#include <string>

namespace wingspread {

/// What may happen in a run.
struct RareEvent {
  std::string output; ///< by name; empty: the wing is not deployed
  double limit = 0;   ///< of the output
  bool above = true;  ///< the event is a value above the limit; else one below
};

/// "root.peak_moment > 400", or "not deployed".
[[nodiscard]] std::string describe(const RareEvent& event);

/// Where the output stands that has this g; g itself for an event without one.
[[nodiscard]] double level_of(const RareEvent& event, double g);

/// The measure of an event in a campaign's runs. Immutable, so one object serves all threads.
class LimitState {
public:
  /// Runs the nominal wing.
  /// @pre the campaign outlives the limit state
  /// @throws SpecError when the scene has no such output, or no latch to be deployed by
  LimitState(const Campaign& campaign, RareEvent event);

  [[nodiscard]] const RareEvent& event() const { return event_; }
  /// What a run has to compute: no more than the event depends on.
  [[nodiscard]] const Goal& goal() const { return goal_; }
  /// g. NaN where an output is missing: the event.
  [[nodiscard]] double of(const Scene& scene, const Outcome& outcome) const;
  /// It as what is taken of a run, with the event as the recipe. @pre the limit state outlives it
  [[nodiscard]] Measure measure() const;

private:
  [[nodiscard]] double of_deployed(const Scene& scene, const Outcome& outcome) const;

  const Campaign* campaign_;
  RareEvent event_;
  std::optional<OutputColumn> column_;
  Goal goal_;
  double energy_ = 1, time_ = 1; ///< what the nominal wing has left, J and s
};

/// The measure again, made from the recipe of another one (LimitState::measure). Runs the nominal wing.
/// @pre the campaign outlives the measure
/// @throws SpecError as LimitState's constructor does
[[nodiscard]] Measure measure_of_recipe(const Campaign& campaign, const std::string& recipe);

} // namespace wingspread
