/// The interface through which `run`, `margin`, `sensitivity`, `rare` and `fit` make the runs of a plan.
#pragma once

#include "montecarlo/engine/runs/runner.hpp"

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

/// Consecutive finished runs.
struct Batch {
  std::vector<ResultRow> rows;
  std::string csv; ///< the rows as lines of runs.csv, if the sink wants them
};

/// Receives batches, one at a time and in the order of their runs, on any thread.
struct BatchSink {
  std::function<void(const Batch&)> take;
  bool wants_csv = false; ///< Batch::csv is filled, by the threads that make the runs
};

/// Makes runs. The rows and their order do not depend on the number of threads or processes.
class Evaluator {
public:
  Evaluator() = default;
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;
  virtual ~Evaluator() = default;

  /// Makes the runs of a range and delivers them to the sink without a gap.
  /// @return runs delivered; fewer than the range only after a stop
  /// @throws what the sink throws, and what a run throws (out of memory). Batches delivered before have no gap.
  virtual long make(const RunPlan& plan, RunRange range, const BatchSink& sink) = 0;

  /// How full the lanes were in all runs made so far.
  [[nodiscard]] virtual const Occupancy& occupancy() const = 0;

  /// Number of processes that make runs.
  [[nodiscard]] virtual int ranks() const { return 1; }
};

/// The threads of a process and the instructions they use.
struct ThreadPool {
  int threads = 0;                                ///< 0: as many as OpenMP offers
  InstructionSet set = instruction_sets().back(); ///< decides how many runs a thread makes at once
};

/// Makes runs on the threads of this process. Threads claim chunks from a RangeQueue, which delivers finished chunks in
/// order. A thread waits only while the next chunk is too far ahead of the oldest unfinished one.
class ThreadEvaluator final : public Evaluator {
public:
  /// @param stop once true, no further run begins; finished runs before the first missing one are still delivered
  ThreadEvaluator(ThreadPool pool, const std::atomic<bool>& stop) : pool_(pool), stop_(stop) {}

  long make(const RunPlan& plan, RunRange range, const BatchSink& sink) override;

  [[nodiscard]] const Occupancy& occupancy() const override { return occupancy_; }

private:
  ThreadPool pool_;
  const std::atomic<bool>& stop_;
  Occupancy occupancy_{};
};

} // namespace wingspread
