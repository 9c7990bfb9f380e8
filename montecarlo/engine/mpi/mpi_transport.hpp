/// The transport of a job that mpirun started.
#pragma once

#include "montecarlo/engine/mpi/transport.hpp"

#include <memory>

namespace wingspread {

/// @pre MPI was initialised by this thread
[[nodiscard]] std::unique_ptr<Transport> mpi_transport();

} // namespace wingspread
