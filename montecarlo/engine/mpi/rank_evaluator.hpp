/// The ranks of a job, as what makes the runs of a command.
#pragma once

#include "montecarlo/engine/mpi/transport.hpp"
#include "montecarlo/engine/runs/evaluator.hpp"

#include <memory>

namespace wingspread {

/// Rank 0's. It hands out chunks to the ranks that ask for them, makes others with its own threads, and puts all in
/// order; the sink is called on this rank alone. A plan that cannot be told to others it makes by itself.
class RankEvaluator final : public Evaluator {
public:
  /// @param stop once true, no further run is begun on any rank
  RankEvaluator(std::unique_ptr<Transport> transport, ThreadPool pool,
                const std::atomic<bool>& stop)
      : transport_(std::move(transport)), pool_(pool), stop_(stop) {}

  /// @throws besides, MachineError for what goes wrong on another rank
  long make(const RunPlan& plan, RunRange range, const BatchSink& sink) override;

  [[nodiscard]] const Occupancy& occupancy() const override { return occupancy_; }
  [[nodiscard]] int ranks() const override { return transport_->size(); }

private:
  std::unique_ptr<Transport> transport_;
  ThreadPool pool_;
  const std::atomic<bool>& stop_;
  Occupancy occupancy_{};
};

/// Tells all others that the job is done: serve() returns there. For rank 0.
void dismiss(Transport& transport);

} // namespace wingspread
