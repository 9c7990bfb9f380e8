#include "montecarlo/analyses/sensitivity/design_merge.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/number_text.hpp"
#include "montecarlo/foundation/platform/folder_lock.hpp"
#include "montecarlo/interfaces/commands/commands.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/results_display.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/results/checkpoint/shard_checkpoints.hpp"
#include "montecarlo/results/results_folder/folder_writer.hpp"
#include "montecarlo/results/results_folder/merge.hpp"
#include "montecarlo/results/streaming/streaming_folder.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace wingspread {
namespace {

struct MergeOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path out;
  bool preview = false;
  Display display;
};

struct AnalyzeOptions {
  std::filesystem::path folder, out;
  std::vector<double> quantiles;
  std::optional<double> confidence;
  std::string bins;
  std::filesystem::path requirements;
  Display display;
};

/// What there is to show of all cases. @return the worst exit status
int show_all(const StoredCampaign& whole, const std::vector<CaseSummary>& cases,
             const Display& display) {
  int worst = exit_code::done;
  for (const CaseSummary& each : cases)
    worst = std::max(worst,
                     judge_results(read_stored_campaign(whole.folder / each.name), each.summary));
  show_cases(whole, cases, display);
  return worst;
}

/// The shards of a design for Sobol' indices.
int merge_into_design(const MergeOptions& options) {
  if (options.preview)
    throw SpecError({{options.folders.front().string(), "", "--preview of a design's shards",
                      "it of a campaign's: without all of its points a design has no indices"}});
  merge_designs(options.folders, options.out);
  return show_design(options.out);
}

/// The shards of a campaign without rows.
Summary merge_without_rows(const MergeOptions& options) {
  if (options.preview)
    throw SpecError({{options.folders.front().string(), "", "--preview of shards without rows",
                      "it of shards with rows"}});
  return merge_streaming(options.folders, options.out);
}

int merge(const MergeOptions& options) {
  const MergeKind kind = options.preview ? MergeKind::preview : MergeKind::whole;
  if (is_shard_folder(options.folders.front()))
    throw SpecError({{options.folders.front().string(), "", "a shard of a margin study",
                      "results of `run` or `sensitivity`: `wingspread margin CAMPAIGN.json --from "
                      "DIR… --out DIR` goes on from such shards"}});
  try {
    if (is_design_folder(options.folders.front())) return merge_into_design(options);
    if (is_cases_folder(options.folders.front())) {
      const auto cases = merge_cases(options.folders, options.out, kind);
      return show_all(read_stored_campaign(options.out), cases, options.display);
    }
    const Summary summary = is_streaming_folder(options.folders.front())
                                ? merge_without_rows(options)
                                : merge_folders(options.folders, options.out, kind);
    return show_results(read_stored_campaign(options.out), summary, options.display);
  } catch (const MissingRuns& missing) {
    return refuse_missing(missing, ", or do without: --preview shows what is there");
  }
}

/// A whole number as such, so that it is read as one; anything else as text, to be refused.
Json bins_given(const std::string& text) {
  const auto number = parse_number<std::int64_t>(text);
  return number ? Json(*number) : Json(text);
}

/// The statistics of a folder again. @param to the folder for them
Summary summarize_again(const StoredCampaign& stored, const AnalyzeOptions& options,
                        const std::filesystem::path& to) {
  StatisticsSpec spec = stored.campaign.statistics;
  Json given = Json::object();
  if (!options.quantiles.empty()) given["quantiles"] = options.quantiles;
  if (options.confidence) given["confidence"] = *options.confidence;
  if (!options.bins.empty()) given["bins"] = bins_given(options.bins);
  override_settings(given, [&](const JsonCursor& at) { read_statistics(at, spec); });
  StoredCampaign there = stored;
  there.folder = to;
  make_folder(to);
  if (is_streaming_folder(stored.folder)) {
    if (!options.requirements.empty()) refuse_rowless(stored.folder);
    return write_streaming_statistics(there, read_streaming_statistics(stored).statistics, spec);
  }
  const Results results = read_stored_results(stored).results;
  return write_statistics(there, results, spec);
}

/// The folder's campaign, held to the requirements that were given.
StoredCampaign held_to(StoredCampaign stored, const AnalyzeOptions& options) {
  if (!options.requirements.empty())
    stored.campaign.requirements = read_requirements_file(options.requirements, stored.campaign);
  return stored;
}

/// The results folder is only read where another gets the statistics.
FolderLock::For purpose_of(const AnalyzeOptions& options) {
  return options.out.empty() ? FolderLock::For::writing : FolderLock::For::reading;
}

