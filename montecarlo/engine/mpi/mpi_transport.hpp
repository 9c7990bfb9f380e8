/// The transport of a job that mpirun has started.
#pragma once

#include "montecarlo/engine/mpi/transport.hpp"

#include <memory>

namespace wingspread {

/// @pre MPI is initialised, and this is the thread that has done it
[[nodiscard]] std::unique_ptr<Transport> mpi_transport();

} // namespace wingspread
