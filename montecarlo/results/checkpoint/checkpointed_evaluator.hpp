/// An evaluator that takes rows from a checkpoint first, then makes the rest and records them.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/results/checkpoint/checkpoint.hpp"

#include <atomic>

namespace wingspread {

/// Delivers the same rows however many of them the checkpoint has.
class CheckpointedEvaluator final : public Evaluator {
public:
  /// @param inner makes the runs that the checkpoint does not have
  /// @param stop  once true, no more rows are read from the checkpoint
  /// @pre all arguments outlive this object
  CheckpointedEvaluator(Evaluator& inner, Checkpoint& log, const std::atomic<bool>& stop)
      : inner_(inner), log_(log), stop_(stop) {}

  /// @throws what `inner` and the checkpoint throw
  long make(const RunPlan& plan, RunRange range, const BatchSink& sink) override;
  [[nodiscard]] const Occupancy& occupancy() const override { return inner_.occupancy(); }

private:
  Evaluator& inner_;
  Checkpoint& log_;
  const std::atomic<bool>& stop_;
};

} // namespace wingspread
