/// The results folder of a campaign while it runs.
#pragma once

#include "montecarlo/foundation/platform/folder_lock.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"
#include "montecarlo/results/results_folder/row_writer.hpp"

namespace wingspread {

/// Appends to runs.csv batch by batch, and keeps the rows for the statistics. A folder left by a signal or a crash at
/// any moment can be resumed.
class FolderWriter {
public:
  static constexpr bool wants_csv = true; ///< batches must have their lines of runs.csv

  /// Opens the folder, or creates it with its campaign.json, and locks it.
  ///
  /// Without `resume` the folder must be new or empty. With `resume` it may also have the same campaign, seed, shard
  /// and version; a torn last line of runs.csv is removed. A campaign with a stopping rule has no shards, because an
  /// interim analysis needs all runs up to that point.
  ///
  /// A campaign may be resumed with more runs, unless its draws or interim analyses depend on their number. The
  /// earlier results have been seen, so they count as one more interim analysis, which campaign.json records
  /// (Sampling::extended_from). The folder then equals that of running the extended campaign at once.
  /// @throws SpecError for any other folder, with nothing written; MachineError if another process holds the folder,
  ///   or it cannot be written
  FolderWriter(std::filesystem::path folder, const RunPlan& plan, const std::optional<Shard>& shard,
               bool resume);

  /// The next runs to make: all that are left or, with a stopping rule, those up to the next interim analysis. Empty
  /// if complete. At an interim analysis this call computes the statistics of its goals.
  [[nodiscard]] RunRange remaining() const;
  [[nodiscard]] const StoredCampaign& stored() const { return stored_; }
  /// @throws MachineError if memory and temporary files had no room for the rows
  [[nodiscard]] const Results& results() const { return rows_.results(); }
  /// Runs in the file.
  [[nodiscard]] long count() const { return rows_.count(); }

  /// Appends the next runs to the file and to memory. @throws MachineError if they cannot be written
  void add(const Batch& batch) { rows_.add(batch); }
  /// Writes everything to the device and closes the file. Once, after the last batch.
  void finish() { rows_.finish(); }

private:
  /// Reads the rows of an earlier session. If the campaign has more runs now, records the extension.
  void read_existing_rows(const RunPlan& plan);

  StoredCampaign stored_;
  RowWriter rows_;
  std::optional<FolderLock> lock_;
};

/// Whether the folder does not exist, or holds only what a crash left before the first file.
[[nodiscard]] bool is_new_folder(const std::filesystem::path& folder);

/// Refuses to mix rows of two campaigns, seeds, shards or versions. The number of runs may grow unless the draws or
/// interim analyses depend on it.
/// @param ours the campaign to continue, with the interim analyses that `there` records
/// @throws SpecError with each difference
void refuse_other_campaign(const StoredCampaign& there, const Campaign& ours, const Stamp& stamp);

/// Locks the folder of a campaign: a new one or, with `resume`, one that has a campaign.
/// @throws SpecError for any other folder, with nothing written; MachineError as FolderLock
void lock_campaign_folder(std::optional<FolderLock>& lock, const std::filesystem::path& folder,
                          bool resume);

/// @throws SpecError unless is_new_folder()
void refuse_used_folder(const std::filesystem::path& folder, const char* expected);

} // namespace wingspread
