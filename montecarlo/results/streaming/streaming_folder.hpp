/// The folder of a campaign whose rows are not kept: its statistics, and the runs that went wrong.
///
///   campaign.json       as of any results folder
///   statistics.bin      StreamingStatistics, and how far it goes; what --resume goes on from
///   broken_runs.csv     the rows of all runs that did not deploy or break a requirement, as runs.csv has them
///   extremes.csv        the largest and smallest values of every output, with their runs
///   summary.json, histograms.json, histograms.csv, timing.json
///
/// Its size does not grow with the number of runs, but for those that are broken.
#pragma once

#include "montecarlo/results/results_folder/folder_writer.hpp"
#include "montecarlo/results/streaming/streaming_statistics.hpp"

#include <chrono>
#include <filesystem>
#include <optional>

namespace wingspread {

inline constexpr const char* extremes_file = "extremes.csv";

/// The pilot: the campaign's first runs, whose values decide where the bins lie. Every shard makes all of them and counts
/// those of its own range.
inline constexpr long grid_pilot_runs = 4096;

/// The statistics of such a folder as far as they go.
struct StoredStatistics {
  StreamingStatistics statistics;
  std::uint64_t broken_bytes = 0; ///< how long broken_runs.csv was
};
/// @pre the campaign outlives what comes back
/// @throws SpecError when they are missing, damaged, or another campaign's
[[nodiscard]] StoredStatistics read_streaming_statistics(const StoredCampaign& stored);

/// The text of statistics.bin: the same runs give the same bytes.
[[nodiscard]] std::string streaming_statistics_text(const StoredCampaign& stored,
                                                    const StreamingStatistics& statistics,
                                                    std::uint64_t broken_bytes);

/// Works out the statistics and writes their files. @throws as write_statistics does
Summary write_streaming_statistics(const StoredCampaign& stored,
                                   const StreamingStatistics& statistics,
                                   const StatisticsSpec& spec);

/// @throws SpecError for what takes rows: draws that depend on each other, goals to stop at, cases
void refuse_without_rows(const Campaign& campaign);

/// Such a folder while its runs are made. Every half minute its statistics are on the device, from which it can be gone on
/// with after any end.
class StreamingFolder {
public:
  static constexpr bool wants_csv = false;

  /// Opens the folder as FolderWriter does. @throws as that, and refuse_without_rows
  StreamingFolder(std::filesystem::path folder, const RunPlan& plan,
                  const std::optional<Shard>& shard, bool resume);

  /// Takes up what is there or, of a new folder, makes the pilot. To be called once, before the first batch.
  /// @return false when it was stopped before the pilot was done
  [[nodiscard]] bool begin(Evaluator& evaluator);
  [[nodiscard]] RunRange remaining() const;
  [[nodiscard]] const StoredCampaign& stored() const { return stored_; }
  [[nodiscard]] const StreamingStatistics& statistics() const { return *statistics_; }
  [[nodiscard]] long count() const { return statistics_ ? statistics_->runs() : 0; }
  /// Runs that an earlier session had made.
  [[nodiscard]] long resumed() const { return resumed_; }

  void add(const Batch& batch);
  /// All is on the device. Once, behind the last batch.
  void finish();

private:
  using Clock = std::chrono::steady_clock;
  void open_broken(std::uint64_t bytes);
  void save();

  const RunPlan* plan_;
  StoredCampaign stored_;
  std::optional<FolderLock> lock_;
  std::optional<StreamingStatistics> statistics_;
  std::optional<OutputFile> broken_;
  std::uint64_t broken_bytes_ = 0;
  long resumed_ = 0;
  Clock::time_point saved_ = Clock::now();
};

/// Puts the shards of such a campaign together: the folder that running it at once would have written, byte for byte.
/// @param folders in any order, with each run in one of them
/// @param out     new or empty
/// @throws SpecError with what keeps them from it, and nothing written
Summary merge_streaming(const std::vector<std::filesystem::path>& folders,
                        const std::filesystem::path& out);

} // namespace wingspread
