/// The files of the statistics: summary.json, histograms.json, histograms.csv.
///
/// A value that is undefined or did not happen is null (json.hpp). summary.json names every definition it uses.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/results/summary/summary.hpp"

#include <string>

namespace wingspread {

/// Most reasons listed, the most frequent ones. `reasons_omitted` counts the runs with other reasons,
/// `latch_order_omitted` the runs with latch orders that the summary does not list.
inline constexpr std::size_t most_reasons = 100;
/// For each requirement, most runs listed that break it, the worst ones; `broken_omitted` counts the others.
inline constexpr std::size_t most_broken = 1000;

/// summary.json.
/// @param about campaign and program: the value of "wingspread"
[[nodiscard]] Json summary_json(const Summary& summary, const Json& about);

/// What a definition of bounds adds where several analyses share the risk: ", at a confidence of 0.975: of analysis 2 …"; or
/// empty. @param confidence of the campaign
[[nodiscard]] std::string over_interim_analyses(const InterimAnalyses& interim, double confidence);

/// The value of summary.json's key `accuracy`; null if not measured.
[[nodiscard]] Json accuracy_json(const Summary& summary);

/// histograms.json: per output its unit, count, missing, edges, counts and density.
[[nodiscard]] Json histograms_json(const Summary& summary);

/// histograms.csv: `output,lower,upper,count,density`, a line per bin.
[[nodiscard]] std::string histograms_csv(const Summary& summary);

} // namespace wingspread
