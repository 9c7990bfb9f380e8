/// The wire of a job that mpirun has started.
#pragma once

#include "montecarlo/engine/mpi/wire.hpp"

#include <memory>

namespace wingspread {

/// @pre MPI is initialised, and this is the thread that has done it
[[nodiscard]] std::unique_ptr<Wire> mpi_wire();

} // namespace wingspread
