/// Who makes the runs of a command.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"

#include <atomic>
#include <memory>

namespace wingspread {

/// What makes the runs of `run`, `margin`, `sensitivity` and `rare`: the threads of this process or, of the program
/// that was built with MPI and started by mpirun, those of all its ranks. What it hands on is the same.
/// @param stop once true, no further run is begun; it outlives the evaluator
[[nodiscard]] std::unique_ptr<Evaluator> evaluator_of(const ThreadPool& pool,
                                                      const std::atomic<bool>& stop);

} // namespace wingspread
