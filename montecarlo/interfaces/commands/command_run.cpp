#include "montecarlo/analyses/run/campaign_run.hpp"
#include "montecarlo/engine/runs/campaign_check.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/results_display.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wingspread {
namespace {

struct RunOptions {
  std::filesystem::path campaign, out;
  SamplingOptions sampling;
  MachineOptions machine;
  bool resume = false, strict = false, no_rows = false;
  std::string shard;
  std::vector<std::string> until, set, cases;
  Display display;
};

/// Replaces the campaign's stopping goals by those of --until. Without --until the campaign keeps its own.
void override_until(Campaign& campaign, const std::vector<std::string>& until) {
  if (until.empty()) return;
  Json goals = Json::array();
  for (const std::string& text : until) goals.push_back(parse_stopping_goal(text).value());
  override_settings({{"until", goals}},
                    [&](const JsonCursor& at) { override_stopping(campaign, at.member("until")); });
}

std::string refuse_until(const std::string& text) {
  if (parse_stopping_goal(text)) return "";
  return fmt::format(
      "found \"{}\", expected e.g. \"root.peak_moment@0.99 5 N*m\" (its 0.99 quantile "
      "with an interval 5 N·m wide), \"root.peak_moment@0.99 2%\", \"deployed 1%\" or "
      "\"requirement deployed\"",
      text);
}

/// Reads the campaign, applies the options to it and prints its warnings.
RunRequest request_of(const RunOptions& options) {
  // not `.campaign = {}`: GCC 12 destroys a nested aggregate twice where a later initialiser throws, as pool_of may
  RunRequest request{.campaign = read_campaign_file(options.campaign),
                     .out = options.out,
                     .cases = options.cases,
                     .shard = parse_shard(options.shard),
                     .pool = pool_of(options.machine),
                     .resume = options.resume,
                     .streaming = options.no_rows};
  change_scene(request.campaign, options.set);
  override_sampling(request.campaign, options.sampling.runs, options.sampling.seed);
  override_until(request.campaign, options.until);
  print_warnings(check_campaign(request.campaign, options.campaign), options.strict);
  return request;
}

/// Prints the results. @return the exit status
int show_run(const CampaignResults& results, const Display& display) {
  if (results.whole) {
    if (display.histograms)
      for (const auto& [stored, summary] : results.folders) show_table(stored, summary, display);
    show_cases(*results.whole, results.cases, display);
    return judge_cases(*results.whole, results.cases);
  }
  int worst = exit_code::done; // one folder, or cases that were interrupted: nothing to compare
  for (const auto& [stored, summary] : results.folders)
    worst = std::max(worst, show_results(stored, summary, display));
  return worst;
}

int run(const RunOptions& options) {
  const RunRequest request = request_of(options);
  Progress progress(stderr);
  std::string last_words; // outlives the interrupt, which prints them
  std::optional<Interrupt> interrupt;
  const auto begin_runs = [&]() -> const std::atomic<bool>& { return interrupt.emplace().flag(); };
  const auto show_progress = [&](const RunCounts& counts) { progress.show(counts); };
  const auto begin_statistics = [&](const RunsKept& runs) {
    if (runs.interrupted) progress.pause();
    last_words =
        fmt::format("interrupted: {}; the same command with --resume continues\n", describe(runs));
    interrupt->end_at_once(last_words.c_str());
    return !interrupt->is_urgent();
  };
  const CampaignResults results =
      run_campaign(request, {begin_runs, show_progress, begin_statistics});
  progress.pause();
  const int code = show_run(results, options.display);
  if (!results.interrupted) return code;
  print_message("{}", last_words);
  return exit_code::interrupted;
}

void add_run_options(CLI::App& command, RunOptions& options) {
  command.add_option("campaign", options.campaign, "The campaign, a JSON file")->required();
  command.add_option("--out", options.out, "The results folder: new or empty")->required();
  add_sampling_options(command, options.sampling);
  add_machine_options(command, options.machine);
  command.add_flag("--resume", options.resume,
                   "Continue an interrupted run, or add runs with a larger --runs");
  add_shard_option(command, options.shard, "Make only part I of N of the runs, e.g. 2/5");
  command
      .add_option("--until", options.until,
                  "Stop once this is known, e.g. \"deployed 1%\" (see below)")
      ->type_name("GOAL")
      ->allow_extra_args(false)
      ->check(refuse_until);
  command.add_flag("--no-rows", options.no_rows,
                   "Keep statistics and the rows of broken runs only: for very many runs");
  add_set_option(command, options.set);
  command
      .add_option("--case", options.cases,
                  "Run only this case of a campaign with cases; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  add_strict_option(command, options.strict);
  add_display_options(command, options.display);
  command.footer(
      std::string("Progress goes to standard error if that is a terminal.\n") + display_help +
      R"(The results do not depend on threads, lanes, instruction sets, shards or interruptions.
Exit code 1: a requirement of the campaign is not shown to be met.

For a campaign with cases the folder gets one results folder per case and cases.json, which compares
the cases. All cases use the same draws. The exit code is the worst of all cases.

--until stops the campaign as soon as a result is known well enough, and --runs is then the most
runs. Each goal names a result and how wide its confidence interval may be, from bound to bound, at
the campaign's confidence. If --until is given several times, all goals must be reached:
  "root.peak_moment@0.99 5 N*m"  the 0.99 quantile to within 5 N·m; a number alone is in SI units
  "root.peak_moment@0.99 2%"     the 0.99 quantile to within 2 % of itself
  "deployed 1%"                  the share of runs that deploy, to within one run in a hundred: from
                                 98.5 to 99.5 %, for example (also of another status, HINGE.held)
  "requirement deployed"         the requirement of that name or output has passed or failed
The goals are checked after 1000, 2000, 4000, … runs and nowhere else, so a campaign always stops
at the same run. Each of these interim analyses adds a chance of
a wrong answer, so all bounds and verdicts share their risk among them and hold wherever the
campaign stops. --until excludes shards, draws that depend on each other, and campaigns in which
nothing is dispersed.

If a requirement is not met, do not add runs of the same draws until it passes: that inflates the
risk of a wrong verdict. Use --until, or a new --seed and a number of runs fixed beforehand.
--resume with more --runs counts as a further interim analysis, and the verdicts allow for it.

With --no-rows there is no runs.csv, and memory and disk space do not grow with the number of runs.
Counts, verdicts and the 4096 largest and smallest values of every output are the same as with
rows, moments to rounding; other quantiles come with an error bound. broken_runs.csv keeps the rows
of the runs that did not deploy or broke a requirement. --resume, --shard, merge, replay, analyze
and report work on such a folder; sensitivity, export and --until need rows and refuse it. A
campaign with cases is refused: run FOLDER/CASE/campaign.json of an earlier folder, one for each
case.

Example:
  wingspread run campaign.json --out results/first --runs 2000 --threads 4
  wingspread run campaign.json --out results/part2 --shard 2/5
  wingspread run campaign.json --out results/sure --until "root.peak_moment@0.99 2%")");
}

} // namespace

void add_run(CLI::App& app, Action& action) {
  add_command<RunOptions>(app, action, "run", "Run a campaign into a results folder",
                          add_run_options, run);
}

} // namespace wingspread
