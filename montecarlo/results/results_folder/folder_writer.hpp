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
  static constexpr bool wants_csv = true; ///< in the batches it receives

  /// Opens the folder, or creates it with its campaign.json, and locks it.
  ///
  /// To resume, the folder is new, or has the same campaign, seed, shard and version; a torn end of runs.csv is
  /// removed. Otherwise it is new or empty. A campaign with a stopping rule has no shards, because an interim
  /// analysis needs all runs up to it.
  ///
  /// A campaign may be resumed with more runs, unless its draws or interim analyses depend on their number. Its
  /// results were seen, so this is one more interim analysis, recorded in campaign.json (Sampling::extended_from).
  /// The folder then equals that of running this campaign at once.
  /// @throws SpecError otherwise, with nothing written; MachineError if another process holds it, or it cannot be
  ///   written
  FolderWriter(std::filesystem::path folder, const RunPlan& plan, const std::optional<Shard>& shard,
               bool resume);

  /// The next runs to make: all that are left or, with a stopping rule, those up to the next interim analysis. Empty
  /// if complete. Cost at an interim analysis: that of its statistics.
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
  /// Reads the existing rows, and records an extension.
  void go_on(const RunPlan& plan);

  StoredCampaign stored_;
  RowWriter rows_;
  std::optional<FolderLock> lock_;
};

/// Whether the folder does not exist, or holds only what a crash left before the first file.
[[nodiscard]] bool is_new_folder(const std::filesystem::path& folder);

/// Refuses to mix rows of two campaigns, seeds, shards or versions. The number of runs may grow where that is
/// allowed.
/// @param ours with the interim analyses recorded there, as far as it has them
/// @throws SpecError with each difference
void refuse_other_campaign(const StoredCampaign& there, const Campaign& ours, const Stamp& stamp);

/// @throws SpecError unless is_new_folder()
void refuse_used_folder(const std::filesystem::path& folder, const char* expected);

} // namespace wingspread
