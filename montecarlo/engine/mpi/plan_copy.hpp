/// A plan that goes to another process: told in words, and made again of them.
#pragma once

#include "montecarlo/engine/mpi/messages.hpp"

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace wingspread {

/// @return none of a plan that cannot be told: its measure has no recipe
[[nodiscard]] std::optional<PlanDescription> describe(const RunPlan& plan, const ThreadPool& pool,
                                                      bool wants_csv);

/// The plan again, made of its description. Its runs have the bits of the first one's.
class PlanCopy {
public:
  /// @param make_measure makes the plan's measure, if it has one
  /// @throws SpecError, and what `make_measure` throws
  PlanCopy(PlanDescription description, const MeasureMaker& make_measure);
  PlanCopy(const PlanCopy&) = delete;
  PlanCopy& operator=(const PlanCopy&) = delete;
  ~PlanCopy() = default;

  [[nodiscard]] const PlanDescription& description() const { return description_; }
  [[nodiscard]] const RunPlan& plan() const { return *plan_; }
  /// The pool that it asks for, with the instructions that this processor has.
  [[nodiscard]] ThreadPool pool() const;

  /// Takes the points of a chunk that has come, behind it in the message; and forgets them when it is done. On any thread.
  void expect(const Chunk& chunk, Deserializer& message);
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
  std::map<long, Points> points_; ///< by the first run of their chunk; guarded
  std::optional<RunPlan> plan_;
};

} // namespace wingspread
