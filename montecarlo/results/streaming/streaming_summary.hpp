/// The summary of streaming statistics.
#pragma once

#include "montecarlo/results/results_folder/results_folder.hpp"
#include "montecarlo/results/streaming/streaming_statistics.hpp"

#include <string>

namespace wingspread {

/// The summary that stored_summary (results_folder.hpp) would compute from rows. Counts, extremes and decisions are
/// equal; moments agree up to rounding. A quantile that is not among the extremes has an error estimate. Its bounds,
/// and tolerance limits, lie at the outer edges of bins: they hold with no less confidence and are slightly wider.
/// Spearman's correlation and the accuracy are left out.
[[nodiscard]] Summary streaming_summary(const StoredCampaign& stored,
                                        const StreamingStatistics& statistics,
                                        const StatisticsSpec& spec);

/// extremes.csv: `output,end,rank,run,value`, a line for each kept value, the most extreme first.
[[nodiscard]] std::string extremes_csv(const ResultNames& names,
                                       const StreamingStatistics& statistics);

} // namespace wingspread
