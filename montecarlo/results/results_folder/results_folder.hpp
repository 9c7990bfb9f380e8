/// The results folder: which files it has, what identifies it, and how it is read.
///
///   campaign.json    the campaign in full, and its stamp
///   runs.csv         a row for each run (results.hpp); the only one that grows
///   summary.json, histograms.json, histograms.csv      worked out of runs.csv
///   timing.json      what depends on the machine and the day, and nothing else does
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
/// Of a campaign that was run without rows (rowless/), in place of runs.csv: what its statistics are worked out of, and the
/// rows of the runs that did not deploy or break a requirement.
inline constexpr const char* statistics_file = "statistics.bin";
inline constexpr const char* broken_runs_file = "broken_runs.csv";

/// campaign.json's text.
[[nodiscard]] std::string campaign_text(const Campaign& campaign, const Stamp& stamp);

/// A campaign as a folder holds it.
struct StoredCampaign {
  std::filesystem::path folder;
  Campaign campaign;
  Stamp stamp;
  bool foreign = false; ///< without a stamp of its own: its rows were not made by this program
  [[nodiscard]] RunRange runs() const { return shard_runs(campaign.sampling.runs, stamp.shard); }
};

/// Whether these are all the runs that there will be: the folder's, or as many as it takes to the
/// checkpoint at which the campaign stops.
/// @pre the results are the folder's first runs
[[nodiscard]] bool is_complete(const StoredCampaign& stored, const Results& results);

/// Reads campaign.json. @throws SpecError when it is missing, broken, or not what its hash says
[[nodiscard]] StoredCampaign read_stored_campaign(const std::filesystem::path& folder);

/// The same, or a campaign that nobody has stamped, beside the runs.csv of another tool.
/// @throws SpecError as read_stored_campaign does, less for the stamp that is not there
[[nodiscard]] StoredCampaign read_any_campaign(const std::filesystem::path& folder);

/// Whether the folder's runs were made without keeping their rows.
[[nodiscard]] bool is_streaming_folder(const std::filesystem::path& folder);
/// The file of the folder's rows: of all runs or, where these were not kept, of those that went wrong.
[[nodiscard]] std::string rows_file(const std::filesystem::path& folder);
/// @throws SpecError when they were
void refuse_rowless(const std::filesystem::path& folder);

/// How a file of rows ends.
struct RowsRead {
  std::size_t complete_bytes = 0; ///< its length up to its last complete line; 0: no header
  bool unterminated = false;      ///< something follows after that
};

/// Hands on the rows of runs.csv, less a last line that was cut off, one after another.
/// @throws SpecError when it is broken, or has a run that is not the folder's
RowsRead for_each_stored_row(const StoredCampaign& stored,
                             const std::function<void(const ResultRow&)>& take);

/// Reads runs.csv, less a last line that was cut off; nothing when there is no such file. Of
/// another tool's file nothing is left out: it may do without the last line's end, and has all
/// runs, for those that it lost would flatter the rest.
/// @throws SpecError when it is broken, or has a run that is not the folder's
[[nodiscard]] ResultsFile read_stored_results(const StoredCampaign& stored);

/// The statistics of the rows, their confidence shared out among the looks that the campaign may take, with all that it
/// asks for besides.
/// @param threads as of thread_count (team.hpp)
[[nodiscard]] Summary stored_summary(const StoredCampaign& stored, const Results& results,
                                     const StatisticsSpec& spec, int threads = 0);

/// The nominal run and its outputs, which this program makes: of another tool's rows it would say nothing.
void add_nominal(const Campaign& campaign, Summary& summary);

/// Writes the three files of a summary.
void write_summary_files(const StoredCampaign& stored, const Summary& summary);

/// Works out the statistics of the rows and writes the three files of them. Results that lack some
/// of the folder's runs are labelled so: "partial" in summary.json's stamp. Of all of this program's own runs (not
/// of a shard) some are made again, to say how accurate they are.
/// @param threads as of thread_count (team.hpp)
/// @throws SpecError when they cannot be written
Summary write_statistics(const StoredCampaign& stored, const Results& results,
                         const StatisticsSpec& spec, int threads = 0);

} // namespace wingspread
