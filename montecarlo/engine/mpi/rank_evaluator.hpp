/// The evaluator that uses all ranks of an MPI job.
#pragma once

#include "montecarlo/engine/mpi/transport.hpp"
#include "montecarlo/engine/runs/evaluator.hpp"

#include <memory>

namespace wingspread {

/// Rank 0's evaluator. Sends chunks to the ranks that ask for them, makes others with its own threads, and puts all
/// in order. Only rank 0 calls the sink. The runs of a plan that cannot be described (its measure has no recipe) are
/// made on rank 0 alone.
class RankEvaluator final : public Evaluator {
public:
  /// @param stop once true, no further run begins on any rank
  RankEvaluator(std::unique_ptr<Transport> transport, ThreadPool pool,
                const std::atomic<bool>& stop)
      : transport_(std::move(transport)), pool_(pool), stop_(stop) {}

  /// @throws as Evaluator::make(); MachineError for an error on another rank
  long make(const RunPlan& plan, RunRange range, const BatchSink& sink) override;

  [[nodiscard]] const Occupancy& occupancy() const override { return occupancy_; }
  [[nodiscard]] int ranks() const override { return transport_->size(); }

private:
  std::unique_ptr<Transport> transport_;
  ThreadPool pool_;
  const std::atomic<bool>& stop_;
  Occupancy occupancy_{};
};

/// Tells all other ranks that the job is done, so that serve() returns there. On rank 0.
void dismiss(Transport& transport);

} // namespace wingspread
