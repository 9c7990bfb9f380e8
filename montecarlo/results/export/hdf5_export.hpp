/// A results folder as HDF5: README.md of this room says what is in the file.
#pragma once

#include <filesystem>

namespace wingspread {

/// Whether the program was built with HDF5.
[[nodiscard]] bool has_hdf5();

/// Writes the rows of a results folder, or those of all cases of one, in place of what was there.
///
/// The rows are read twice: how long their texts are has to be known first. Memory: 32 MiB and what HDF5 takes, however
/// many rows there are.
/// @throws SpecError when the folder is broken or has no rows' file; MachineError where the program has no HDF5, and
///   when the file cannot be written
void export_hdf5(const std::filesystem::path& folder, const std::filesystem::path& file);

} // namespace wingspread
