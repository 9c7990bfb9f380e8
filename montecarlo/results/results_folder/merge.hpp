/// Shards put together again.
#pragma once

#include "montecarlo/results/summary/comparison.hpp"
#include "montecarlo/results/summary/summary.hpp"

#include <filesystem>
#include <vector>

namespace wingspread {

enum class MergeKind {
  whole, ///< all runs have to be there
  preview ///< any of them: what is written says so (Stamp::preview), and is taken for the whole by nothing
};

/// Writes the folder that running the whole campaign at once would have written, byte for byte; a preview of it
/// has the rows that there are. Its rows are read one at a time: what grows with their number are the statistics'
/// columns alone.
/// @param folders of one campaign, seed and version, in any order, with each run in one of them; in none for a preview
/// @param out     new or empty, or an earlier preview
/// @throws MissingRuns (parts.hpp) when runs are missing, SpecError with all else that keeps them from being merged;
///   then nothing is written
Summary merge_folders(const std::vector<std::filesystem::path>& folders,
                      const std::filesystem::path& out, MergeKind kind = MergeKind::whole);

/// The same for folders of a campaign with cases: those of each case into one, and cases.json.
std::vector<CaseSummary> merge_cases(const std::vector<std::filesystem::path>& folders,
                                     const std::filesystem::path& out,
                                     MergeKind kind = MergeKind::whole);

} // namespace wingspread
