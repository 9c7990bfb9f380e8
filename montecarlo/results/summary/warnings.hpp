/// Warnings about a campaign's results: one text for the table and for summary.json.
#pragma once

#include "montecarlo/results/summary/summary.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// Numbers of runs whose peaks are proven, cut by t_end, or unknown.
[[nodiscard]] PeaksCount count_peaks_final(const Results& results);

/// Warnings of overtravel, of latches whose damping decides the nominal peak, of peaks cut by t_end, and of limits on the
/// other side of zero from every value. In this order, each on one line.
[[nodiscard]] std::vector<std::string> warnings(const Summary& summary);

} // namespace wingspread
