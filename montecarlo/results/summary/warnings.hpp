/// What is to be warned of in a campaign's results, in words: one text for the table and for summary.json.
#pragma once

#include "montecarlo/results/summary/summary.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// How many runs have peaks that are proven, that t_end cut, and of which that is not known.
[[nodiscard]] PeaksCount count_peaks_final(const Results& results);

/// Hinges that turn through their neighbours, peaks that t_end cut, and limits on the other side of zero from every
/// value: one line each, in this order.
[[nodiscard]] std::vector<std::string> warnings(const Summary& summary);

} // namespace wingspread
