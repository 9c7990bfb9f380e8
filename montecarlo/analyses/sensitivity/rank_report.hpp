/// Rank correlations as JSON, CSV and a table for a terminal. JSON numbers read back to the same double; undefined:
/// null.
#pragma once

#include "montecarlo/analyses/sensitivity/rank_sensitivity.hpp"
#include "montecarlo/foundation/formats/json.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// @param about the value of the key "wingspread"
[[nodiscard]] Json sensitivity_json(const RankSensitivity& all, const Json& about);

/// One line per output and dispersion.
[[nodiscard]] std::string sensitivity_csv(const RankSensitivity& all);

/// One table per output, dispersions sorted by the larger of their coefficients.
[[nodiscard]] std::string sensitivity_table(const RankSensitivity& all, std::string_view title);

/// A line for each output: the dispersions that visibly move it, with the larger of their coefficients.
[[nodiscard]] std::string moved_by_table(const RankSensitivity& all, std::string_view title);

/// Warnings about the dispersions and the bounds, one per entry.
[[nodiscard]] std::vector<std::string> warnings(const RankSensitivity& all);

} // namespace wingspread
