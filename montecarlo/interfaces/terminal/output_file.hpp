/// Checks of the files and folders on the command line: protects input files from --out.
#pragma once

#include <filesystem>
#include <vector>

namespace wingspread {

/// Refuses a file for `--out` that would overwrite input or results: a file that the command reads, or that a text of
/// its campaign or scene names (a scene, the table or the rows of a dispersion); any JSON file, because scenes and
/// campaigns are JSON files; a file of any results folder. A link counts as the file to which it leads.
/// @param out  the file; may be empty
/// @param read the files and results folders that the command reads
/// @throws SpecError that names the option
void refuse_overwriting(const std::filesystem::path& out,
                        const std::vector<std::filesystem::path>& read,
                        const char* option = "--out");

/// Refuses a folder that is given twice, under the same name or another (a link, "r" and "./r"), and the folder to
/// write among them.
/// @param out may be empty
/// @throws SpecError that names the folder, before any is locked
void refuse_repeated(const std::vector<std::filesystem::path>& folders,
                     const std::filesystem::path& out = {});

} // namespace wingspread
