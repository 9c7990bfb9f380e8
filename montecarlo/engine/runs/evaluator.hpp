/// All runs of a plan, whoever makes them: the one way in which `run`, `margin`, `sensitivity` and
/// `rare` have their runs made.
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

/// Consecutive runs, done.
struct Batch {
  std::vector<ResultRow> rows;
  std::string csv; ///< their lines of runs.csv, where they are wanted
};

/// Takes batches, one at a time and in the order of their runs, on any of the team's threads.
struct BatchSink {
  std::function<void(const Batch&)> take;
  bool wants_csv = false; ///< lines are made by the threads that make the runs
};

/// Makes runs. What it hands on does not depend on how, or by how many, they are made.
class Evaluator {
public:
  Evaluator() = default;
  Evaluator(const Evaluator&) = delete;
  Evaluator& operator=(const Evaluator&) = delete;
  virtual ~Evaluator() = default;

  /// Makes the runs of a range and hands them to the sink without a gap.
  /// @return how many runs were handed on; fewer than the range has only when it was stopped
  /// @throws what the sink throws, and what a run does (out of memory); then too the sink has had
  ///   all batches up to there
  virtual long make(const RunPlan& plan, RunRange range, const BatchSink& sink) = 0;

  /// How full the lanes were, in all that it has made.
  [[nodiscard]] virtual const Occupancy& occupancy() const = 0;

  /// How many processes make them.
  [[nodiscard]] virtual int ranks() const { return 1; }
};

/// How this machine makes them.
struct ThreadPool {
  int threads = 0;                                ///< 0: as many as OpenMP offers
  InstructionSet set = instruction_sets().back(); ///< how many runs a thread makes at once
};

/// Threads of this process. They claim chunks of runs from a counter, so none waits for another, and
/// fill their lanes from them without a pause; finished chunks are put in order before they are
/// handed on.
class ThreadEvaluator final : public Evaluator {
public:
  /// @param stop once true, no further run is begun; what is done up to the first run that is
  ///   missing is still handed on
  ThreadEvaluator(ThreadPool pool, const std::atomic<bool>& stop) : pool_(pool), stop_(stop) {}

  long make(const RunPlan& plan, RunRange range, const BatchSink& sink) override;

  [[nodiscard]] const Occupancy& occupancy() const override { return occupancy_; }

private:
  ThreadPool pool_;
  const std::atomic<bool>& stop_;
  Occupancy occupancy_{};
};

} // namespace wingspread
