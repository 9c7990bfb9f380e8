/// timing.json: what one session did, and on which machine.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/foundation/platform/progress.hpp"
#include "montecarlo/results/summary/summary.hpp"

#include <filesystem>

namespace wingspread {

/// How long a session took to make runs.
struct SessionTiming {
  RunCounts counts;   ///< at its end
  double seconds = 0; ///< wall time
  bool interrupted = false;
};

/// Writes timing.json into a results folder: host, threads, instruction set, lane occupancy, runs and seconds.
/// @throws MachineError if it cannot be written
void write_timing(const std::filesystem::path& folder, const SessionTiming& timing,
                  const ThreadPool& pool, const Evaluator& evaluator);

/// Adds to timing.json how many runs and seconds the accuracy estimate took; does nothing if the summary has none.
void add_accuracy_timing(const std::filesystem::path& folder, const Summary& summary);

} // namespace wingspread
