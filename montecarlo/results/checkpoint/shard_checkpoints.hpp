/// Takes the runs of analyses from the checkpoints of shards, made on other machines.
#pragma once

#include "montecarlo/results/checkpoint/checkpoint.hpp"
#include "montecarlo/results/results_folder/parts.hpp"

#include <atomic>
#include <deque>
#include <filesystem>
#include <utility>
#include <vector>

namespace wingspread {

/// The file written last into a finished shard of a study. A shard holds its part of each analysis that does not depend
/// on results of other analyses.
inline constexpr const char* shard_file = "shard.json";

/// Delivers an analysis from the shards, one shard's part after the other, if all shards have it next in their
/// checkpoints. `inner` makes the runs of all other analyses.
class ShardCheckpoints final : public Evaluator {
public:
  /// @param folders of the shards, in any order; none: `inner` makes everything
  /// @param about   identity of the study (checkpoint.hpp); a shard's identity also has the shard in its stamp
  /// @param runs    number of runs of an analysis
  /// @param maker   command for missing shards, for the error message
  /// @param inner   makes the analyses that the shards do not have
  /// @throws MissingRuns (parts.hpp) if shards are missing or unfinished, SpecError if they are no shards of this
  ///   study
  ShardCheckpoints(const std::vector<std::filesystem::path>& folders, const Json& about, long runs,
                   const ShardMaker& maker, Evaluator& inner, const std::atomic<bool>& stop);

  /// @throws what `inner` and Checkpoint::enter() throw; SpecError if a shard lacks rows
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
