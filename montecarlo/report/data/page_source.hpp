/// A results folder with its statistics, for the page.
#pragma once

#include "montecarlo/report/data/order_split.hpp"
#include "montecarlo/results/results_folder/results_folder.hpp"
#include "montecarlo/results/streaming/streaming_statistics.hpp"
#include "montecarlo/results/summary/broken_runs.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// One set of runs: a folder, or one case of it.
struct PageSource {
  std::string label;
  std::size_t argument = 0; ///< which of the command's folders it is from
  StoredCampaign stored;
  std::filesystem::path made_from; ///< the folder whose campaign reproduces the rows
  std::vector<std::string>
      made_cases; ///< cases made from that folder, if some of its cases are missing
  /// The set's folder or, if one `analyze` of the whole folder gives the statistics of all cases, that of the first.
  std::filesystem::path analyzed_in;
  bool analyzed_alone =
      false; ///< whether the cases of its folder have been analysed in different ways
  /// The campaign without its case's changes; the set's own campaign without cases.
  Campaign before_case;
  Results results; ///< all rows; without rows (`streaming`) those of broken_runs.csv
  std::unique_ptr<StreamingStatistics> streaming; ///< of a folder made with --no-rows; else null
  Replication replication;
  Summary summary;
  double confidence = 0; ///< of each bound, raised so that it holds over all interim analyses
  std::unique_ptr<OrderSplit> orders;

  /// Whether its runs can be replayed.
  [[nodiscard]] bool replayable() const { return !stored.foreign && summary.runs > 0; }
  [[nodiscard]] bool has_rows() const { return !streaming; }
};

/// The option " --requirements FILE" of commands that judge as the last `analyze` of the folder did; empty if it judged
/// by the campaign's own requirements.
[[nodiscard]] std::string requirements_option(const PageSource& source);

/// All options of the last `analyze` of the folder that changed its statistics or verdicts, each after a blank: those
/// which summary.json has as "analyzed".
[[nodiscard]] std::string analysis_options(const PageSource& source);

/// As broken_runs (broken_runs.hpp); also works for a folder without rows.
[[nodiscard]] BrokenRuns broken_runs_of(const PageSource& source, const Verdict& verdict,
                                        std::size_t most);

/// Reads a folder and computes its statistics.
/// @param threads as of thread_count (thread_pool.hpp)
/// @throws SpecError as read_stored_results and read_streaming_statistics do
[[nodiscard]] std::unique_ptr<PageSource> read_page_source(StoredCampaign stored,
                                                           const std::string& label,
                                                           const Campaign* before_case,
                                                           int threads);

} // namespace wingspread
