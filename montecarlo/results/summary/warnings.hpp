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

/// Sets never_final of the summary and its verdicts, from the scene and laws of the case's campaign.
void explain_cuts(const Campaign& campaign, Summary& summary);

/// One line for each warning, in this order: all runs are the same; overtravel; latches whose damping decides the
/// nominal peak; peaks cut by t_end; latches that may let go after t_end; outputs that moved at a tighter tolerance;
/// limits on the other side of zero from every value.
[[nodiscard]] std::vector<std::string> warnings(const Summary& summary);

/// The warnings of all cases, each followed by the names of its cases. Warnings that differ only in numbers are merged:
/// "in 7 to 60 of 60 runs … (every case: cold 60, hot 7)".
[[nodiscard]] std::vector<std::string> warnings(std::span<const CaseSummary> cases);

/// The table's section "WARNING"; empty if there are none.
[[nodiscard]] std::string warning_lines(const std::vector<std::string>& lines);

} // namespace wingspread
