/// The files of the statistics: summary.json, histograms.json, histograms.csv.
///
/// Strict JSON: what is undefined or did not happen is null, never NaN or Infinity; numbers have as
/// many digits as it takes to read back the same double. Every definition in use is named in it.
#pragma once

#include "montecarlo/summary/summary.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace wingspread {

/// Reasons beyond this many, the rarest, are counted together: `reasons_omitted` holds their runs,
/// and `latch_order_omitted` those of the latch orders that the summary does not list.
inline constexpr std::size_t most_reasons = 100;
/// Of the runs that break a requirement the worst, up to this many; `broken_omitted` counts others.
inline constexpr std::size_t most_broken = 1000;

/// summary.json.
/// @param about what the caller says of the campaign and the program; the value of "wingspread".
[[nodiscard]] nlohmann::ordered_json summary_json(const Summary& summary,
                                                  const nlohmann::ordered_json& about);

/// histograms.json: per output its unit, count, missing, edges, counts and density.
[[nodiscard]] nlohmann::ordered_json histograms_json(const Summary& summary);

/// histograms.csv: `output,lower,upper,count,density`, a line per bin.
[[nodiscard]] std::string histograms_csv(const Summary& summary);

/// The text of a JSON file, indented by two and ended by a line feed. Bytes that are not UTF-8 (in
/// a reason read from a foreign file, say) become U+FFFD.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json);

} // namespace wingspread
