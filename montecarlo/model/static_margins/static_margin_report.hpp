/// Writes static margins: JSON, CSV, text for a terminal, and curves for the report's page.
#pragma once

#include "montecarlo/model/static_margins/static_margin_study.hpp"

#include <string>
#include <utility>
#include <vector>

namespace wingspread {

/// The static margins of one case's wing, with the springs at one scale.
struct CaseMargins {
  double scale = 1;
  std::string of_case; ///< empty for a campaign without cases
  StaticMarginStudy study;
};

struct StaticMarginReport {
  StaticMarginSpec spec;
  Scene scene;                       ///< for the hinges' names
  std::vector<double> probabilities; ///< of the quantiles
  std::vector<CaseMargins> cases;
};

/// The least margins over the travel, with the values of the worst draws: the key `motorization` of margin.json.
[[nodiscard]] Json static_margins_json(const StaticMarginReport& report);

/// motorization.csv: one row for each scale, case, hinge and place of the travel, with the torque terms, the nominal
/// margins, and the quantiles and the worst run of the draws' margins.
[[nodiscard]] std::string static_margins_csv(const StaticMarginReport& report);

/// The least margins over the travel as a table: one line for each hinge and standard.
[[nodiscard]] std::string static_margins_text(const StaticMarginReport& report);

/// The least margins over the travel of nominal wings as a table: one line for each drive.
/// @param wings names of cases, empty without cases, and scenes
[[nodiscard]] std::string
nominal_margins_text(const std::vector<std::pair<std::string, Scene>>& wings,
                     const StaticMarginSpec& spec);

/// `static_margins` of the page (page/DATA.md): nominal margins by one standard at each place of the travel, and the
/// draws' quantile at the lowest probability. Null without drives.
[[nodiscard]] Json static_margin_curves(const StaticMarginStudy& study, MarginKind kind,
                                        const std::vector<double>& probabilities);

} // namespace wingspread
