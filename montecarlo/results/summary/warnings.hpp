/// Warnings about a campaign's results: one text for the table and for summary.json.
#pragma once

#include "montecarlo/results/summary/summary.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// Numbers of runs whose peaks are proven, cut by t_end, or unknown.
[[nodiscard]] PeaksCount count_peaks_final(const Results& results);

/// Overtravel, peaks cut by t_end, and limits on the other side of zero from every value: a line each, in this order.
[[nodiscard]] std::vector<std::string> warnings(const Summary& summary);

} // namespace wingspread
