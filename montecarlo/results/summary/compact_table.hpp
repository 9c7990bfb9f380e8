/// Short forms of the tables, for one screen; `--all` prints the long ones (table.hpp, comparison.hpp).
#pragma once

#include "montecarlo/results/summary/comparison.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// Whether a table leaves an output out: it has the same value in every run, or is an overtravel within
/// most_overtravel.
[[nodiscard]] bool is_quiet(const OutputSummary& output);

/// The quiet outputs in a line or two: the overtravels together with their largest value, the others with their value.
/// Empty without any. @param cases the same outputs in each
[[nodiscard]] std::string quiet_outputs(std::span<const CaseSummary> cases);
[[nodiscard]] std::string quiet_outputs(const std::vector<OutputSummary>& outputs);

/// Where the runs without a value rank in the quantiles, naming the outputs in which it is not above every value:
/// "Runs without a value rank above every value; below in root.latch_rate (its requirement is a min)". Empty if every
/// run has every output. @param cases the same outputs in each
[[nodiscard]] std::string missing_ranks(std::span<const CaseSummary> cases);
[[nodiscard]] std::string missing_ranks(const std::vector<OutputSummary>& outputs);

/// The integration error beside the standard error of the mean: a line, or with `all` a table. Empty if it was not
/// measured.
[[nodiscard]] std::string accuracy_text(const Summary& summary, bool all);

/// Cases side by side: outcomes, the first and the last quantile of every output that is not quiet, and the verdicts
/// with the runs that break them. A line for each.
[[nodiscard]] std::string compact_cases_table(const std::vector<CaseSummary>& cases,
                                              std::string_view title, std::string_view folder);

} // namespace wingspread
