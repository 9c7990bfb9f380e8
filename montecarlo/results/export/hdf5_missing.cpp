/// Replaces hdf5_export.cpp in a program built without HDF5.
#include "montecarlo/foundation/formats/machine_error.hpp"
#include "montecarlo/results/export/hdf5_export.hpp"

namespace wingspread {

bool has_hdf5() { return false; }

void export_hdf5(const std::filesystem::path& /*folder*/, const std::filesystem::path& /*file*/) {
  throw MachineError("this wingspread: found no HDF5 in it, expected one that was built with "
                     "Debian's package libhdf5-dev: install it, then configure and build again");
}

} // namespace wingspread
