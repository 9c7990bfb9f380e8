/// Warnings about a campaign's results: one text for the table and for summary.json.
#pragma once

#include "montecarlo/results/summary/comparison.hpp"
#include "montecarlo/results/summary/summary.hpp"

#include <span>
#include <string>
#include <vector>

namespace wingspread {

/// Numbers of runs whose peaks are proven, cut by t_end, or unknown.
[[nodiscard]] PeaksCount count_peaks_final(const Results& results);

/// Warnings of runs that are all the same, of overtravel, of latches whose damping decides the nominal peak, of peaks cut by t_end, and of limits on the
/// other side of zero from every value. In this order, each on one line.
[[nodiscard]] std::vector<std::string> warnings(const Summary& summary);

/// The warnings of all cases, each with its cases. Warnings that differ in numbers only are one, with the numbers of its
/// first case.
[[nodiscard]] std::vector<std::string> warnings(std::span<const CaseSummary> cases);

/// The table's section "WARNING"; empty if there are none.
[[nodiscard]] std::string warning_lines(const std::vector<std::string>& lines);

} // namespace wingspread
