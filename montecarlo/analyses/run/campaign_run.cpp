#include "montecarlo/analyses/run/campaign_run.hpp"

#include "montecarlo/analyses/run/run_loop.hpp"
#include "montecarlo/analyses/run/timing.hpp"
#include "montecarlo/engine/mpi/evaluator_of.hpp"
#include "montecarlo/foundation/formats/machine_error.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/results/results_folder/folder_writer.hpp"
#include "montecarlo/results/streaming/streaming_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace wingspread {
namespace {

/// Adds up the tallies of the cases, which run one after the other.
class OverallCounts {
public:
  /// @param runs number of runs of all cases together
  explicit OverallCounts(long runs) : ended_{.total = runs} {}

  /// The counts of all cases so far. @param own the counts of the case that is running
  [[nodiscard]] RunCounts with(const RunCounts& own) const {
    RunCounts all = ended_;
    all.done += own.done;
    all.before += own.before;
    all.invalid += own.invalid;
    all.failed += own.failed;
    all.stalled += own.stalled;
    all.timed_out += own.timed_out;
    return all;
  }
  /// Adds a case that has ended. If `until` ended it early, the total loses the runs that were not made.
  void add_case(const RunCounts& own) {
    ended_ = with(own);
    ended_.total -= own.total - own.done;
  }

private:
  RunCounts ended_; ///< counts of the cases that have ended; the total is that of all cases
};

/// Counts the runs that a folder has before run_folder makes the others. In a new folder of streaming statistics it
/// first makes the pilot. @return false if the evaluator was stopped during the pilot
bool count_earlier_runs(const FolderWriter& folder, Evaluator& /*evaluator*/, RunCounts& counts) {
  const Results& results = folder.results();
  counts.done = std::ssize(results.runs);
  counts.invalid = std::ranges::count(results.status, Status::invalid);
  counts.failed = std::ranges::count(results.status, Status::failed);
  counts.stalled = std::ranges::count(results.status, Status::stalled);
  counts.timed_out = std::ranges::count(results.status, Status::timed_out);
  counts.before = counts.done;
  return true;
}
bool count_earlier_runs(StreamingFolder& folder, Evaluator& evaluator, RunCounts& counts) {
  if (!folder.begin(evaluator)) return false;
  const StreamingStatistics& made = folder.statistics();
  counts.done = made.runs();
  counts.invalid = made.count_of(Status::invalid);
  counts.failed = made.count_of(Status::failed);
  counts.stalled = made.count_of(Status::stalled);
  counts.timed_out = made.count_of(Status::timed_out);
  counts.before = folder.resumed();
  return true;
}

/// Makes the runs that a folder lacks, and writes timing.json. @return whether they were interrupted
/// @param outdated a file that no longer holds once a run is made: it is removed before the first; empty: none
template <class Folder>
bool complete_runs(Folder& folder, const RunPlan& plan, const ThreadPool& pool,
                   const RunCallbacks& callbacks, const std::filesystem::path& outdated,
                   OverallCounts& overall) {
  const auto start = std::chrono::steady_clock::now();
  const auto evaluator = evaluator_of(pool, callbacks.begin_runs());
  RunCounts counts{.total = folder.stored().runs().size()};
  if (!count_earlier_runs(folder, *evaluator, counts)) return true;
  if (!outdated.empty() && counts.done < counts.total) std::filesystem::remove(outdated);
  const auto show = [&](const RunCounts& own) { callbacks.show_progress(overall.with(own)); };
  show(counts);
  const bool interrupted = make_runs(folder, plan, *evaluator, counts, show);
  folder.finish();
  overall.add_case(counts);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  write_timing(folder.stored().folder, {counts, seconds.count(), interrupted}, pool, *evaluator);
  return interrupted;
}

Summary write_folder_statistics(const FolderWriter& folder, int threads) {
  return write_statistics(folder.stored(), folder.results(), threads);
}
Summary write_folder_statistics(const StreamingFolder& folder, int /*threads*/) {
  return write_streaming_statistics(folder.stored(), folder.statistics(),
                                    folder.stored().campaign.statistics);
}

/// Makes the runs and the statistics of one results folder.
/// @param outdated as of complete_runs
/// @return false if the runs were interrupted, or the statistics were left for later
template <class Folder>
bool run_folder(const Campaign& campaign, const std::filesystem::path& out,
                const std::filesystem::path& outdated, const RunRequest& request,
                const RunCallbacks& callbacks, OverallCounts& overall, CampaignResults& results) {
  const RunPlan plan(campaign);
  Folder folder(out, plan, request.shard, request.resume);
  RunsKept runs{.of_case = campaign.of_case, .total = folder.stored().runs().size()};
  runs.interrupted = complete_runs(folder, plan, request.pool, callbacks, outdated, overall);
  runs.kept = folder.count();
  const bool wanted = callbacks.begin_statistics(runs);
  if (wanted && !(runs.interrupted && runs.kept == 0)) {
    try {
      Summary summary = write_folder_statistics(folder, request.pool.threads);
      add_accuracy_timing(out, summary);
      results.folders.push_back({folder.stored(), std::move(summary)});
    } catch (const MachineError& error) {
      throw MachineError(fmt::format("{}\n{}, without statistics: `wingspread analyze {}` makes "
                                     "them once there is room",
                                     error.what(), describe(runs), shell_word(out.string())));
    }
  }
  if (wanted && !runs.interrupted) return true;
  results.interrupted = runs;
  return false;
}

CampaignResults run_cases(const RunRequest& request, const RunCallbacks& callbacks) {
  const Campaign& campaign = request.campaign;
  const std::vector<CaseSpec> chosen = chosen_cases(campaign, request.cases);
  CasesFolder folder(request.out, campaign, request.shard, request.resume);
  OverallCounts overall(std::ssize(chosen) *
                        shard_runs(campaign.sampling.runs, request.shard).size());
  CampaignResults results;
  for (const CaseSpec& spec : chosen)
    if (!run_folder<FolderWriter>(campaign_of_case(campaign, spec), request.out / spec.name,
                                  request.out / cases_file, request, callbacks, overall, results))
      return results;
  folder.note_extensions();
  for (const auto& [stored, summary] : results.folders)
    results.cases.push_back(case_summary(folder.stored(), stored.campaign.of_case, summary));
  results.cases = complete_cases(folder.stored(), std::move(results.cases), request.pool.threads);
  write_cases_file(folder.stored(), results.cases, request.out);
  results.whole = folder.stored();
  return results;
}

} // namespace

