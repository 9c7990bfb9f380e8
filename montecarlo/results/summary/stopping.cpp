#include "montecarlo/results/summary/stopping.hpp"

#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/model/campaign/outputs.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace wingspread {
namespace {

/// The number of runs with a status, or with 1 in an output that is 1 or 0.
long hits_of(const std::string& share, const Results& results) {
  if (const auto status = status_named(share)) return std::ranges::count(results.status, *status);
  const auto column = std::ranges::find(results.outputs, share, &Column::name);
  assert(column != results.outputs.end());
  const long hits = std::ranges::count(column->values, 1.0);
  column->values.release();
  return hits;
}

GoalState find(const WidthGoal& goal, const Results& results,
               std::span<const Requirement> requirements, double confidence) {
  GoalState found{goal, {}, false};
  if (results.size() == 0) return found;
  if (!goal.quantile) {
    const long hits = hits_of(goal.output, results);
    const Interval interval = clopper_pearson(hits, static_cast<long>(results.size()), confidence);
    found.width = interval.upper - interval.lower;
    found.met = *found.width <= goal.width;
    return found;
  }
  const auto column = std::ranges::find(results.outputs, goal.output, &Column::name);
  assert(column != results.outputs.end());
  const std::vector<double> sorted = sorted_present(column->values);
  column->values.release();
  const long missing = std::ssize(column->values) - std::ssize(sorted);
  const double p = *goal.quantile;
  const PartialRanks ranks{std::ssize(sorted), missing, missing_rank(requirements, goal.output)};
  const Bounds bounds = quantile_bounds(sorted, ranks, p, confidence);
  if (!bounds.lower || !bounds.upper) return found;
  found.width = *bounds.upper - *bounds.lower;
  const double unit = goal.relative ? std::abs(quantile(sorted, ranks, p)) : 1;
  found.met = *found.width <= goal.width * unit;
  if (goal.relative) found.relative = *found.width / unit;
  return found;
}

/// Met if a requirement has this name, and every one with this name is passed or disproved.
GoalState find(const DecisionGoal& goal, std::span<const Verdict> verdicts) {
  GoalState found{goal, {}, false};
  for (const Verdict& verdict : verdicts) {
    if (name_of(verdict.requirement) != goal.requirement) continue;
    found.met = is_decided(verdict);
    if (!found.met) break;
  }
  return found;
}

} // namespace

std::vector<GoalState> evaluate_goals(const StoppingRule& rule, const Results& results,
                                      std::span<const Requirement> requirements,
                                      std::span<const Verdict> verdicts, double confidence) {
  std::vector<GoalState> found;
  for (const StoppingGoal& goal : rule)
    if (const WidthGoal* width = std::get_if<WidthGoal>(&goal))
      found.push_back(find(*width, results, requirements, confidence));
    else
      found.push_back(find(std::get<DecisionGoal>(goal), verdicts));
  return found;
}

bool are_met(std::span<const GoalState> goals) {
  return !goals.empty() && std::ranges::all_of(goals, &GoalState::met);
}

} // namespace wingspread
