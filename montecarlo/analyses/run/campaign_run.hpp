/// `run`, the main study: makes a campaign's runs and their statistics.
///
///   run_campaign    into a results folder; with cases, into one folder for each case, and cases.json
///   run_in_memory   rows only, no files: for the C++ library and the Python module
///
/// Both make their runs with make_runs (run_loop.hpp).
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/foundation/platform/progress.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace wingspread {

/// Says which campaign to run, where and how.
struct RunRequest {
  Campaign campaign; ///< after all changes by options
  std::filesystem::path out;
  std::vector<std::string> cases{}; ///< names of the cases to run; empty: all
  std::optional<Shard> shard{};
  ThreadPool pool{};
  bool resume = false;
  bool streaming = false; ///< keeps statistics and the rows of broken runs, no other rows
};

/// How many runs one results folder has.
struct RunsKept {
  std::string of_case; ///< empty for a campaign without cases
  long kept = 0, total = 0;
  bool interrupted = false; ///< the runs were stopped before the last one
};
/// "500 of 2000 runs of case hot are kept".
[[nodiscard]] std::string describe(const RunsKept& runs);

/// How the caller follows and stops a run. None of these functions may be empty.
struct RunCallbacks {
  /// Called when a results folder is open and its first run is about to begin.
  /// @return a flag that stops the runs once it is true; it must live until the next call or the end of run_campaign
  std::function<const std::atomic<bool>&()> begin_runs;
  /// Called with the counts over all cases, before a folder's first batch and after every batch. Calls come one at a
  /// time, from any thread of the pool.
  std::function<void(const RunCounts&)> show_progress;
  /// Called when the folder's runs are on disk and only its statistics are missing.
  /// @return whether to make the statistics now; `wingspread analyze` can make them later
  std::function<bool(const RunsKept&)> begin_statistics;
};

/// A results folder and its statistics; both are on disk.
struct FolderResults {
  StoredCampaign stored;
  Summary summary;
};

struct CampaignResults {
  std::vector<FolderResults>
      folders; ///< the folders run in this session whose statistics were made
  std::optional<RunsKept> interrupted; ///< the folder in which the run ended early
  /// Only for a campaign with cases that was not interrupted: the outer folder, and all cases that have a folder.
  std::optional<StoredCampaign> whole;
  std::vector<CaseSummary> cases;
};

/// Runs a campaign into `request.out`.
/// @throws SpecError for a wrong request, before anything is written; MachineError if the machine lacks room, memory or
///   permission (the finished runs stay on disk)
[[nodiscard]] CampaignResults run_campaign(const RunRequest& request,
                                           const RunCallbacks& callbacks);

/// Makes the runs of a campaign without cases and returns their rows.
/// @param stop once true, no further run begins; the rows made so far are returned
/// @pre `stored` has no folder and no shard
[[nodiscard]] Results run_in_memory(const StoredCampaign& stored, const RunPlan& plan,
                                    const ThreadPool& pool, const std::atomic<bool>& stop);

} // namespace wingspread
