#include "montecarlo/analyses/run/campaign_run.hpp"
#include "montecarlo/engine/runs/campaign_check.hpp"
#include "montecarlo/foundation/platform/arithmetic.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/interfaces/library/single_run.hpp"
#include "montecarlo/interfaces/library/table.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/overrides.hpp"
#include "montecarlo/results/results_folder/version.hpp"

#include <fmt/format.h>

#include <utility>

namespace wingspread::api {
namespace {

void check_options(const RunOptions& options) {
  std::vector<Problem> problems;
  if (options.runs && (*options.runs < 1 || *options.runs > most_runs))
    problems.push_back({"", "--runs", std::to_string(*options.runs),
                        fmt::format("an integer from 1 to {}", most_runs)});
  if (const auto problem = problem_of_threads(options.threads)) problems.push_back(*problem);
  if (!problems.empty()) throw SpecError(std::move(problems));
}

std::vector<std::string> warnings_of(const Campaign& campaign, const std::filesystem::path& file) {
  std::vector<std::string> warnings;
  for (const InputWarning& warning : check_campaign(campaign, file))
    warnings.push_back(to_string(warning));
  return warnings;
}

} // namespace

Table run(const Input& input, const RunOptions& options) {
  const DefaultArithmetic arithmetic;
  check_options(options);
  Campaign campaign = read_campaign_input(input);
  change_scene(campaign, options.set);
  override_sampling(campaign, options.runs, options.seed);
  std::vector<std::string> warnings = warnings_of(campaign, input.file);
  if (!campaign.cases.empty() || !options.of_case.empty())
    campaign = chosen_case(campaign, options.of_case);
  Stamp stamp = stamp_of(campaign, {});
  const StoredCampaign stored{{}, std::move(campaign), std::move(stamp)};
  const RunPlan plan(stored.campaign);
  const std::atomic<bool> never = false;
  Results rows = run_in_memory(stored, plan, {.threads = options.threads},
                               options.stop ? *options.stop : never);
  return table_of(stored, plan.names(), std::move(rows), std::move(warnings));
}

Table read(const std::filesystem::path& folder, const std::string& of_case) {
  const DefaultArithmetic arithmetic;
  const StoredCampaign stored = read_any_campaign(folder_of_case(folder, of_case));
  std::vector<std::string> warnings;
  if (stored.stamp.preview)
    warnings.push_back(stored.folder.string() + " is " + describe(*stored.stamp.preview) +
                       "; the results may change");
  return table_of(stored, RunPlan(stored.campaign).names(), read_stored_results(stored).results,
                  std::move(warnings));
}

std::string version() { return std::string(wingspread::version()); }

} // namespace wingspread::api
