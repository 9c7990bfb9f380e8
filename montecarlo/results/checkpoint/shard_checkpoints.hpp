/// Analyses whose runs were made before in shards, on other machines.
#pragma once

#include "montecarlo/results/checkpoint/checkpoint.hpp"
#include "montecarlo/results/results_folder/parts.hpp"

#include <atomic>
#include <deque>
#include <filesystem>
#include <utility>
#include <vector>

namespace wingspread {

/// Written last in a study's shard. A shard holds its part of those analyses that do not depend on other results.
inline constexpr const char* shard_file = "shard.json";

/// Delivers the analyses that all shards have, each shard's part in turn; `inner` makes the others.
class ShardCheckpoints final : public Evaluator {
public:
  /// @param folders the shards', in any order; none: `inner` makes everything
  /// @param about   which study it is (checkpoint.hpp); a shard has the same with the shard in its stamp
  /// @param runs    of an analysis
  /// @param inner   makes what the shards do not have
  /// @throws MissingRuns (parts.hpp) if shards are missing or unfinished, SpecError if they are no shards of this
  ///   study
  ShardCheckpoints(const std::vector<std::filesystem::path>& folders, const Json& about, long runs,
                   const ShardMaker& maker, Evaluator& inner, const std::atomic<bool>& stop);

  /// @throws what `inner` throws, and SpecError if a shard's draws differ on this machine
  long make(const RunPlan& plan, RunRange range, const BatchSink& sink) override;
  [[nodiscard]] const Occupancy& occupancy() const override { return inner_.occupancy(); }
  /// Rows that the shards supplied.
  [[nodiscard]] long read() const { return read_; }

private:
  struct ShardLog {
    ShardLog(Shard of, const std::filesystem::path& file, Json about)
        : shard(of), log(file, std::move(about)) {}
    Shard shard;
    Checkpoint log;
  };

  [[nodiscard]] bool have(const RunPlan& plan, RunRange range) const;

  std::deque<ShardLog> shards_; ///< in order
  Evaluator& inner_;
  const std::atomic<bool>& stop_;
  long read_ = 0;
};

/// A shard's part of the runs of an analysis.
[[nodiscard]] RunRange part_of_analysis(RunRange range, const Shard& shard);

/// Whether the folder holds a study's shard, finished or not.
[[nodiscard]] bool is_shard_folder(const std::filesystem::path& folder);

} // namespace wingspread
