/// The report of the window search: margin.json, margin.csv and text. Static margins: static_margin_report.hpp.
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

/// The data of the report. @pre the campaign has a margin
struct MarginReport {
  const Campaign& campaign;
  const MarginResult& result;
  StaticMarginReport static_margins;
};

/// Adds the static margins of the present and of the recommended springs.
/// @pre campaign and result outlive it
[[nodiscard]] MarginReport margin_report(const Campaign& campaign, const MarginResult& result);

/// @param about the value of the key "wingspread"
[[nodiscard]] Json margin_json(const MarginReport& report, const Json& about);

/// One row per evaluated scale (ascending), case and requirement.
[[nodiscard]] std::string margin_csv(const Campaign& campaign, const MarginResult& result);

/// The report for a terminal: UTF-8, at most 100 columns wide.
[[nodiscard]] std::string margin_text(const MarginReport& report);

} // namespace wingspread
