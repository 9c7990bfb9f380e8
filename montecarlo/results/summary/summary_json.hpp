/// The files of the statistics: summary.json, histograms.json, histograms.csv.
///
/// What is undefined or did not happen is null (json.hpp). Every definition in use is named in it.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/summary/summary.hpp"

#include <string>

namespace wingspread {

/// Reasons beyond this many, the rarest, are counted together: `reasons_omitted` holds their runs,
/// and `latch_order_omitted` those of the latch orders that the summary does not list.
inline constexpr std::size_t most_reasons = 100;
/// Of the runs that break a requirement the worst, up to this many; `broken_omitted` counts others.
inline constexpr std::size_t most_broken = 1000;

/// summary.json.
/// @param about what the caller says of the campaign and the program; the value of "wingspread".
[[nodiscard]] Json summary_json(const Summary& summary, const Json& about);

/// What the integration contributes, its key `accuracy`; null where nobody measured it.
[[nodiscard]] Json accuracy_json(const Summary& summary);

/// histograms.json: per output its unit, count, missing, edges, counts and density.
[[nodiscard]] Json histograms_json(const Summary& summary);

/// histograms.csv: `output,lower,upper,count,density`, a line per bin.
[[nodiscard]] std::string histograms_csv(const Summary& summary);

} // namespace wingspread
