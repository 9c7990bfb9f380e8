/// Shards put together again.
#pragma once

#include "montecarlo/summary/comparison.hpp"
#include "montecarlo/summary/summary.hpp"

#include <filesystem>
#include <vector>

namespace wingspread {

/// Writes the folder that running the whole campaign at once would have written, byte for byte.
/// @param folders of one campaign, seed and version, in any order, with each run in one of them
/// @param out     new or empty
/// @throws SpecError with all that keeps them from being merged, and nothing written
Summary merge_folders(const std::vector<std::filesystem::path>& folders,
                      const std::filesystem::path& out);

/// The same for folders of a campaign with cases: those of each case into one, and cases.json.
std::vector<CaseSummary> merge_cases(const std::vector<std::filesystem::path>& folders,
                                     const std::filesystem::path& out);

} // namespace wingspread
