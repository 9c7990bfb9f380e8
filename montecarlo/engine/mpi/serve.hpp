/// The loop of every rank but rank 0: makes the runs that rank 0 asks for.
#pragma once

#include "montecarlo/engine/mpi/transport.hpp"
#include "montecarlo/engine/runs/run_plan.hpp"

#include <atomic>

namespace wingspread {

/// Makes the chunks of one plan after the other until rank 0 says that the job is done.
/// @param make_measure rebuilds the measures of plans (run_plan.hpp)
/// @param stop once true (a signal to this rank), no further run begins, and rank 0 is told
void serve(Transport& transport, const MeasureMaker& make_measure, const std::atomic<bool>& stop);

} // namespace wingspread
