#include "montecarlo/analyses/sensitivity/design_folder.hpp"
#include "montecarlo/analyses/sensitivity/rank_report.hpp"
#include "montecarlo/analyses/sensitivity/sobol_report.hpp"
#include "montecarlo/engine/mpi/evaluator_of.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/json.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/platform/progress.hpp"
#include "montecarlo/interfaces/commands/commands.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/results_display.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace wingspread {
namespace {

struct SensitivityOptions {
  std::filesystem::path from, out;
  std::string of_case;
  std::optional<long> samples;
  std::optional<std::uint64_t> seed;
  std::optional<double> confidence;
  std::string shard;
  long resamples = 1000;
  CrewOptions crew;
  bool resume = false, json = false;
};

/// The options that only the runs of a design have a use for.
void refuse_run_options(const SensitivityOptions& options) {
  std::vector<Problem> problems;
  const auto refuse = [&](bool given, const char* option) {
    if (given)
      problems.push_back({"", option, "it with a folder",
                          "it with a campaign's file: the runs of "
                          "a folder are made"});
  };
  refuse(options.samples.has_value(), "--samples");
  refuse(options.seed.has_value(), "--seed");
  refuse(!options.out.empty(), "--out");
  refuse(options.resume, "--resume");
  refuse(!options.shard.empty(), "--shard");
  if (!problems.empty()) throw SpecError(std::move(problems));
}

double confidence_of(const SensitivityOptions& options, StatisticsSpec spec) {
  Json given = Json::object();
  if (options.confidence) given["confidence"] = *options.confidence;
  override_settings(given, [&](const JsonCursor& at) { read_statistics(at, spec); });
  return spec.confidence;
}

/// Prints the analysis, and writes its two files where there is a folder.
template <class Sensitivity>
void show(const Sensitivity& all, const Json& about, const std::string& title,
          const std::filesystem::path& folder, bool json) {
  const std::string text = json_text(sensitivity_json(all, about));
  if (!folder.empty()) {
    write_file(folder / sensitivity_json_file, text);
    write_file(folder / sensitivity_csv_file, sensitivity_csv(all));
  }
  fmt::print("{}", json ? text : sensitivity_table(all, title));
  for (const std::string& warning : warnings(all)) fmt::print(stderr, "warning: {}\n", warning);
}

int rank(const SensitivityOptions& options) {
  refuse_run_options(options);
  const StoredCampaign stored = read_stored_campaign(options.from);
  const FolderLock lock(options.from);
  const Results results = read_stored_results(stored).results;
  const double confidence = confidence_of(options, stored.campaign.statistics);
  Stamp stamp = stored.stamp;
  stamp.shard.reset();
  warn_of_preview(stored);
  const RunsMade made{replication_of(stored.campaign.sampling, results),
                      count_looks(stored.campaign)};
  show(rank_sensitivity(results, confidence, made), stamp_json(stamp),
       fmt::format("{} · {} runs · rank correlations", stored.campaign.scene.name, results.size()),
       options.from, options.json);
  return exit_code::done;
}

int sobol(const SaltelliDesign& design, const Results& results, const SensitivityOptions& options,
          const std::filesystem::path& folder) {
  const Sampling& sampling = design.campaign.sampling;
  const std::string kind(design_names[static_cast<std::size_t>(sampling.design)]);
  const int replicates =
      has_replicates(sampling) ? static_cast<int>(saltelli_replicates(sampling, design.rows)) : 0;
  const SobolBounds bounds{confidence_of(options, design.campaign.statistics), replicates,
                           options.resamples, sampling.seed};
  show(sobol_sensitivity(results, design.rows, kind, bounds), stamp_json(stamp_of(design)),
       fmt::format("{} · {} samples, {} runs · {}, seed {} · Sobol' indices",
                   design.campaign.scene.name, design.rows, results.size(), kind, sampling.seed),
       folder, options.json);
  return report_failed(std::ranges::count(results.status, Status::failed),
                       std::ssize(results.runs));
}

int sobol_again(const SensitivityOptions& options) {
  refuse_run_options(options);
  const SaltelliDesign design = read_design(options.from);
  if (design.shard)
    throw SpecError({{options.from.string(), "", describe(design.shard) + " of a design",
                      "all of its runs: `wingspread merge` puts shards together"}});
  const FolderLock lock(options.from);
  const RunPlan plan = saltelli_plan(design.campaign, design.rows);
  return sobol(design, read_design_runs(options.from, plan).results, options, options.from);
}

/// Makes the runs that are left. @return whether it was interrupted
bool make_runs_of(const RunPlan& plan, RunRange own, RunRange remaining, const ThreadPool& crew,
                  const BatchSink& sink) {
  const Interrupt interrupt;
  Progress progress(stderr);
  const long before = remaining.first - own.first;
  Tally tally{.done = before, .total = own.size(), .before = before};
  const auto keep = [&](const Batch& batch) {
    sink.take(batch);
    tally.done += std::ssize(batch.rows);
    progress.show(tally);
  };
  return evaluator_of(crew, interrupt.flag())->make(plan, remaining, {keep, sink.wants_csv}) <
         remaining.size();
}

/// A design that a folder has, another part of which is to be made.
SaltelliDesign design_again(const SensitivityOptions& options) {
  if (options.samples || options.seed || !options.of_case.empty())
    throw SpecError({{options.from.string(), "", "a design's file with --samples, --seed or --case",
                      "it without them: the design has its own"}});
  return read_design_file(options.from);
}

SaltelliDesign new_design(const SensitivityOptions& options) {
  SaltelliDesign design{chosen_case(read_campaign_file(options.from), options.of_case),
                        options.samples.value_or(1000), std::nullopt};
  override_sampling(design.campaign, std::nullopt, options.seed);
  return design;
}

SaltelliDesign design_of(const SensitivityOptions& options) {
  if (!options.shard.empty() && options.out.empty())
    throw SpecError({{"", "--shard", "no --out", "the folder for its runs"}});
  SaltelliDesign design =
      is_design_file(options.from) ? design_again(options) : new_design(options);
  design.shard = parse_shard(options.shard);
  return design;
}

/// What a shard comes to: its runs.
int show_shard(const SaltelliDesign& design, const Results& results,
               const std::filesystem::path& folder) {
  fmt::print("{}\n{}\n", (folder / design_file).string(), (folder / design_runs_file).string());
  fmt::print(stderr, "note: {} of the design's runs: `wingspread merge` puts all shards together\n",
             describe(design.shard));
  return report_failed(std::ranges::count(results.status, Status::failed),
                       std::ssize(results.runs));
}

int sobol_new(const SensitivityOptions& options) {
  const ThreadPool crew = crew_of(options.crew);
  const SaltelliDesign design = design_of(options);
  const RunPlan plan = saltelli_plan(design.campaign, design.rows);
  const long runs = saltelli_runs(design.rows, design.campaign.dispersions.size());
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
  const bool interrupted = make_runs_of(plan, own, remaining, crew, {keep, folder.has_value()});
  if (folder) folder->finish();
  if (interrupted) {
    fmt::print(stderr, "interrupted: {}\n",
               folder
                   ? fmt::format("{} of {} runs are kept; the same command with --resume goes on",
                                 folder->count(), own.size())
                   : "nothing is kept without --out");
    return exit_code::interrupted;
  }
  if (design.shard) return show_shard(design, folder->results(), options.out);
  return sobol(design, folder ? folder->results() : kept, options, options.out);
}

int sensitivity(const SensitivityOptions& given) {
  if (!std::filesystem::is_directory(given.from)) return sobol_new(given);
  if (is_design_folder(given.from)) return sobol_again(given);
  SensitivityOptions options = given;
  options.from = folder_of_case(given.from, given.of_case);
  return rank(options);
}

} // namespace

