/// What the window of spring strength comes to: margin.json, its two tables as CSV, and a report
/// for people.
#pragma once

#include "montecarlo/margin/margin_study.hpp"
#include "montecarlo/margin/motorization_study.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

inline constexpr const char* margin_json_file = "margin.json";
inline constexpr const char* margin_csv_file = "margin.csv";
inline constexpr const char* motorization_csv_file = "motorization.csv";
/// The campaign with the recommended springs.
inline constexpr const char* recommended_file = "recommended.json";

/// The static margins with the springs at a scale.
struct ScaledMotorization {
  double scale;
  MotorizationStudy study;
};

/// All there is to report. The campaign has a margin.
struct MarginReport {
  const Campaign& campaign;
  const MarginResult& result;
  std::vector<ScaledMotorization> motorization; ///< at the present springs, and the recommended
};

/// Where a requirement in a case holds.
struct ConditionReport {
  std::string requirement, which_case;
  std::vector<Window> holds;
  std::string_view kind; ///< "always", "never", "lower", "upper", "both" or "several": its edges
  std::optional<OutOfOrder> out_of_order; ///< none without a window
};
[[nodiscard]] std::vector<ConditionReport> conditions(const MarginReport& report,
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

/// The conditions that fail, less those that fail for runs alone which did not deploy, when in
/// their case that "deployed" is required, or another condition before them, says so already.
[[nodiscard]] Failing telling(const ScaleLook& look);

/// Whether every search has a window that is confirmed: what the command's exit status says.
[[nodiscard]] bool is_met(const MarginResult& result);

/// @param about the value of "wingspread"
[[nodiscard]] Json margin_json(const MarginReport& report, const Json& about);

/// A row for each scale that was looked at, case and requirement, upwards: so far as there are any.
[[nodiscard]] std::string margin_csv(const Campaign& campaign, const MarginResult& result);

/// A row for each scale, hinge and place of the travel: terms, margins, their quantiles over the
/// draws and the worst draw.
[[nodiscard]] std::string motorization_csv(const MarginReport& report);

/// A report for a terminal: UTF-8, at most 100 columns wide.
[[nodiscard]] std::string margin_text(const MarginReport& report);

} // namespace wingspread
