/// What rank correlations say: as JSON, as CSV, and as a table for a terminal.
///
/// JSON is strict: what is undefined is null. Numbers read back to the same double.
#pragma once

#include "montecarlo/analyses/sensitivity/rank_sensitivity.hpp"
#include "montecarlo/foundation/formats/json.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// @param about the value of "wingspread"
[[nodiscard]] Json sensitivity_json(const RankSensitivity& all, const Json& about);

/// A line for each output and dispersion.
[[nodiscard]] std::string sensitivity_csv(const RankSensitivity& all);

/// Output by output, the dispersions that matter most first: by the larger of their coefficients.
[[nodiscard]] std::string sensitivity_table(const RankSensitivity& all, std::string_view title);

/// What a designer should know before reading on; one a line, without its end.
[[nodiscard]] std::vector<std::string> warnings(const RankSensitivity& all);

} // namespace wingspread
