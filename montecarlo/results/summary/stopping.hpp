/// Evaluates the goals of a stopping rule (campaign/stopping_rule.hpp).
#pragma once

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/model/campaign/stopping_rule.hpp"
#include "montecarlo/results/summary/verdict.hpp"

#include <optional>
#include <span>
#include <vector>

namespace wingspread {

/// A goal and its state. A quantile and its interval are over all runs, as in the summary.
struct GoalState {
  StoppingGoal goal;
  std::optional<double> width; ///< of the interval, absolute; nothing if a bound does not exist
  bool met = false;
  std::optional<double>
      relative{}; ///< the width as a share of the quantile's magnitude; for a relative goal
};

/// @param requirements the campaign's: they decide at which end missing values rank
/// @param verdicts   on the campaign's requirements, at their confidence for one analysis
/// @param confidence of each interval, two-sided
/// @pre draws of runs are independent; the results have the outputs
[[nodiscard]] std::vector<GoalState> evaluate_goals(const StoppingRule& rule,
                                                    const Results& results,
                                                    std::span<const Requirement> requirements,
                                                    std::span<const Verdict> verdicts,
                                                    double confidence);

/// Whether every goal is met; false without goals.
[[nodiscard]] bool are_met(std::span<const GoalState> goals);

} // namespace wingspread
