/// What the window of spring strength comes to: where each requirement holds, what sets the edges.
#pragma once

#include "montecarlo/analyses/margin/margin_result.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// Where a requirement in a case holds.
struct ConditionFinding {
  MarginCondition condition;
  std::string requirement, which_case;
  std::vector<Window> holds;
  std::string_view kind; ///< "always", "never", "lower", "upper", "both" or "several": its edges
  std::optional<OutOfOrder> out_of_order; ///< none without a window
};
[[nodiscard]] std::vector<ConditionFinding> condition_findings(const Campaign& campaign,
                                                               const MarginResult& result,
                                                               const MarginSearch& search);

/// An edge of a window.
struct MarginEdge {
  double passing;                   ///< the outermost scale that passes
  std::optional<double> failing;    ///< the next one out; none at the end of the range
  std::vector<std::size_t> set_by;  ///< those of the conditions that fail there which tell why
  std::vector<std::size_t> as_well; ///< and those that fail by the same runs, which do not deploy
};
[[nodiscard]] MarginEdge lower_edge(const MarginSearch& search, const Window& window);
[[nodiscard]] MarginEdge upper_edge(const MarginSearch& search, const Window& window);

/// At least the confidence with which the window lies within the true one: every condition's risk once
/// for each edge, Σ(1 − c) in all. The ends of the range are no edges: nothing is claimed of them. By
/// the argument of margin_study.hpp, so for draws that are not out of order.
[[nodiscard]] double window_confidence(const Campaign& campaign, const MarginResult& result,
                                       const Window& window);

/// At least the confidence with which all requirements hold in all cases at one scale, fixed
/// beforehand, at which all verdicts are "pass": what confirms a recommended scale.
[[nodiscard]] double confirmation_confidence(const Campaign& campaign, const MarginResult& result);

/// The conditions that fail, less those that fail for runs alone which did not deploy, when in
/// their case that "deployed" is required, or another condition before them, says so already.
[[nodiscard]] Failing telling(const ScaleLook& look);

/// What the recommended springs give up against the present ones: a condition that more runs break, or that the
/// runs which have its output come nearer to: by the quantile that is required.
struct Concession {
  std::size_t condition;
  const Verdict *present, *recommended;
  double present_quantile, quantile; ///< over those runs; NaN without any
};
/// None where nothing is recommended, or what is present. @pre the search outlives them
[[nodiscard]] std::vector<Concession>
concessions(const Campaign& campaign, const MarginResult& result, const MarginSearch& search);

/// The condition that strains a scale most (recommendation.hpp); the first of equals.
[[nodiscard]] std::size_t most_strained(const ScaleLook& look);

/// Why no scale is recommended; empty where one is.
[[nodiscard]] std::string why_withheld(const MarginSearch& search);

/// Whether every search has a window that is confirmed: what the command's exit status says.
[[nodiscard]] bool is_met(const MarginResult& result);

/// The search whose scale the recommended springs have: that of all springs together, where it has a
/// window. Null else, for springs that were sized one at a time are not recommended together.
[[nodiscard]] const MarginSearch* recommending(const Campaign& campaign,
                                               const MarginResult& result);

} // namespace wingspread
