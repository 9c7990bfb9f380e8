/// The results folder of a campaign that is being run.
#pragma once

#include "montecarlo/foundation/platform/folder_lock.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"
#include "montecarlo/results/results_folder/row_writer.hpp"

namespace wingspread {

/// Grows runs.csv batch by batch, and keeps the rows for the statistics. A folder that was left at
/// any moment, by a signal or a crash, can be opened again to be continued.
class FolderWriter {
public:
  static constexpr bool wants_csv = true; ///< of the batches that it takes

  /// Opens the folder, and makes it with its campaign.json if it is not there. No other process may open it as
  /// long as this is not destroyed.
  ///
  /// To resume: the folder is new, or has the same campaign, seed, shard and version; what was cut
  /// off at the end of runs.csv is taken away. Not to resume: it is new, or empty. A campaign that
  /// may stop has no shards: only all runs up to a checkpoint can tell.
  ///
  /// A campaign may be resumed with more runs than it had, unless its draws or checkpoints depend on
  /// their number: its results were seen, so that this is one more look at the same draws, and is
  /// noted in campaign.json (Sampling::extended_from). The folder becomes the one that this campaign
  /// gives in one go.
  /// @throws SpecError otherwise, with nothing written; MachineError when another process has it, or it cannot
  ///   be written
  FolderWriter(std::filesystem::path folder, const RunPlan& plan, const std::optional<Shard>& shard,
               bool resume);

  /// The next runs to be made: all that are left or, of a campaign that may stop, those up to the
  /// next checkpoint. None when it is complete. Cost: at a checkpoint, that of its statistics.
  [[nodiscard]] RunRange remaining() const;
  [[nodiscard]] const StoredCampaign& stored() const { return stored_; }
  /// @throws MachineError when there was no room for them in memory and its temporary files
  [[nodiscard]] const Results& results() const { return rows_.results(); }
  /// How many runs are in the file.
  [[nodiscard]] long count() const { return rows_.count(); }

  /// Adds the next runs, to the file and to memory. @throws MachineError when they cannot be written
  void add(const Batch& batch) { rows_.add(batch); }
  /// All rows are on the device, and the file is closed. Once, behind the last batch.
  void finish() { rows_.finish(); }

private:
  /// Takes over what is there, and notes when it is extended.
  void go_on(const RunPlan& plan);

  StoredCampaign stored_;
  RowWriter rows_;
  std::optional<FolderLock> lock_;
};

/// Whether it is not there, or has nothing in it but what a crash left before its first file.
[[nodiscard]] bool is_new_folder(const std::filesystem::path& folder);

/// Refuses to mix the rows of two campaigns, seeds, shards or versions; the number of runs may grow where it can.
/// @param ours with the looks of what is there, as far as it has them
/// @throws SpecError with each that differs
void refuse_other_campaign(const StoredCampaign& there, const Campaign& ours, const Stamp& stamp);

/// @throws SpecError unless there is no such folder, or nothing in it but what a crash left before
///   its first file
void refuse_used_folder(const std::filesystem::path& folder, const char* expected);

} // namespace wingspread
