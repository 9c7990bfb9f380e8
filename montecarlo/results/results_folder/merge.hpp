/// Merges shards.
#pragma once

#include "montecarlo/results/summary/comparison.hpp"
#include "montecarlo/results/summary/summary.hpp"

#include <filesystem>
#include <vector>

namespace wingspread {

enum class MergeKind {
  whole,  ///< all runs must be there
  preview ///< merges the runs that are there, and labels the result (Stamp::preview)
};

/// Writes the folder that running the whole campaign at once would write, byte for byte. A preview has the rows that
/// exist. Rows are copied one at a time; the columns for the statistics may lie in temporary files.
/// @param folders of one campaign, seed and version, in any order; each run is in exactly one, or for a preview in at
///   most one
/// @param out     new or empty, or an earlier preview
/// @throws MissingRuns (parts.hpp) if runs are missing, SpecError for any other obstacle; in both cases nothing is
///   written
Summary merge_folders(const std::vector<std::filesystem::path>& folders,
                      const std::filesystem::path& out, MergeKind kind = MergeKind::whole);

/// As merge_folders for a campaign with cases: merges each case, and writes cases.json.
std::vector<CaseSummary> merge_cases(const std::vector<std::filesystem::path>& folders,
                                     const std::filesystem::path& out,
                                     MergeKind kind = MergeKind::whole);

} // namespace wingspread