int show_design(const std::filesystem::path& folder) {
  SensitivityOptions options;
  options.from = folder;
  return sobol_again(options);
}

void add_sensitivity(CLI::App& app, Action& action) {
  const auto options = std::make_shared<SensitivityOptions>();
  CLI::App* command =
      app.add_subcommand("sensitivity", "Which dispersions move which outputs, and how much");
  command
      ->add_option("from", options->from,
                   "A results folder, or a campaign's file (or a design.json)")
      ->required();
  command
      ->add_option("--samples", options->samples,
                   "Of a campaign's file: rows of the design, 1000 if left out (see below)")
      ->check(CLI::Range(2L, long{most_runs}).description(""))
      ->type_name("N");
  add_seed_option(*command, options->seed);
  add_case_option(*command, options->of_case);
  command->add_option("--confidence", options->confidence, "Of all bounds, e.g. 0.99");
  command->add_option("--resamples", options->resamples, "Of the bootstrap; 1000 if left out")
      ->check(CLI::Range(20L, 1'000'000L).description(""))
      ->type_name("N");
  command->add_option("--out", options->out,
                      "Of a campaign's file: the folder to keep its runs in");
  command->add_flag("--resume", options->resume, "Go on where an earlier run into it stopped");
  command
      ->add_option("--shard", options->shard,
                   "Of a campaign's file: only part I of N of the design's runs, e.g. 2/5")
      ->type_name("I/N")
      ->check(refuse_shard);
  add_crew_options(*command, options->crew);
  command->add_flag("--json", options->json, "Print JSON in place of the table");
  command->footer(
      R"(From a results folder: Spearman's and partial rank correlations of every output with every
dispersion, over the runs that have the output. They show what rises or falls with what.

From a campaign's file: Sobol' indices, by runs of their own (a Saltelli design, drawn as the
campaign is). The first-order index is the share of an output's variance that a dispersion is behind
alone, the total index the share that it has a part in. N samples take N (d + 2) runs for d
dispersions. With the sobol design, take a power of two.

Bounds of draws that depend on each other (latin_hypercube, sobol) come from the design's
replicates, and there are none with one. An output that did not happen at some point of a design
has no Sobol' indices.

The runs of a design can be made in shards, each with --out and --shard; `wingspread merge` makes of
their folders the one that making all at once gives, byte for byte.

In both, what matters most stands first; sensitivity.json and sensitivity.csv, in the folder if
there is one, have all of it. A dispersion that moves no output is named on standard error.

Example:
  wingspread sensitivity results/first
  wingspread sensitivity campaign.json --samples 1024 --out results/sobol)");
  command->callback([options, &action] { action = [options] { return sensitivity(*options); }; });
}

} // namespace wingspread
