/// The fit as JSON, as CSV and as text for a terminal.
#pragma once

#include "montecarlo/analyses/fit/fit_study.hpp"

#include <string>

namespace wingspread {

inline constexpr const char* fit_json_file = "fit.json";
inline constexpr const char* traces_csv_file = "traces.csv";

/// @param about the value of the key "wingspread"
[[nodiscard]] Json fit_json(const FitResult& result, const FitSpec& spec, const Json& about);

/// FitResult::posterior as CSV, a row a sample: parameters as their dispersions apply them. Empty without columns.
[[nodiscard]] std::string posterior_csv(const FitResult& result);

/// Traces beside the fit: test, column, t, measured, fitted, lower, upper; SI.
[[nodiscard]] std::string traces_csv(const FitResult& result, const FitSpec& spec);

/// The report: misfits, parameters, what the tests do not see, candidates, the prediction.
[[nodiscard]] std::string fit_text(const FitResult& result, const FitSpec& spec);

/// The parameters that the prior decides, not the tests (unseen_ratio).
[[nodiscard]] std::vector<std::string> names_by_prior(const FitResult& result);

/// Sentences that a reader needs before the numbers: misfits, further modes, tempering. Empty if there is none.
[[nodiscard]] std::vector<std::string> fit_findings(const FitResult& result, const FitSpec& spec);

} // namespace wingspread
