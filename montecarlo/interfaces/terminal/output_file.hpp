/// The file that a command is asked to write.
#pragma once

#include <filesystem>
#include <vector>

namespace wingspread {

/// Refuses a file for `--out` in whose place something would be lost that nobody can make again: one that is read, also
/// because a campaign names it (its scene, the table of an empirical law), any JSON file (scenes and campaigns are such,
/// and no command writes one), and what a results folder consists of.
/// @param out  where to; empty: nowhere
/// @param read files, and results folders
/// @throws SpecError that names --out
void refuse_overwriting(const std::filesystem::path& out,
                        const std::vector<std::filesystem::path>& read);

} // namespace wingspread
