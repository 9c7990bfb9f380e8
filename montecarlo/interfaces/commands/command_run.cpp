#include "montecarlo/engine/mpi/evaluator_of.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/number_text.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/platform/live_histogram.hpp"
#include "montecarlo/foundation/platform/progress.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/interfaces/commands/commands.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/overall_progress.hpp"
#include "montecarlo/interfaces/terminal/results_display.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/input_checks/examine.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "montecarlo/results/results_folder/folder_writer.hpp"
#include "montecarlo/results/streaming/streaming_folder.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>
#include <unistd.h>
#include <utility>
#ifdef __GLIBC__
#include <gnu/libc-version.h>
#endif

namespace wingspread {
namespace {

struct RunOptions {
  std::filesystem::path campaign, out;
  SamplingOptions sampling;
  CrewOptions crew;
  bool resume = false, strict = false, no_rows = false;
  std::string shard;
  std::vector<std::string> until, set, cases;
  Display display;
};

std::string host_name() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 ? name : "";
}

/// Whose exp, log and sin draws and runs are made of: what "the same bytes" presumes.
std::string math_library() {
#ifdef __GLIBC__
  return fmt::format("glibc {}", gnu_get_libc_version());
#else
  return "unknown";
#endif
}

/// timing.json: what this session did and on what.
std::string timing_text(const Tally& tally, double seconds, const ThreadPool& crew,
                        const Evaluator& evaluator, bool interrupted) {
  const long made = tally.done - tally.before;
  const Occupancy& lanes = evaluator.occupancy();
  return json_text({{"host", host_name()},
                    {"math_library", math_library()},
                    {"processors", std::thread::hardware_concurrency()},
                    {"ranks", evaluator.ranks()},
                    {"threads", thread_count(crew.threads)},
                    {"instruction_set", to_string(crew.set)},
                    {"lanes", lanes_of(crew.set)},
                    {"lane_occupancy", lanes.tries > 0 ? Json(static_cast<double>(lanes.busy) /
                                                              static_cast<double>(lanes.tries))
                                                       : Json()},
                    {"runs", made},
                    {"runs_before", tally.before},
                    {"seconds", seconds},
                    {"runs_per_second", static_cast<double>(made) / std::max(seconds, 1e-9)},
                    {"interrupted", interrupted}});
}

void count(const Results& results, Tally& tally) {
  tally.done = std::ssize(results.runs);
  tally.invalid = std::ranges::count(results.status, Status::invalid);
  tally.failed = std::ranges::count(results.status, Status::failed);
  tally.stalled = std::ranges::count(results.status, Status::stalled);
  tally.timed_out = std::ranges::count(results.status, Status::timed_out);
}

void count(const Batch& batch, Tally& tally) {
  tally.done += std::ssize(batch.rows);
  tally.invalid += std::ranges::count(batch.rows, Status::invalid, &ResultRow::status);
  tally.failed += std::ranges::count(batch.rows, Status::failed, &ResultRow::status);
  tally.stalled += std::ranges::count(batch.rows, Status::stalled, &ResultRow::status);
  tally.timed_out += std::ranges::count(batch.rows, Status::timed_out, &ResultRow::status);
}

/// The column of outputs that is drawn as runs are made: the first that is required, else the deployment time.
std::size_t watched_output(const RunPlan& plan) {
  const std::vector<std::string>& outputs = plan.names().outputs;
  for (const Requirement& requirement : plan.campaign().requirements)
    if (const auto found = std::ranges::find(outputs, requirement.output); found != outputs.end())
      return static_cast<std::size_t>(found - outputs.begin());
  return outputs.size() - 1;
}

/// What there is before the first run is made. @return false when it was stopped in the pilot
bool begin(const FolderWriter& folder, Evaluator& /*evaluator*/, Tally& tally) {
  count(folder.results(), tally);
  tally.before = tally.done;
  return true;
}
bool begin(StreamingFolder& folder, Evaluator& evaluator, Tally& tally) {
  if (!folder.begin(evaluator)) return false;
  const StreamingStatistics& made = folder.statistics();
  tally.done = made.runs();
  tally.invalid = made.count_of(Status::invalid);
  tally.failed = made.count_of(Status::failed);
  tally.stalled = made.count_of(Status::stalled);
  tally.timed_out = made.count_of(Status::timed_out);
  tally.before = folder.resumed();
  return true;
}

/// Makes the runs that are left. @return whether it was interrupted
template <class Folder>
bool make_remaining(Folder& folder, const RunPlan& plan, const ThreadPool& crew,
                    const Interrupt& interrupt, OverallProgress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const auto evaluator = evaluator_of(crew, interrupt.flag());
  Tally tally{.total = folder.stored().runs().size()};
  if (!begin(folder, *evaluator, tally)) return true;
  const std::size_t watched = watched_output(plan);
  const std::string& name = plan.names().outputs[watched];
  LiveHistogram histogram(name, parse_output_name(name).unit);
  progress.show(tally);
  const auto keep = [&](const Batch& batch) {
    folder.add(batch);
    count(batch, tally);
    for (const ResultRow& row : batch.rows) histogram.add(row.outputs[watched]);
    tally.picture = histogram.text();
    progress.show(tally);
  };
  bool interrupted = false;
  while (!interrupted) {
    const RunRange remaining = folder.remaining();
    if (remaining.size() == 0) break;
    interrupted = evaluator->make(plan, remaining, {keep, Folder::wants_csv}) < remaining.size();
  }
  folder.finish();
  if (!interrupted) progress.close(tally);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  write_file(folder.stored().folder / timing_file,
             timing_text(tally, seconds.count(), crew, *evaluator, interrupted));
  return interrupted;
}

/// The goals at which to stop, in place of the campaign's; as it is where none are given.
void override_until(Campaign& campaign, const std::vector<std::string>& until) {
  if (until.empty()) return;
  Json goals = Json::array();
  for (const std::string& text : until) goals.push_back(parse_stopping_goal(text).value());
  override_settings({{"until", goals}},
                    [&](const JsonCursor& at) { override_stopping(campaign, at.member("until")); });
}

std::string refuse_until(const std::string& text) {
  if (parse_stopping_goal(text)) return "";
  return fmt::format("found \"{}\", expected e.g. \"root.peak_moment@0.99 5\" (its 0.99 quantile "
                     "known to within 5 N·m), \"root.peak_moment@0.99 2%\", \"deployed 0.01\" or "
                     "\"requirement deployed\"",
                     text);
}

/// The statistics of what there is, which can be made later as well.
Summary write_summary(const FolderWriter& folder, int threads, const std::string& kept) {
  const StoredCampaign& stored = folder.stored();
  try {
    return write_statistics(stored, folder.results(), stored.campaign.statistics, threads);
  } catch (const MachineError& error) {
    throw MachineError(
        fmt::format("{}\n{}, without their statistics: `wingspread analyze {}` makes "
                    "them where there is room",
                    error.what(), kept, stored.folder.string()));
  }
}

Summary write_summary(const StreamingFolder& folder, int /*threads*/, const std::string& /*kept*/) {
  return write_streaming_statistics(folder.stored(), folder.statistics(),
                                    folder.stored().campaign.statistics);
}

/// Adds to timing.json what it took to know the accuracy.
void note_accuracy(const std::filesystem::path& folder, const Summary& summary) {
  if (!summary.accuracy) return;
  Json timing = parse_json_file(folder / timing_file);
  timing["accuracy"] = {{"runs", summary.accuracy->runs}, {"seconds", summary.accuracy->seconds}};
  write_file(folder / timing_file, json_text(timing));
}

/// Makes a campaign's runs into a folder, and shows what they come to.
/// @param show takes the results and returns the exit status
template <class Folder, class Show>
int run_into(const Campaign& campaign, const std::filesystem::path& out, const RunOptions& options,
             OverallProgress& progress, const Show& show) {
  const RunPlan plan(campaign);
  Folder folder(out, plan, parse_shard(options.shard), options.resume);
  std::string interruption; // outlives the interrupt that says it
  Interrupt interrupt;
  const bool interrupted = make_remaining(folder, plan, crew_of(options.crew), interrupt, progress);
  if (interrupted) progress.pause();
  const std::string of_case = campaign.of_case.empty() ? "" : " of case " + campaign.of_case;
  const std::string kept = fmt::format("{} of {} runs{} are kept", folder.count(),
                                       folder.stored().runs().size(), of_case);
  interruption = fmt::format("interrupted: {}; the same command with --resume goes on\n", kept);
  interrupt.end_at_once(interruption.c_str());
  if (!interrupt.is_urgent() && !(interrupted && folder.count() == 0)) {
    Summary summary = write_summary(folder, options.crew.threads, kept);
    note_accuracy(out, summary);
    const int code = show(folder.stored(), std::move(summary));
    if (!interrupted) return code;
  }
  fmt::print(stderr, "{}", interruption);
  return exit_code::interrupted;
}

/// Each case into a folder of its own, one after the other.
int run_cases(const Campaign& campaign, const RunOptions& options) {
  const std::vector<CaseSpec> chosen = chosen_cases(campaign, options.cases);
  const CasesFolder folder(options.out, campaign, parse_shard(options.shard), options.resume);
  std::filesystem::remove(options.out / cases_file); // it will be of other runs
  OverallProgress progress(std::ssize(chosen) *
                           shard_runs(campaign.sampling.runs, parse_shard(options.shard)).size());
  std::vector<CaseSummary> made;
  std::vector<StoredCampaign> folders; // of each
  const auto judge_all = [&] {         // when nothing is to be shown in one line any more
    progress.pause();
    int worst = exit_code::done;
    for (std::size_t i = 0; i < made.size(); ++i)
      worst = std::max(worst, judge_results(folders[i], made[i].summary));
    return worst;
  };
  for (const CaseSpec& spec : chosen) {
    const auto show = [&](const StoredCampaign& stored, Summary&& summary) {
      if (options.display.histograms) {
        progress.pause();
        show_table(stored, summary, options.display);
      }
      folders.push_back(stored);
      made.push_back(case_summary(stored, std::move(summary)));
      return exit_code::done;
    };
    const int code = run_into<FolderWriter>(campaign_of_case(campaign, spec),
                                            options.out / spec.name, options, progress, show);
    if (code != exit_code::interrupted) continue;
    (void)judge_all();
    return code;
  }
  const int worst = judge_all();
  const std::vector<CaseSummary> all = complete_cases(folder.stored(), std::move(made));
  write_cases_file(folder.stored(), all, options.out);
  show_cases(folder.stored(), all, options.display);
  return worst;
}

int run(const RunOptions& options) {
  (void)crew_of(options.crew); // refused before anything is read
  Campaign campaign = read_campaign_file(options.campaign);
  change_scene(campaign, options.set);
  override_sampling(campaign, options.sampling.runs, options.sampling.seed);
  override_until(campaign, options.until);
  heed(examine(campaign, options.campaign), options.strict);
  if (!options.no_rows && !campaign.cases.empty()) return run_cases(campaign, options);
  if (campaign.cases.empty()) (void)chosen_cases(campaign, options.cases); // there are none
  OverallProgress progress(shard_runs(campaign.sampling.runs, parse_shard(options.shard)).size());
  const auto show = [&](const StoredCampaign& stored, const Summary& summary) {
    progress.pause();
    return show_results(stored, summary, options.display);
  };
  return options.no_rows ? run_into<StreamingFolder>(campaign, options.out, options, progress, show)
                         : run_into<FolderWriter>(campaign, options.out, options, progress, show);
}

} // namespace

