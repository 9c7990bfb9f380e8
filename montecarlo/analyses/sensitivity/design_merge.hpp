/// Merges the shards of a design for Sobol' indices.
#pragma once

#include "montecarlo/analyses/sensitivity/design_folder.hpp"

#include <filesystem>
#include <vector>

namespace wingspread {

/// Writes design.json and design_runs.csv, byte for byte as one process would. Reads one row at a time.
/// @param folders of one design and version, in any order, with each run in one of them
/// @param out     new or empty
/// @throws MissingRuns (parts.hpp) when runs are missing, SpecError with all other obstacles; then nothing is written
void merge_designs(const std::vector<std::filesystem::path>& folders,
                   const std::filesystem::path& out);

} // namespace wingspread
