/// Creates the evaluator of a command.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"

#include <atomic>
#include <memory>

namespace wingspread {

/// The evaluator of `run`, `margin`, `sensitivity`, `rare` and `fit`. It uses the threads of this process or, in the
/// MPI program started by mpirun, the threads of all ranks. Both deliver the same rows.
/// @param stop once true, no further run begins; outlives the evaluator
[[nodiscard]] std::unique_ptr<Evaluator> evaluator_of(const ThreadPool& pool,
                                                      const std::atomic<bool>& stop);

} // namespace wingspread
