#include "montecarlo/summary/stopping.hpp"

#include "montecarlo/campaign/outputs.hpp"
#include "montecarlo/statistics/binomial_bounds.hpp"
#include "montecarlo/statistics/statistics.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace wingspread {
namespace {

WidthFound find_width(const WidthGoal& goal, const Results& results, double confidence) {
  WidthFound found{goal, {}, false};
  if (results.size() == 0) return found;
  if (const auto status = status_named(goal.output)) {
    const long hits = std::ranges::count(results.status, *status);
    const Interval interval = clopper_pearson(hits, static_cast<long>(results.size()), confidence);
    found.width = interval.upper - interval.lower;
    found.met = *found.width <= goal.width;
    return found;
  }
  const auto column = std::ranges::find(results.outputs, goal.output, &Column::name);
  assert(column != results.outputs.end());
  const std::vector<double> sorted = sorted_present(column->values);
  column->values.release();
  const Bounds bounds = quantile_bounds(sorted, *goal.quantile, confidence);
  if (!bounds.lower || !bounds.upper) return found;
  found.width = *bounds.upper - *bounds.lower;
  const double unit = goal.relative ? std::abs(quantile(sorted, *goal.quantile)) : 1;
  found.met = *found.width <= goal.width * unit;
  return found;
}

} // namespace

std::vector<WidthFound> find_widths(const StoppingRule& rule, const Results& results,
                                    double confidence) {
  std::vector<WidthFound> widths;
  for (const WidthGoal& goal : rule) widths.push_back(find_width(goal, results, confidence));
  return widths;
}

bool are_met(std::span<const WidthFound> widths) {
  return !widths.empty() && std::ranges::all_of(widths, &WidthFound::met);
}

} // namespace wingspread
