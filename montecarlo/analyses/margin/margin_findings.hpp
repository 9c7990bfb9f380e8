/// Results of the window search: the scales at which each requirement holds, and the requirements that set the edges.
#pragma once

#include "montecarlo/analyses/margin/margin_result.hpp"
#include "montecarlo/model/campaign/campaign.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// The scales at which a requirement holds in one case.
struct ConditionFinding {
  MarginCondition condition;
  std::string requirement, which_case;
  std::vector<Window> holds;
  std::string_view
      kind; ///< "always", "never"; its edges: "lower", "upper", "both"; "several" windows
  std::optional<OutOfOrder> out_of_order; ///< none without a window
};
[[nodiscard]] std::vector<ConditionFinding> condition_findings(const Campaign& campaign,
                                                               const MarginResult& result,
                                                               const MarginSearch& search);

/// An edge of a window.
struct MarginEdge {
  double passing;                  ///< the outermost scale at which all conditions pass
  std::optional<double> failing;   ///< the next scale outwards; none at the end of the search
  std::vector<std::size_t> set_by; ///< the conditions to report as failing at `failing`
  std::vector<std::size_t>
      as_well; ///< further conditions that fail there because the same runs do not deploy
};
[[nodiscard]] MarginEdge lower_edge(const MarginSearch& search, const Window& window);
[[nodiscard]] MarginEdge upper_edge(const MarginSearch& search, const Window& window);

/// The neighbouring scales of a window that are furthest apart by ratio; equal for a window of one scale. Nothing was run
/// between them: a requirement that fails only there is not seen (window_search.hpp).
struct ScaleGap {
  double lower, upper;
};
[[nodiscard]] ScaleGap widest_gap(const MarginSearch& search, const Window& window);

/// A lower bound of the confidence that the found window lies within the true window: 1 − Σ(1 − c) over all conditions
/// at each edge (an end of the range is no edge). It holds if no draw is out of order (margin_study.hpp), between
/// the scales that were run too. At most 0: no guarantee.
[[nodiscard]] double window_confidence(const Campaign& campaign, const MarginResult& result,
                                       const Window& window);

/// A lower bound of the confidence that all requirements hold in all cases at a confirmed scale. Such a scale is fixed
/// before the confirmation runs, and all their verdicts are "pass".
[[nodiscard]] double confirmation_confidence(const Campaign& campaign, const MarginResult& result);

/// The failing conditions to report. If several conditions of a case fail only because runs did not deploy, one of them
/// is reported: the requirement on "deployed" if it fails, else the first.
[[nodiscard]] Failing to_report(const ScaleResult& cases);

/// A drawback of the recommended springs: a condition that more runs break than with the present springs, or whose
/// required quantile is nearer to the limit.
struct Concession {
  std::size_t condition;
  const Verdict *present, *recommended;
  double present_quantile, quantile; ///< over runs with the output; NaN without any
};
/// Empty without a recommendation, and for the present springs. @pre the search outlives the result
[[nodiscard]] std::vector<Concession>
concessions(const Campaign& campaign, const MarginResult& result, const MarginSearch& search);

/// The condition with the largest strain at a scale (recommendation.hpp); the first of equals.
[[nodiscard]] std::size_t most_strained(const ScaleResult& cases);

/// Explains the choice among scales of equal strain: ", nor at any other scale seen from 1.2 to 1.6: their
/// geometric mean is recommended". Empty if no other scale is as good. @pre a scale is recommended
[[nodiscard]] std::string why_this_one(const MarginSearch& search);

/// How a search's text calls what it scales.
struct ScaledWords {
  std::string_view things = "springs", lowest = "weakest springs", highest = "strongest springs",
                   present = "present springs", scale = "spring scale", heading = "NEW SPRINGS";
};
[[nodiscard]] ScaledWords words_of(const MarginSearch& search);

/// The rule by which the recommended scale was chosen: "least strain", ScaledWords::present or "geometric
/// mean".
[[nodiscard]] std::string_view rule_of(const MarginSearch& search);

/// The cut peaks (finality.hpp) of a requirement in a case at one scale.
struct CutPeaks {
  double scale = 1;
  std::string requirement, which_case;
  long cut = 0, runs = 0;
  std::string_view never_final{}; ///< why_never_final of the case
};
/// For each condition the scale with most cut peaks; of equals the one nearest to the present springs. Only three kinds
/// of scales count: the present springs, the recommended ones, and scales that would pass if the cut peaks did not
/// break the condition.
[[nodiscard]] std::vector<CutPeaks> cut_peaks(const MarginResult& result,
                                              const MarginSearch& search);

/// The reason why no scale is recommended; empty if one is.
[[nodiscard]] std::string why_withheld(const MarginSearch& search);

/// Warnings. Of the recommended scales: static margins of the nominal wing below 0, which no run shows because a wing
/// may deploy by momentum. Of all scales: peaks that t_end cut, and latches that may let go after t_end.
[[nodiscard]] std::vector<std::string> margin_warnings(const MarginResult& result);

/// Whether every search has a confirmed window. The exit code of `margin` depends on it.
[[nodiscard]] bool is_met(const MarginResult& result);

/// The joint search if it recommends a scale; else null: scales found hinge by hinge are not valid together.
[[nodiscard]] const MarginSearch* recommending(const Campaign& campaign,
                                               const MarginResult& result);

} // namespace wingspread
