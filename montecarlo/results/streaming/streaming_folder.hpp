/// The results folder of a campaign run with --no-rows.
///
///   campaign.json       as in any results folder
///   statistics.bin      StreamingStatistics and the length of broken_runs.csv; --resume continues from it
///   broken_runs.csv     rows of the runs that did not deploy or break a requirement, in the form of runs.csv
///   extremes.csv        largest and smallest values of every output, with their runs
///   summary.json, histograms.json, histograms.csv, timing.json
///
/// The folder's size does not grow with the number of runs, except for the rows in broken_runs.csv.
#pragma once

#include "montecarlo/results/results_folder/folder_writer.hpp"
#include "montecarlo/results/streaming/streaming_statistics.hpp"

#include <chrono>
#include <filesystem>
#include <optional>

namespace wingspread {

inline constexpr const char* extremes_file = "extremes.csv";

/// Size of the pilot: the campaign's first runs, whose values decide where bins lie. Every shard makes the whole
/// pilot, and counts the pilot's runs in its own range. Heuristic: with 4096 values the densest fifth and the
/// standard deviation are known to a few %. A smaller pilot gives coarser or needlessly many bins, never wrong
/// counts.
inline constexpr long grid_pilot_runs = 4096;

/// The statistics in such a folder, of the runs made so far.
struct StoredStatistics {
  StreamingStatistics statistics;
  std::uint64_t broken_bytes = 0; ///< length of broken_runs.csv when the statistics were saved
};
/// @pre the campaign outlives the result
/// @throws SpecError if it is missing, damaged, another campaign's or shard's, or if broken_runs.csv was cut since
[[nodiscard]] StoredStatistics read_streaming_statistics(const StoredCampaign& stored);

/// The rows of broken_runs.csv that are within its first `bytes`.
/// @throws SpecError if the file is missing or broken
[[nodiscard]] Results read_broken_runs(const StoredCampaign& stored, std::uint64_t bytes);

/// The content of statistics.bin: the same runs give the same bytes.
[[nodiscard]] std::string streaming_statistics_text(const StoredCampaign& stored,
                                                    const StreamingStatistics& statistics,
                                                    std::uint64_t broken_bytes);

/// Computes the summary and writes its files. @throws as write_statistics
Summary write_streaming_statistics(const StoredCampaign& stored,
                                   const StreamingStatistics& statistics,
                                   const StatisticsSpec& spec);

/// @throws SpecError for features that need rows: dependent draws, stopping goals, cases, extensions
void refuse_without_rows(const Campaign& campaign);

/// The folder while its runs are made. Statistics are saved every half minute, so that the folder can be resumed after
/// a crash.
class StreamingFolder {
public:
  static constexpr bool wants_csv = false;

  /// Opens the folder as FolderWriter does. @throws as that, and refuse_without_rows
  StreamingFolder(std::filesystem::path folder, const RunPlan& plan,
                  const std::optional<Shard>& shard, bool resume);

  /// Reads the existing statistics, or makes the pilot of a new folder. Call once, before the first batch.
  /// @return false if stopped before the end of the pilot
  [[nodiscard]] bool begin(Evaluator& evaluator);
  [[nodiscard]] RunRange remaining() const;
  [[nodiscard]] const StoredCampaign& stored() const { return stored_; }
  [[nodiscard]] const StreamingStatistics& statistics() const { return *statistics_; }
  [[nodiscard]] long count() const { return statistics_ ? statistics_->runs() : 0; }
  /// Runs that an earlier session had made.
  [[nodiscard]] long resumed() const { return resumed_; }

  void add(const Batch& batch);
  /// Writes everything to the device. Once, after the last batch.
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

/// Merges the shards of such a campaign into the folder that running it at once would write, byte for byte.
/// @param folders in any order; each run is in exactly one
/// @param out     new or empty, or left by an interrupted merge of the same folders
/// @throws SpecError with every obstacle; nothing is written then
Summary merge_streaming(const std::vector<std::filesystem::path>& folders,
                        const std::filesystem::path& out);

} // namespace wingspread