int analyze_cases(const AnalyzeOptions& options, const std::filesystem::path& to) {
  StoredCampaign whole = read_stored_campaign(options.folder);
  std::vector<CaseSummary> cases;
  for (const CaseSpec& spec : made_cases(whole)) {
    const FolderLock lock(whole.folder / spec.name, purpose_of(options));
    const StoredCampaign stored = held_to(read_stored_campaign(whole.folder / spec.name), options);
    cases.push_back(case_summary(stored, summarize_again(stored, options, to / spec.name)));
  }
  write_cases_file(whole, cases, to);
  return show_all(whole, cases, options.display);
}

int analyze(const AnalyzeOptions& options) {
  (void)read_any_campaign(options.folder); // there is one to be locked
  const bool elsewhere = !options.out.empty();
  if (elsewhere) refuse_used_folder(options.out, "a new or an empty folder");
  const FolderLock lock(options.folder, purpose_of(options));
  std::optional<FolderLock> other;
  if (elsewhere) other.emplace(options.out);
  const std::filesystem::path& to = elsewhere ? options.out : options.folder;
  if (is_cases_folder(options.folder)) return analyze_cases(options, to);
  const StoredCampaign stored = held_to(read_any_campaign(options.folder), options);
  const Summary summary = summarize_again(stored, options, to);
  if (!elsewhere || wants_table(options.display))
    return show_results(stored, summary, options.display);
  for (const char* file : {summary_file, histograms_json_file, histograms_csv_file})
    fmt::print("{}\n", (to / file).string());
  return judge_results(stored, summary);
}

} // namespace

void add_merge(CLI::App& app, Action& action) {
  const auto options = std::make_shared<MergeOptions>();
  CLI::App* command = app.add_subcommand("merge", "Put the shards of a campaign together");
  command->add_option("folders", options->folders, "The shards' results folders, in any order")
      ->required();
  command
      ->add_option("--out", options->out,
                   "The results folder to write: new, empty, or an earlier preview")
      ->required();
  command->add_flag("--preview", options->preview,
                    "Of any of the shards, finished or not: the runs that there are");
  add_display_options(*command, options->display);
  command->footer(
      std::string("The result is what running the campaign in one go gives, byte for "
                  "byte.\n") +
      display_help +
      R"( Where shards or runs of them are missing nothing is written: standard error lists them, and
behind two spaces the command that makes each. With --preview the runs that there are go into the
folder all the same, which says that it is a preview wherever it is read: it has no verdict (exit
code 1 where the campaign has requirements), it cannot be resumed or merged, and a later merge may
take its place.

The shards of a design for Sobol' indices (`sensitivity --shard`) are merged alike.

Example:
  wingspread merge results/part1 results/part2 --out results/whole
  wingspread merge results/part* --out results/so_far --preview --table)");
  command->callback([options, &action] { action = [options] { return merge(*options); }; });
}

void add_analyze(CLI::App& app, Action& action) {
  const auto options = std::make_shared<AnalyzeOptions>();
  CLI::App* command =
      app.add_subcommand("analyze", "Work out the statistics again, from a folder's runs.csv");
  command->add_option("folder", options->folder, "The results folder")->required();
  command->add_option("--quantiles", options->quantiles, "Others than the campaign's, e.g. 0.1,0.9")
      ->delimiter(',');
  command->add_option("--confidence", options->confidence, "Of all bounds, e.g. 0.99");
  command->add_option("--bins", options->bins, "Of the histograms: a number, or auto");
  command->add_option("--requirements", options->requirements,
                      "In place of the campaign's: a JSON file, an array of requirements");
  command->add_option("--out", options->out,
                      "Write the statistics there: a new or an empty folder");
  add_display_options(*command, options->display);
  command->footer(
      std::string(
          "Rewrites summary.json, histograms.json and histograms.csv; with --out it writes them\n"
          "there. Of a campaign with cases it does so for each, and cases.json.\n") +
      display_help +
      R"(Exit code 1 says that a requirement is not shown to be met.

For the runs of another tool, put a campaign.json beside its runs.csv, with as many runs in its
"sampling"; the columns run, status, latch_order, the draws and the outputs may stand in any order.

Example:
  wingspread analyze results/first --quantiles 0.001,0.5,0.999 --histograms
  wingspread analyze results/first --requirements late.json --out results/late)");
  command->callback([options, &action] { action = [options] { return analyze(*options); }; });
}

} // namespace wingspread
