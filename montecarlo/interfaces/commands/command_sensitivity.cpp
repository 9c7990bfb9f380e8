#include "montecarlo/analyses/sensitivity/design_folder.hpp"
#include "montecarlo/analyses/sensitivity/rank_report.hpp"
#include "montecarlo/analyses/sensitivity/sobol_report.hpp"
#include "montecarlo/engine/mpi/evaluator_of.hpp"
#include "montecarlo/engine/runs/campaign_check.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/platform/progress.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/results_display.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/input_checks/requirement_checks.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace wingspread {
namespace {

struct SensitivityOptions {
  std::filesystem::path from, out;
  std::string of_case;
  std::optional<long> samples;
  std::optional<std::uint64_t> seed;
  std::optional<double> confidence;
  std::string shard;
  std::optional<long> resamples;
  MachineOptions machine;
  bool resume = false, json = false, all = false;
  bool files_only = false; ///< print the paths of the folder's files, no table
};

/// Refuses the options for making runs, because a results folder already has its runs.
void refuse_run_options(const SensitivityOptions& options) {
  std::vector<Problem> problems;
  const auto refuse = [&](bool given, const char* option) {
    if (given)
      problems.push_back({"", option, "this option with a results folder",
                          "it only with a campaign's file: a folder already has its runs"});
  };
  refuse(options.samples.has_value(), "--samples");
  refuse(options.seed.has_value(), "--seed");
  refuse(options.resume, "--resume");
  refuse(!options.shard.empty(), "--shard");
  if (options.resamples && !is_design_folder(options.from))
    problems.push_back({"", "--resamples", "this option with the folder of a campaign",
                        "it only for Sobol' indices: rank correlations have no bootstrap"});
  if (!problems.empty()) throw SpecError(std::move(problems));
}

/// "panel_3 · cold": the scene, and the case that the runs are of.
std::string title_of(const Campaign& campaign) {
  return campaign.scene.name + (campaign.of_case.empty() ? "" : " · " + campaign.of_case);
}

/// Locks the folder that is analyzed and the one that is written: --out, new, empty or left by this command's interruption;
/// without --out the same folder.
class AnalysisFolders {
public:
  explicit AnalysisFolders(const SensitivityOptions& options)
      : to_(options.out.empty() ? options.from : options.out) {
    const bool elsewhere = !options.out.empty();
    std::error_code none; // of a path that is not there
    const bool interrupted = elsewhere &&
                             !std::filesystem::equivalent(options.from, options.out, none) &&
                             std::filesystem::exists(options.out / sensitivity_json_file) &&
                             !std::filesystem::exists(options.out / sensitivity_csv_file);
    if (elsewhere && !interrupted) refuse_used_folder(options.out, "a new or an empty folder");
    from_.emplace(options.from, elsewhere ? FolderLock::For::reading : FolderLock::For::writing,
                  "a folder that can be written; --out DIR writes the tables elsewhere");
    if (elsewhere) other_.emplace(options.out);
  }
  [[nodiscard]] const std::filesystem::path& to() const { return to_; }

private:
  std::filesystem::path to_;
  std::optional<FolderLock> from_, other_;
};

/// Prints the analysis and, with a folder, writes sensitivity.json and sensitivity.csv.
template <class Sensitivity>
void show_analysis(const Sensitivity& all, const Json& about, const std::string& title,
                   const std::filesystem::path& folder, const SensitivityOptions& options) {
  const std::string text = json_text(sensitivity_json(all, about));
  if (!folder.empty()) {
    const bool elsewhere = std::filesystem::is_directory(options.from) && folder != options.from;
    if (elsewhere && read_text(folder / sensitivity_json_file).value_or(text) != text)
      refuse_used_folder(folder, "a new or an empty folder"); // the file is of another analysis
    write_file(folder / sensitivity_json_file, text);
    write_file(folder / sensitivity_csv_file, sensitivity_csv(all));
  }
  if (options.json)
    fmt::print("{}", text);
  else if (options.files_only)
    for (const char* file :
         {design_file, design_runs_file, sensitivity_json_file, sensitivity_csv_file})
      fmt::print("{}\n", (folder / file).string());
  else
    fmt::print("{}", options.all ? sensitivity_table(all, title) : moved_by_table(all, title));
  for (const std::string& warning : warnings(all)) print_message("warning: {}\n", warning);
}

/// Rank correlations of a results folder.
int analyze_ranks(const SensitivityOptions& options) {
  refuse_run_options(options);
  const StoredCampaign stored = read_stored_campaign(options.from);
  const AnalysisFolders folders(options);
  const Results results = read_stored_results(stored).results;
  const double confidence = confidence_of(options.confidence, stored.campaign.statistics);
  Json about = stamp_json(stored.stamp);
  std::string part = stored.stamp.shard ? " · " + describe(stored.stamp.shard) : "";
  if (!is_complete(stored, results)) {
    about["partial"] = {{"done", results.size()}, {"of", stored.runs().size()}};
    part += fmt::format(" · partial, of {} runs", stored.runs().size());
  }
  warn_of_preview(stored);
  RunsMade made{replication_of(stored.campaign.sampling, results),
                interim_analyses(stored.campaign)};
  made.never_final = why_never_final(stored.campaign);
  for (const Dispersion& each : stored.campaign.dispersions)
    if (!each.rows.empty()) made.rows[each.rows].push_back(each.name);
  show_analysis(rank_sensitivity(results, confidence, made), about,
                fmt::format("{} · {}{} · rank correlations", title_of(stored.campaign),
                            counted(static_cast<long>(results.size()), "run", "runs"), part),
                folders.to(), options);
  return report_failed(std::ranges::count(results.status, Status::failed),
                       std::ssize(results.runs));
}

/// Sobol' indices of a complete design.
int analyze_design(const SaltelliDesign& design, const Results& results,
                   const SensitivityOptions& options, const std::filesystem::path& folder) {
  const Sampling& sampling = design.campaign.sampling;
  const std::string kind(design_names[static_cast<std::size_t>(sampling.design)]);
  const int replicates =
      has_replicates(sampling) ? static_cast<int>(saltelli_replicates(sampling, design.rows)) : 0;
  const auto given = [](const auto& option, const auto& of_design) {
    return option ? option : of_design;
  };
  const SobolBounds bounds{
      confidence_of(given(options.confidence, design.bounds.confidence),
                    design.campaign.statistics),
      replicates,
      given(options.resamples, design.bounds.resamples).value_or(SobolBounds().resamples),
      sampling.seed};
  SobolSensitivity all = sobol_sensitivity(
      results, coordinates_of(design.campaign.dispersions).names, design.rows, kind, bounds);
  all.never_final = why_never_final(design.campaign);
  show_analysis(all, stamp_json(stamp_of(design)),
                fmt::format("{} · {} samples, {} runs · {}, seed {} · Sobol' indices",
                            title_of(design.campaign), design.rows, results.size(), kind,
                            sampling.seed),
                folder, options);
  return report_failed(std::ranges::count(results.status, Status::failed),
                       std::ssize(results.runs));
}

/// Sobol' indices of a design's folder.
int analyze_design_folder(const SensitivityOptions& options) {
  refuse_run_options(options);
  if (!options.of_case.empty())
    throw SpecError({{"", "--case", fmt::format("\"{}\", with a design's folder", options.of_case),
                      "no case: the design is of one"}});
  const SaltelliDesign design = read_design(options.from);
  if (design.shard)
    throw SpecError({{options.from.string(), "", describe(design.shard) + " of a design",
                      "a whole design: `wingspread merge` merges shards"}});
  const AnalysisFolders folders(options);
  const RunPlan plan = saltelli_plan(design.campaign, design.rows);
  return analyze_design(design, read_design_runs(options.from, plan).results, options,
                        folders.to());
}

/// Makes the remaining runs of a design. @return whether they were interrupted
bool make_design_runs(const RunPlan& plan, RunRange own, RunRange remaining, const ThreadPool& pool,
                      const BatchSink& sink) {
  const Interrupt interrupt;
  Progress progress(stderr);
  const long before = remaining.first - own.first;
  RunCounts counts{.done = before, .total = own.size(), .before = before};
  const auto keep = [&](const Batch& batch) {
    sink.take(batch);
    counts.done += std::ssize(batch.rows);
    progress.show(counts);
  };
  return evaluator_of(pool, interrupt.flag())->make(plan, remaining, {keep, sink.wants_csv}) <
         remaining.size();
}

/// Reads a design's file, to make another shard of its runs.
SaltelliDesign read_given_design(const SensitivityOptions& options) {
  if (options.samples || options.seed || !options.of_case.empty())
    throw SpecError({{options.from.string(), "", "a design's file with --samples, --seed or --case",
                      "none of these options: the design has its own values"}});
  return read_design_file(options.from);
}

SaltelliDesign new_design(const SensitivityOptions& options) {
  const Campaign whole = read_campaign_file(options.from);
  print_warnings(check_campaign(whole, options.from), false);
  SaltelliDesign design{chosen_case(whole, options.of_case), options.samples.value_or(1000),
                        std::nullopt};
  override_sampling(design.campaign, std::nullopt, options.seed);
  return design;
}

SaltelliDesign design_of(const SensitivityOptions& options) {
  if (!options.shard.empty() && options.out.empty())
    throw SpecError({{"", "--shard", "--shard without --out", "the folder for its runs in --out"}});
  if (options.resume && options.out.empty())
    throw SpecError(
        {{"", "--resume", "--resume without --out", "the folder of the study in --out"}});
  SaltelliDesign design =
      is_design_file(options.from) ? read_given_design(options) : new_design(options);
  design.shard = parse_shard(options.shard);
  if (options.resamples) design.bounds.resamples = options.resamples;
  if (options.confidence) design.bounds.confidence = options.confidence;
  return design;
}

/// Prints the files of a shard. @return the exit status
int show_shard(const SaltelliDesign& design, const Results& results,
               const std::filesystem::path& folder) {
  fmt::print("{}\n{}\n", (folder / design_file).string(), (folder / design_runs_file).string());
  print_message("note: {} of the design's runs is complete; `wingspread merge` merges all shards\n",
                describe(design.shard));
  return report_failed(std::ranges::count(results.status, Status::failed),
                       std::ssize(results.runs));
}

/// Makes a design's runs, then its Sobol' indices.
int run_design(const SensitivityOptions& options) {
  const ThreadPool pool = pool_of(options.machine);
  const SaltelliDesign design = design_of(options);
  const RunPlan plan = saltelli_plan(design.campaign, design.rows);
  const long runs = saltelli_runs(design.rows, plan.coordinates().names.size());
  if (runs > most_runs)
    throw SpecError({{"", "--samples", fmt::format("{}, which take {} runs", design.rows, runs),
                      fmt::format("at most {} runs", most_runs)}});
  std::optional<DesignFolderWriter> folder;
  if (!options.out.empty()) folder.emplace(options.out, design, plan, options.resume);
  Results kept(plan.names());
  const auto keep = [&](const Batch& batch) {
    if (folder) return folder->add(batch);
    for (const ResultRow& row : batch.rows) kept.append(row);
  };
  const RunRange own = runs_of(design);
  const RunRange remaining{own.first + (folder ? folder->count() : 0), own.last};
  const bool interrupted = make_design_runs(plan, own, remaining, pool, {keep, folder.has_value()});
  if (folder) folder->finish();
  if (interrupted) {
    print_message(
        "interrupted: {}\n",
        folder ? fmt::format("{} of {} runs are kept; the same command with --resume continues",
                             folder->count(), own.size())
               : "nothing is kept without --out");
    return exit_code::interrupted;
  }
  if (design.shard) return show_shard(design, folder->results(), options.out);
  return analyze_design(design, folder ? folder->results() : kept, options, options.out);
}

int sensitivity(const SensitivityOptions& given) {
  if (!std::filesystem::is_directory(given.from)) {
    try {
      return run_design(given);
    } catch (const SpecError& error) {
      throw in_file(error, given.from);
    }
  }
  if (is_design_folder(given.from)) return analyze_design_folder(given);
  SensitivityOptions options = given;
  options.from = folder_of_case(given.from, given.of_case);
  return analyze_ranks(options);
}

void add_sensitivity_options(CLI::App& command, SensitivityOptions& options) {
  command.add_option("from", options.from, "A results folder, a campaign's file, or a design.json")
      ->required();
  within(command.add_option("--samples", options.samples,
                            "Rows of the design (see below); default: 1000"),
         2, most_runs)
      ->type_name("N");
  add_seed_option(command, options.seed);
  add_case_option(command, options.of_case);
  add_confidence_option(command, options.confidence);
  within(command.add_option("--resamples", options.resamples, "Bootstrap resamples; default: 1000"),
         20, 1'000'000)
      ->type_name("N");
  command.add_option("--out", options.out,
                     "For a campaign's runs, or a folder's tables: a folder, new or empty");
  command.add_flag("--resume", options.resume, "Continue an interrupted study in --out");
  add_shard_option(command, options.shard,
                   "Make only part I of N of the design's runs, e.g. 2/5; needs --out");
  add_machine_options(command, options.machine);
  command.add_flag("--json", options.json, "Print JSON, not a table");
  command.add_flag("--all", options.all, "Print every output's table with bounds");
  command.footer(
      R"(From a results folder: Spearman's and partial rank correlations of every output with every
dispersion, over the runs that have the output. They show which outputs rise or fall with which
dispersions.

From a campaign's file: Sobol' indices, from runs of their own (a Saltelli design, drawn as the
campaign is). The first-order index is the share of an output's variance that one dispersion causes
alone; the total index includes its interactions. N samples take N (d + 2) runs for d dispersions.
With the sobol design, N should be a power of two.

Bounds of draws that depend on each other (latin_hypercube, sobol) come from the design's
replicates; one replicate gives none. An output that is missing at some point of a design has no
Sobol' indices.

The runs of a design can be made in shards, each with --out and --shard; `wingspread merge` gives
the folder that making all runs at once gives, byte for byte. The folder keeps --resamples and
--confidence, for `merge` and for tables made again.

Both analyses name for each output the dispersions that move it, the most important first: at most
five, with a rank correlation of 0.2 or more or 2 % of the variance, and at least a quarter of the
largest; others with visible effect are counted. --all prints every coefficient with its bounds.
sensitivity.json and sensitivity.csv in the folder, or in --out, have all of them. A warning names
each dispersion that moves no output.
Effects on peaks that t_end cut are those on the values up to t_end: a warning gives the number of
runs, and says whether a longer t_end decides them.

Example:
  wingspread sensitivity results/first
  wingspread sensitivity campaign.json --samples 1024 --out results/sobol)");
}

} // namespace

int show_design(const std::filesystem::path& folder, const Display& display) {
  SensitivityOptions options;
  options.from = folder;
  options.all = display.all;
  options.files_only = !wants_table(display);
  return analyze_design_folder(options);
}

void add_sensitivity(CLI::App& app, Action& action) {
  add_command<SensitivityOptions>(app, action, "sensitivity",
                                  "Show which dispersions move which outputs, and how much",
                                  add_sensitivity_options, sensitivity);
}

} // namespace wingspread
