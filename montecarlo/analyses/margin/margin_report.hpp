/// The report of a study of margins: margin.json and margin.csv, and text for people. What it says of
/// static margins is in static_margin_report.hpp.
#pragma once

#include "montecarlo/analyses/margin/margin_findings.hpp"
#include "montecarlo/model/static_margins/static_margin_report.hpp"

#include <string>
#include <vector>

namespace wingspread {

inline constexpr const char* margin_json_file = "margin.json";
inline constexpr const char* margin_csv_file = "margin.csv";
inline constexpr const char* motorization_csv_file = "motorization.csv";
/// The campaign with the recommended springs.
inline constexpr const char* recommended_file = "recommended.json";

/// All there is to report. The campaign has a margin.
struct MarginReport {
  const Campaign& campaign;
  const MarginResult& result;
  StaticMarginReport static_margins;
};

/// With the static margins at the present springs, and at those recommended.
/// @pre campaign and result outlive it
[[nodiscard]] MarginReport margin_report(const Campaign& campaign, const MarginResult& result);

/// @param about the value of "wingspread"
[[nodiscard]] Json margin_json(const MarginReport& report, const Json& about);

/// A row for each scale that was looked at, case and requirement, upwards: so far as there are any.
[[nodiscard]] std::string margin_csv(const Campaign& campaign, const MarginResult& result);

/// A report for a terminal: UTF-8, at most 100 columns wide.
[[nodiscard]] std::string margin_text(const MarginReport& report);

} // namespace wingspread
