/// Sends a plan to another process, which rebuilds it from its description.
#pragma once

#include "montecarlo/engine/mpi/messages.hpp"

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace wingspread {

/// @return nothing if the plan cannot be rebuilt: its measure has no recipe
[[nodiscard]] std::optional<PlanDescription> describe(const RunPlan& plan, const ThreadPool& pool,
                                                      bool wants_csv);

/// A plan rebuilt from its description. Its runs have the same bits.
class PlanCopy {
public:
  /// @param make_measure builds the plan's measure, if it has one
  /// @throws SpecError, and what `make_measure` throws
  PlanCopy(PlanDescription description, const MeasureMaker& make_measure);
  PlanCopy(const PlanCopy&) = delete;
  PlanCopy& operator=(const PlanCopy&) = delete;
  ~PlanCopy() = default;

  [[nodiscard]] const PlanDescription& description() const { return description_; }
  [[nodiscard]] const RunPlan& plan() const { return *plan_; }
  /// The thread pool asked for, with instructions that this processor has.
  [[nodiscard]] ThreadPool pool() const;

  /// Reads the points that follow a chunk in its message, if the plan has its own, and stores them. On any thread.
  void expect(const Chunk& chunk, Deserializer& message);
  /// Drops the points of a finished chunk. On any thread.
  void forget(const Chunk& chunk);

private:
  struct Points {
    RunRange runs;
    std::vector<Tails> u; ///< run by run
  };
  void place(long run, std::span<Tails> u) const;

  PlanDescription description_;
  Campaign campaign_;
  mutable std::mutex guard_;
  std::map<long, Points> points_; ///< by first run of the chunk; guarded
  std::optional<RunPlan> plan_;
};

} // namespace wingspread
