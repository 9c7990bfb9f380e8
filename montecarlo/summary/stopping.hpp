/// How wide the intervals are by which a campaign may stop (campaign/stopping_rule.hpp).
#pragma once

#include "montecarlo/campaign/stopping_rule.hpp"
#include "montecarlo/runs/results.hpp"

#include <optional>
#include <span>
#include <vector>

namespace wingspread {

/// A goal and how wide its interval is. Of a quantile, over the runs in which the output happened.
struct WidthFound {
  WidthGoal goal;
  std::optional<double> width; ///< absolute; nothing where a bound does not exist
  bool met = false;
};

/// @param confidence of each interval, two-sided
/// @pre the draws of the runs are independent; the results have the outputs
[[nodiscard]] std::vector<WidthFound> find_widths(const StoppingRule& rule, const Results& results,
                                                  double confidence);

/// Whether every goal is met; false without any.
[[nodiscard]] bool are_met(std::span<const WidthFound> widths);

} // namespace wingspread
