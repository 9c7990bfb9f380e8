/// The cases of a campaign side by side: cases.json and a table for the terminal. All cases have the same draws, so
/// differences come from the case. Each verdict holds by itself.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/summary/summary.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// The results of a case.
struct CaseSummary {
  std::string name;
  Summary summary;
  bool partial = false; ///< runs are missing
};

/// Whether a verdict is worse than another on the same requirement: failed before undecided before passed, then by the
/// largest number of runs that break it, as a share of the number that may, then by the least margin, then by the least
/// share of runs that meet it.
[[nodiscard]] bool is_worse(const Verdict& verdict, const Verdict& other);

/// The case with the worst verdict on a requirement. Ties go to the first case.
/// @param requirement index of the requirement, the same in all summaries
/// @pre at least one case
[[nodiscard]] std::size_t worst_case(const std::vector<CaseSummary>& cases,
                                     std::size_t requirement);

/// cases.json: status, outputs and requirements of all cases side by side.
/// @param about the value of "wingspread"
[[nodiscard]] Json cases_json(const std::vector<CaseSummary>& cases, const Json& about);

/// A line for each stopping goal and case; empty without goals.
[[nodiscard]] std::string stopping_lines(const std::vector<CaseSummary>& cases);

/// Shares of outcomes, mean and outermost quantiles of every output, and requirements with their worst case.
/// @param title  first line
/// @param folder that holds the cases' folders
[[nodiscard]] std::string cases_table(const std::vector<CaseSummary>& cases, std::string_view title,
                                      std::string_view folder);

/// A share of runs in per cent. One that three decimals would write as 0 or 100 has two digits of its distance from it:
/// "0.0000075 %", "99.9999925 %".
[[nodiscard]] std::string share_text(double share);

} // namespace wingspread
