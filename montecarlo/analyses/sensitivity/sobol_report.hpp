/// Sobol' indices as JSON, CSV and a table for a terminal. JSON numbers read back to the same double; undefined: null.
#pragma once

#include "montecarlo/analyses/sensitivity/sobol_sensitivity.hpp"
#include "montecarlo/foundation/formats/json.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// @param about the value of the key "wingspread"
[[nodiscard]] Json sensitivity_json(const SobolSensitivity& all, const Json& about);

/// One line per output and dispersion.
[[nodiscard]] std::string sensitivity_csv(const SobolSensitivity& all);

/// One table per output, dispersions sorted by their total index.
[[nodiscard]] std::string sensitivity_table(const SobolSensitivity& all, std::string_view title);

/// A line for each output: the dispersions that move it, with their shares of its variance (total indices).
[[nodiscard]] std::string moved_by_table(const SobolSensitivity& all, std::string_view title);

/// Warnings about idle dispersions and missing values, one per entry.
[[nodiscard]] std::vector<std::string> warnings(const SobolSensitivity& all);

} // namespace wingspread
