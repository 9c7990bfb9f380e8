/// The results folder: its files, its identity, and functions that read it.
///
///   campaign.json    the campaign in full, and its stamp
///   runs.csv         one row per run (results.hpp); the only file that grows
///   summary.json, histograms.json, histograms.csv      computed from runs.csv
///   timing.json      times and the machine: the only file that differs between repetitions
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/engine/runs/results.hpp"
#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/results/results_folder/stamp.hpp"
#include "montecarlo/results/summary/summary.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

inline constexpr const char* campaign_file = "campaign.json";
inline constexpr const char* runs_file = "runs.csv";
inline constexpr const char* timing_file = "timing.json";
inline constexpr const char* summary_file = "summary.json";
inline constexpr const char* histograms_json_file = "histograms.json";
inline constexpr const char* histograms_csv_file = "histograms.csv";
/// The files in place of runs.csv after --no-rows: the streaming statistics, and the rows of runs that did not deploy
/// or break a requirement.
inline constexpr const char* statistics_file = "statistics.bin";
inline constexpr const char* broken_runs_file = "broken_runs.csv";

/// The text of campaign.json.
[[nodiscard]] std::string campaign_text(const Campaign& campaign, const Stamp& stamp);

/// A campaign as stored in a folder.
struct StoredCampaign {
  std::filesystem::path folder;
  Campaign campaign;
  Stamp stamp;
  bool foreign = false; ///< without a stamp: its rows were not made by this program
  /// The campaign's own requirements, if it is judged by others (judge_by). Its stopping rule keeps to them.
  std::optional<std::vector<Requirement>> own_requirements{};
  [[nodiscard]] RunRange runs() const { return shard_runs(campaign.sampling.runs, stamp.shard); }
};

/// Replaces the requirements by which a campaign is judged.
void judge_by(std::vector<Requirement> requirements, StoredCampaign& stored);

/// The campaign with the requirements and statistics of the last `analyze`, which summary.json has if they are not the
/// campaign's own ("analyzed").
/// @throws SpecError if summary.json is broken
[[nodiscard]] StoredCampaign as_analyzed(StoredCampaign stored);

/// Copies campaign.json and the rows to another folder, which is made if it is missing.
/// @throws MachineError if a file cannot be copied
void copy_rows(const std::filesystem::path& from, const std::filesystem::path& to);

/// Whether `to` has what an interrupted copy_rows() leaves: the same campaign.json, and no other rows.
[[nodiscard]] bool is_copy(const std::filesystem::path& from, const std::filesystem::path& to);

/// Whether no run is missing: the results have all of the folder's runs, or those up to the interim analysis at which
/// the campaign stops.
/// @pre the results are the folder's first runs
[[nodiscard]] bool is_complete(const StoredCampaign& stored, const Results& results);

/// The warning of rows that lack runs between others; nothing without such gaps. No interruption leaves gaps: somebody
/// may have selected the rows.
/// @param stopped by the campaign's goals, so that no run is missing
[[nodiscard]] std::optional<std::string> gaps_text(const StoredCampaign& stored,
                                                   const Results& results, bool stopped);

/// Reads campaign.json. @throws SpecError if it is missing, broken, or does not match its hash
[[nodiscard]] StoredCampaign read_stored_campaign(const std::filesystem::path& folder);

/// As read_stored_campaign(); also accepts a campaign without a stamp, beside the runs.csv of another tool.
/// @throws SpecError as read_stored_campaign, except for the missing stamp
[[nodiscard]] StoredCampaign read_any_campaign(const std::filesystem::path& folder);

/// Whether the folder was made with --no-rows.
[[nodiscard]] bool is_streaming_folder(const std::filesystem::path& folder);
/// The folder's file of rows: runs.csv or, for a folder made with --no-rows, broken_runs.csv.
[[nodiscard]] std::string rows_file(const std::filesystem::path& folder);
/// @throws SpecError for a folder made with --no-rows
void refuse_rowless(const std::filesystem::path& folder);
/// @throws SpecError for a folder made with --no-rows, or without runs.csv
void refuse_without_rows(const std::filesystem::path& folder);

/// How a file of rows ends.
struct RowsRead {
  std::size_t complete_bytes = 0; ///< length up to its last complete line; 0: no header
  bool unterminated = false;      ///< whether bytes follow that line
};

/// Delivers the rows of runs.csv one after another, without a torn last line.
/// @throws SpecError if the file is broken, has a run that is not the folder's, or if a row contradicts itself
///   (row_check.hpp)
RowsRead for_each_stored_row(const StoredCampaign& stored,
                             const std::function<void(const ResultRow&)>& take);

/// Reads runs.csv without a torn last line. A file of another tool is read to its
/// end, with or without a last line break. It must have all runs, because statistics without the lost runs would be too
/// good.
/// @throws SpecError if the file is missing or broken, or has a run that is not the folder's
[[nodiscard]] ResultsFile read_stored_results(const StoredCampaign& stored);

/// The statistics, verdicts, stopping goals and warnings of the rows. The interim analyses of the campaign share the
/// risk of each bound.
/// @param threads as of thread_count (thread_pool.hpp)
[[nodiscard]] Summary stored_summary(const StoredCampaign& stored, const Results& results,
                                     int threads = 0);

/// Draws outside the values that the campaign's laws can give. An unbounded law counts as ending where a tail of 1e-15
/// is left.
[[nodiscard]] std::vector<StrangeDraws> strange_draws(const Campaign& campaign,
                                                      const Results& results);

/// Adds the nominal run and its outputs. Not for rows of another tool.
void add_nominal(const Campaign& campaign, Summary& summary);

/// Writes the three files of a summary. summary.json names requirements and statistics that are not the campaign's own.
void write_summary_files(const StoredCampaign& stored, const Summary& summary);

/// Computes the statistics of the rows and writes their three files. Results that lack runs of the folder are
/// labelled "partial" in summary.json's stamp. Measures the accuracy if all of the campaign's runs are there (no shard)
/// and this program made them.
/// @param threads as of thread_count (thread_pool.hpp)
/// @throws SpecError if the files cannot be written
Summary write_statistics(const StoredCampaign& stored, const Results& results, int threads = 0);

} // namespace wingspread
