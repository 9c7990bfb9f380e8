/// The cases of a campaign side by side: plain data from their summaries, cases.json, and a table for the terminal.
///
/// All cases are run with the same draws, so that what differs between them is the case; each verdict holds for itself.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/summary/summary.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// What the runs of a case come to.
struct CaseSummary {
  std::string name;
  Summary summary;
  bool partial = false; ///< runs of it are missing
};

/// In which case a requirement stands worst: failed before undecided before passed, then the least margin, then the
/// least share of runs that keep to it. The first of those that are equal.
/// @param requirement its number in each summary, which all have the same ones
/// @pre at least one case
[[nodiscard]] std::size_t worst_case(const std::vector<CaseSummary>& cases,
                                     std::size_t requirement);

/// cases.json: status, outputs and requirements with the cases beside each other.
/// @param about the value of "wingspread"
[[nodiscard]] Json cases_json(const std::vector<CaseSummary>& cases, const Json& about);

/// Shares of outcomes, mean and outermost quantiles of every output, and requirements with their worst case.
/// @param title  its first line
/// @param folder where the cases' folders are
[[nodiscard]] std::string cases_table(const std::vector<CaseSummary>& cases, std::string_view title,
                                      std::string_view folder);

} // namespace wingspread