std::string describe(const RunsKept& runs) {
  return fmt::format(
      "{} of {} {}{} {} kept", runs.kept, runs.total, runs.total == 1 ? "run" : "runs",
      runs.of_case.empty() ? "" : " of case " + runs.of_case, runs.total == 1 ? "is" : "are");
}

CampaignResults run_campaign(const RunRequest& request, const RunCallbacks& callbacks) {
  const Campaign& campaign = request.campaign;
  const std::vector<CaseSpec> chosen = chosen_cases(campaign, request.cases);
  if (!campaign.until.empty())
    if (const std::string where = where_nothing_varies(campaign, chosen); !where.empty())
      throw SpecError(
          {{"", "/until", "goals to stop at, though nothing is dispersed (" + where + ')',
            campaign.cases.empty()
                ? "none: all runs are the same run, and more of them decide nothing (`wingspread "
                  "simulate` makes it)"
                : "cases that vary (`--case NAME`): all runs of the others are the same run, and "
                  "more of them decide nothing"}});
  if (!request.streaming && !campaign.cases.empty()) return run_cases(request, callbacks);
  OverallCounts overall(shard_runs(campaign.sampling.runs, request.shard).size());
  CampaignResults results;
  const auto run = request.streaming ? run_folder<StreamingFolder> : run_folder<FolderWriter>;
  run(campaign, request.out, "", request, callbacks, overall, results);
  return results;
}

Results run_in_memory(const StoredCampaign& stored, const RunPlan& plan, const ThreadPool& pool,
                      const std::atomic<bool>& stop) {
  RowsInMemory rows(stored, plan.names());
  const auto evaluator = evaluator_of(pool, stop);
  RunCounts counts;
  make_runs(rows, plan, *evaluator, counts, [](const RunCounts&) {});
  return std::move(rows).take();
}

} // namespace wingspread
