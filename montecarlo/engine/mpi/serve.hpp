/// What every rank but the first does: it makes the runs that rank 0 asks for.
#pragma once

#include "montecarlo/engine/mpi/transport.hpp"
#include "montecarlo/engine/runs/run_plan.hpp"

#include <atomic>

namespace wingspread {

/// Makes the chunks of one plan after the other, until it is told that the job is done.
/// @param make_measure makes the measures that plans of other processes have (run_plan.hpp)
/// @param stop once true (a signal of its own), no further run is begun, and rank 0 is told
void serve(Transport& transport, const MeasureMaker& make_measure, const std::atomic<bool>& stop);

} // namespace wingspread
