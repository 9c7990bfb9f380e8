/// The statistics of runs whose rows are not there.
#pragma once

#include "montecarlo/results/results_folder/results_folder.hpp"
#include "montecarlo/results/streaming/streaming_statistics.hpp"

#include <string>

namespace wingspread {

/// What the runs come to, as stored_summary (results_folder.hpp) has it of rows. Counts, moments, extremes and verdicts are
/// the same but for rounding; a quantile that is not among the extremes says how far off it may be, and its bounds, and those
/// of tolerance limits, are taken at the outer edges of the bins that they lie in: they hold no less, and are a little wider.
/// There is no Spearman's correlation, and no accuracy.
[[nodiscard]] Summary streaming_summary(const StoredCampaign& stored,
                                        const StreamingStatistics& statistics,
                                        const StatisticsSpec& spec);

/// extremes.csv: `output,end,rank,run,value`, a line for each value that is kept, from the end inwards.
[[nodiscard]] std::string extremes_csv(const ResultNames& names,
                                       const StreamingStatistics& statistics);

} // namespace wingspread