void add_run(CLI::App& app, Action& action) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Run a campaign into a results folder");
  command->add_option("campaign", options->campaign, "The campaign, a JSON file")->required();
  command->add_option("--out", options->out, "The results folder: new, or empty")->required();
  add_sampling_options(*command, options->sampling);
  add_crew_options(*command, options->crew);
  command->add_flag("--resume", options->resume,
                    "Go on where an earlier run stopped, or with more --runs");
  command->add_option("--shard", options->shard, "Only part I of N of the runs, e.g. 2/5")
      ->type_name("I/N")
      ->check(refuse_shard);
  command
      ->add_option("--until", options->until,
                   "Stop when so much is known, e.g. \"deployed 0.01\" (see below)")
      ->type_name("GOAL")
      ->allow_extra_args(false)
      ->check(refuse_until);
  command->add_flag("--no-rows", options->no_rows,
                    "Keep no rows but those of broken runs: for very many runs (see below)");
  add_set_option(*command, options->set);
  command
      ->add_option("--case", options->cases,
                   "Of a campaign with cases only this one; several times if wanted")
      ->type_name("NAME")
      ->allow_extra_args(false);
  add_strict_option(*command, options->strict);
  add_display_options(*command, options->display);
  command->footer(
      std::string("Progress goes to standard error, if that is a terminal.\n") + display_help +
      R"(The results do not depend on threads, lanes, instruction sets, shards and interruptions.
Exit code 1 says that a requirement of the campaign is not shown to be met.

Of a campaign with cases the folder gets a results folder for each of them, all made with the same
draws, and cases.json with the cases side by side; the exit code is the worst of theirs.

--until names an interval and how wide it may be, from its lower to its upper bound, at the
campaign's confidence; several have to be reached together:
  "root.peak_moment@0.99 5"    of the 0.99 quantile, in N·m
  "root.peak_moment@0.99 2%"   the same, as a share of the quantile
  "deployed 0.01"              of the share of runs that deploy (or stall, …: any status)
  "requirement deployed"       not a width: the requirement, by name or output, passed or disproved
They are looked at after 1000, 2000, 4000, … runs and nowhere else, so that a campaign stops at
the same run however it is made; its number of runs is the most it makes. Each look is a chance to
be misled: all bounds and verdicts of such a campaign share their risk out among its checkpoints,
and hold wherever it stopped. Not for shards, nor for draws that depend on each other.

A verdict that fell short is not mended by more runs of the same draws: whoever goes on until one
passes is misled more often than it says. State it in --until, or begin anew with another --seed and
a number of runs fixed beforehand. --resume with more --runs is counted as another look, and the
verdicts are held to that.

With --no-rows there is no runs.csv, and memory and disk do not grow with the number of runs:
counts, moments, the 4096 largest and smallest values of every output with their runs, and verdicts
are those of all rows; other quantiles say how far off they may be. The rows of runs that did not
deploy or break a requirement are kept, in broken_runs.csv. --resume, --shard, merge, replay and
analyze work on such a folder; what takes rows (report, sensitivity, export, --until) refuses it.

Example:
  wingspread run campaign.json --out results/first --runs 2000 --threads 4
  wingspread run campaign.json --out results/part2 --shard 2/5
  wingspread run campaign.json --out results/sure --until "root.peak_moment@0.99 2%")");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

} // namespace wingspread
