#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/interfaces/library/single_run.hpp"
#include "montecarlo/interfaces/library/table.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/overrides.hpp"
#include "montecarlo/model/input_checks/examine.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "montecarlo/results/results_folder/version.hpp"

#include <fmt/format.h>

#include <utility>

namespace wingspread::api {
namespace {

void check(const RunOptions& options) {
  std::vector<Problem> problems;
  if (options.runs && (*options.runs < 1 || *options.runs > most_runs))
    problems.push_back({"", "--runs", std::to_string(*options.runs),
                        fmt::format("an integer from 1 to {}", most_runs)});
  if (options.threads < 0 || options.threads > most_threads)
    problems.push_back({"", "--threads", std::to_string(options.threads),
                        fmt::format("an integer from 1 to {}, or 0", most_threads)});
  if (!problems.empty()) throw SpecError(std::move(problems));
}

std::vector<std::string> notices_of(const Campaign& campaign, const std::filesystem::path& file) {
  std::vector<std::string> notices;
  for (const Notice& notice : examine(campaign, file)) notices.push_back(to_string(notice));
  return notices;
}

/// The next runs to be made: as of FolderWriter::remaining.
RunRange remaining(const StoredCampaign& stored, const Results& results) {
  const RunRange runs = stored.runs();
  const long done = std::ssize(results.runs);
  if (is_complete(stored, results)) return {done, done};
  return {done, stored.campaign.until.empty() ? runs.last : next_checkpoint(done, runs.size())};
}

Results make_runs(const StoredCampaign& stored, const RunPlan& plan, const RunOptions& options) {
  const std::atomic<bool> never = false;
  ThreadEvaluator evaluator({.threads = options.threads}, options.stop ? *options.stop : never);
  Results results(plan.names());
  const auto keep = [&](const Batch& batch) {
    for (const ResultRow& row : batch.rows) results.append(row);
  };
  for (bool stopped = false; !stopped;) {
    const RunRange next = remaining(stored, results);
    if (next.size() == 0) break;
    stopped = evaluator.make(plan, next, {keep, false}) < next.size();
  }
  return results;
}

} // namespace

Table run(const Input& input, const RunOptions& options) {
  check(options);
  Campaign campaign = read_campaign_input(input);
  change_scene(campaign, options.set);
  override_sampling(campaign, options.runs, options.seed);
  std::vector<std::string> notices = notices_of(campaign, input.file);
  if (!campaign.cases.empty() || !options.of_case.empty())
    campaign = chosen_case(campaign, options.of_case);
  Stamp stamp = stamp_of(campaign, {});
  const StoredCampaign stored{{}, std::move(campaign), std::move(stamp)};
  const RunPlan plan(stored.campaign);
  return table_of(stored, plan.names(), make_runs(stored, plan, options), std::move(notices));
}

Table read(const std::filesystem::path& folder, const std::string& of_case) {
  const StoredCampaign stored = read_any_campaign(folder_of_case(folder, of_case));
  return table_of(stored, RunPlan(stored.campaign).names(), read_stored_results(stored).results,
                  {});
}

std::string version() { return std::string(wingspread::version()); }

} // namespace wingspread::api
