/// A results folder as HDF5. README.md of this room describes the file.
#pragma once

#include <filesystem>

namespace wingspread {

/// Whether the program was built with HDF5.
[[nodiscard]] bool has_hdf5();

/// Writes the rows of a results folder, or of all cases, replacing an existing file. Reads the rows twice, because
/// HDF5 needs the length of texts first. Memory: 32 MiB and what HDF5 takes, for any number of rows.
/// @throws SpecError if the folder is broken or has no file of rows; MachineError if the program has no HDF5, or the
///   file cannot be written
void export_hdf5(const std::filesystem::path& folder, const std::filesystem::path& file);

} // namespace wingspread
