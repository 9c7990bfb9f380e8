/// All runs of a campaign, on all processors.
///
/// Threads claim chunks of runs from a counter, so none waits for another, and fill their lanes
/// from them without a pause. Finished chunks are handed on in the order of their runs: what is
/// written never depends on who was first.
#pragma once

#include "montecarlo/runs/run.hpp"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace wingspread {

/// The runs first, first + 1, … last − 1.
struct RunRange {
  long first = 0, last = 0;
  [[nodiscard]] long size() const { return last - first; }
  bool operator==(const RunRange&) const = default;
};

/// Consecutive runs, done.
struct Batch {
  std::vector<ResultRow> rows;
  std::string csv; ///< their lines of runs.csv
};

/// Takes batches, one at a time and in the order of their runs, on any of the team's threads.
using BatchSink = std::function<void(const Batch&)>;

/// Makes the runs of a range and hands them to the sink without a gap.
///
/// @param threads 0: as many as OpenMP offers
/// @param set     how many runs a thread makes at once; the rows do not depend on it
/// @param lanes   how full the lanes were, added up; null: not wanted
/// @param stop    once true, no further run is begun; what is done up to the first run that is
///                missing is still handed on
/// @return how many runs were handed on; fewer than the range has only when stopped
/// Throws what the sink throws, and what a run does (out of memory); then too the sink has had all
/// batches up to there.
long make_runs(const RunPlan& plan, RunRange range, int threads, const std::atomic<bool>& stop,
               const BatchSink& sink, InstructionSet set = instruction_sets().back(),
               Occupancy* lanes = nullptr);

} // namespace wingspread
