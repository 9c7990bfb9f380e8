/// How far the goals are reached by which a campaign may stop (campaign/stopping_rule.hpp).
#pragma once

#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/model/campaign/stopping_rule.hpp"
#include "montecarlo/results/summary/verdict.hpp"

#include <optional>
#include <span>
#include <vector>

namespace wingspread {

/// A goal and how far it is reached. A quantile's interval is over the runs in which the output
/// happened.
struct GoalFound {
  StoppingGoal goal;
  std::optional<double> width; ///< of the interval, absolute; nothing where a bound does not exist
  bool met = false;
};

/// @param verdicts   on the campaign's requirements, at their confidence of one look
/// @param confidence of each interval, two-sided
/// @pre the draws of the runs are independent; the results have the outputs
[[nodiscard]] std::vector<GoalFound> find_goals(const StoppingRule& rule, const Results& results,
                                                std::span<const Verdict> verdicts,
                                                double confidence);

/// Whether every goal is met; false without any.
[[nodiscard]] bool are_met(std::span<const GoalFound> goals);

} // namespace wingspread
