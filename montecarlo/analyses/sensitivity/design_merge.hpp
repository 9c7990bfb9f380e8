/// Merges the shards of a design for Sobol' indices.
#pragma once

#include "montecarlo/analyses/sensitivity/design_folder.hpp"

#include <filesystem>
#include <vector>

namespace wingspread {

/// Writes design.json and design_runs.csv, byte for byte as one process would. Reads one row at a time.
/// @param folders folders of one design and version, in any order; together they have each run exactly once
/// @param out     new or empty, or an interrupted merge of the same design, without its tables
/// @throws MissingRuns (parts.hpp) if runs are missing, SpecError for all other obstacles; then nothing is written
void merge_designs(const std::vector<std::filesystem::path>& folders,
                   const std::filesystem::path& out);

} // namespace wingspread
