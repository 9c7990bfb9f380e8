/// Looks of which the shards of a study were made before, on other machines.
#pragma once

#include "montecarlo/results/checkpoint/checkpoint.hpp"
#include "montecarlo/results/results_folder/parts.hpp"

#include <atomic>
#include <deque>
#include <filesystem>
#include <utility>
#include <vector>

namespace wingspread {

/// A study's shard: its part of the runs of those looks that do not depend on what others came to. Written last.
inline constexpr const char* shard_file = "shard.json";

/// Hands on looks that all shards have, each its part of the runs, and has the others made.
class ShardCheckpoints final : public Evaluator {
public:
  /// @param folders the shards', in any order; none: all looks are made
  /// @param about   whose study it is (checkpoint.hpp): each shard's is the same with the shard in its stamp
  /// @param runs    of a look
  /// @param inner   makes what they have not
  /// @throws MissingRuns (parts.hpp) when shards are missing or not finished, SpecError when they are no shards of
  ///   this study
  ShardCheckpoints(const std::vector<std::filesystem::path>& folders, const Json& about, long runs,
                   const ShardMaker& maker, Evaluator& inner, const std::atomic<bool>& stop);

  /// @throws besides what `inner` does, SpecError when a shard's rows do not come out the same here
  long make(const RunPlan& plan, RunRange range, const BatchSink& sink) override;
  [[nodiscard]] const Occupancy& occupancy() const override { return inner_.occupancy(); }
  /// How many rows the shards gave.
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

/// The part of a look's runs that is a shard's.
[[nodiscard]] RunRange part_of_analysis(RunRange range, const Shard& shard);

/// Whether the folder is that of a study's shard, finished or not.
[[nodiscard]] bool is_shard_folder(const std::filesystem::path& folder);

} // namespace wingspread
