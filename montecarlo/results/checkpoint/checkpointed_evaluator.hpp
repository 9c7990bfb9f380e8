/// Runs out of a log as far as it goes; then made, and logged.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/results/checkpoint/checkpoint.hpp"

#include <atomic>

namespace wingspread {

/// What it hands on does not depend on how much of it was in the log.
class CheckpointedEvaluator final : public Evaluator {
public:
  /// @param inner makes what is not in the log
  /// @param stop  once true, nothing more is read of it
  /// @pre all of them outlive it
  CheckpointedEvaluator(Evaluator& inner, Checkpoint& log, const std::atomic<bool>& stop)
      : inner_(inner), log_(log), stop_(stop) {}

  /// @throws besides what `inner` does, what the log does
  long make(const RunPlan& plan, RunRange range, const BatchSink& sink) override;
  [[nodiscard]] const Occupancy& occupancy() const override { return inner_.occupancy(); }

private:
  Evaluator& inner_;
  Checkpoint& log_;
  const std::atomic<bool>& stop_;
};

} // namespace wingspread
