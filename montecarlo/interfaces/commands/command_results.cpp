#include "montecarlo/analyses/sensitivity/design_merge.hpp"
#include "montecarlo/foundation/formats/files.hpp"
#include "montecarlo/foundation/formats/number_text.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/foundation/platform/folder_lock.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/interfaces/commands/command_setup.hpp"
#include "montecarlo/interfaces/terminal/command_options.hpp"
#include "montecarlo/interfaces/terminal/output_file.hpp"
#include "montecarlo/interfaces/terminal/results_display.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/guarantees.hpp"
#include "montecarlo/model/input_checks/check_input.hpp"
#include "montecarlo/results/checkpoint/shard_checkpoints.hpp"
#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "montecarlo/results/results_folder/folder_writer.hpp"
#include "montecarlo/results/results_folder/merge.hpp"
#include "montecarlo/results/streaming/streaming_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
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
  std::vector<std::string> quantiles; ///< as they are written
  std::optional<double> confidence;
  std::string bins;
  std::filesystem::path requirements;
  Display display;
};

/// Shows and judges all cases. @return the worst exit status
int show_all_cases(const StoredCampaign& whole, const std::vector<CaseSummary>& cases,
                   const Display& display) {
  if (display.histograms)
    for (const CaseSummary& each : cases)
      show_table(read_stored_campaign(whole.folder / each.name), each.summary, display);
  show_cases(whole, cases, display);
  return judge_cases(whole, cases);
}

/// Merges the shards of a design for Sobol' indices. @return the exit status
int merge_into_design(const MergeOptions& options) {
  if (options.preview)
    throw SpecError(
        {{options.folders.front().string(), "", "--preview with shards of a design",
          "shards of a campaign: a design has indices only once all its runs are there"}});
  merge_designs(options.folders, options.out);
  return show_design(options.out, options.display);
}

/// Merges shards that were run with --no-rows.
Summary merge_without_rows(const MergeOptions& options) {
  if (options.preview)
    throw SpecError({{options.folders.front().string(), "", "--preview with shards without rows",
                      "shards with rows"}});
  return merge_streaming(options.folders, options.out);
}

int merge(const MergeOptions& options) {
  refuse_repeated(options.folders, options.out);
  const MergeKind kind = options.preview ? MergeKind::preview : MergeKind::whole;
  if (is_shard_folder(options.folders.front()))
    throw SpecError({{options.folders.front().string(), "", "a shard of a margin study",
                      "a shard of `run` or `sensitivity`; `wingspread margin CAMPAIGN.json --from "
                      "DIR… --out DIR` continues from such shards"}});
  // a shard killed early has neither rows nor statistics
  const bool without_rows = std::ranges::any_of(options.folders, is_streaming_folder);
  try {
    if (is_design_folder(options.folders.front())) return merge_into_design(options);
    if (is_cases_folder(options.folders.front())) {
      const auto cases = merge_cases(options.folders, options.out, kind);
      return show_all_cases(read_stored_campaign(options.out), cases, options.display);
    }
    const Summary summary = without_rows ? merge_without_rows(options)
                                         : merge_folders(options.folders, options.out, kind);
    return show_results(read_stored_campaign(options.out), summary, options.display);
  } catch (const MissingRuns& missing) {
    const bool has_preview =
        missing.can_preview() && !without_rows && !is_design_folder(options.folders.front());
    return print_missing(missing,
                         has_preview ? ", or use --preview to see the runs made so far" : "");
  }
}

/// The value of --bins as JSON: a number, or else the text. read_statistics checks it.
Json bins_json(const std::string& text) {
  const auto number = parse_number<std::int64_t>(text);
  return number ? Json(*number) : Json(text);
}

/// A quantile of --quantiles; read_statistics checks its limits. @throws SpecError if it is no number
Json quantile_json(const std::string& text) {
  if (const auto number = parse_number<double>(text)) return *number;
  throw SpecError({{"", "--quantiles", fmt::format("\"{}\"", text), "a number, > 0 and < 1"}});
}

/// The campaign with the settings and requirements that the options give.
StoredCampaign as_asked(StoredCampaign stored, const AnalyzeOptions& options) {
  Json given = Json::object();
  for (const std::string& text : entries_of("--quantiles", options.quantiles))
    given["quantiles"].push_back(quantile_json(text));
  if (options.confidence) given["confidence"] = *options.confidence;
  if (!options.bins.empty()) given["bins"] = bins_json(options.bins);
  override_settings(given,
                    [&](const JsonCursor& at) { read_statistics(at, stored.campaign.statistics); });
  if (options.requirements.empty()) return stored;
  refuse_rowless(stored.folder);
  judge_by(read_requirements_file(options.requirements, stored.campaign), stored);
  print_warnings(check_requirements_file(stored.campaign, options.requirements), false);
  return stored;
}

/// Warns that planned runs are missing.
void print_missing_runs(const StoredCampaign& stored, const Summary& summary) {
  const RunRange planned = stored.runs();
  if (summary.stopped || stored.stamp.preview || summary.runs >= planned.size()) return;
  print_message("warning: incomplete: {} of {} runs{}; requirements are not judged\n", summary.runs,
                planned.size(),
                stored.campaign.of_case.empty() ? "" : " of case " + stored.campaign.of_case);
}

/// Computes the statistics again and writes them to the folder `to`, which gets a copy of the campaign and its rows if
/// it is another folder. The campaign's folder is then `to`.
Summary summarize_again(StoredCampaign& stored, const std::filesystem::path& to) {
  if (to != stored.folder) copy_rows(stored.folder, to);
  stored.folder = to;
  if (is_streaming_folder(to)) {
    Summary summary = write_streaming_statistics(
        stored, read_streaming_statistics(stored).statistics, stored.campaign.statistics);
    print_missing_runs(stored, summary);
    return summary;
  }
  const Results results = read_stored_results(stored).results;
  Summary summary = write_statistics(stored, results);
  if (const auto gaps = gaps_text(stored, results, summary.stopped))
    print_message("warning: {}\n", *gaps);
  else
    print_missing_runs(stored, summary);
  return summary;
}

constexpr const char* statistics_elsewhere =
    "a folder that can be written; --out DIR writes the statistics elsewhere";

/// With --out the results folder is only read.
FolderLock::For lock_purpose(const AnalyzeOptions& options) {
  return options.out.empty() ? FolderLock::For::writing : FolderLock::For::reading;
}

Display display_of(const AnalyzeOptions& options) {
  Display display = options.display;
  display.statistics_only = options.out.empty();
  return display;
}

int analyze_cases(const AnalyzeOptions& options, const std::filesystem::path& to) {
  StoredCampaign whole = read_stored_campaign(options.folder);
  std::deque<FolderLock> locks;
  std::vector<StoredCampaign> asked; // all are read before anything is written
  for (const CaseSpec& spec : made_cases(whole)) {
    locks.emplace_back(whole.folder / spec.name, lock_purpose(options), statistics_elsewhere);
    asked.push_back(as_asked(read_stored_campaign(whole.folder / spec.name), options));
  }
  if (to != whole.folder) copy_rows(whole.folder, to);
  whole.folder = to;
  std::vector<CaseSummary> cases;
  for (StoredCampaign& stored : asked)
    cases.push_back(case_summary(whole, stored.campaign.of_case,
                                 summarize_again(stored, to / stored.campaign.of_case)));
  write_cases_file(whole, cases, to);
  return show_all_cases(whole, cases, display_of(options));
}

/// Says that cases.json beside a case's folder does not know of its new analysis.
void warn_of_cases_file(const StoredCampaign& stored) {
  const std::filesystem::path whole =
      std::filesystem::weakly_canonical(stored.folder).parent_path();
  if (stored.campaign.of_case.empty() || !exists(whole / cases_file)) return;
  print_message(
      "warning: {} keeps the earlier analysis of {}; `wingspread analyze {}` analyzes all "
      "cases\n",
      (whole / cases_file).string(), stored.campaign.of_case, shell_word(whole.string()));
}

/// Refuses to write the statistics of `from` into a folder with content, unless an interrupted `analyze` of the same rows
/// left it.
void refuse_other_folder(const std::filesystem::path& from, const std::filesystem::path& out) {
  const char* last = is_cases_folder(from)       ? cases_file
                     : is_streaming_folder(from) ? extremes_file
                                                 : histograms_csv_file;
  std::vector<std::filesystem::path> folders{""};
  if (is_cases_folder(from))
    for (const CaseSpec& spec : made_cases(read_stored_campaign(from)))
      folders.emplace_back(spec.name);
  const auto may_be_written = [&](const std::filesystem::path& each) {
    return is_new_folder(out / each) || is_copy(from / each, out / each);
  };
  const bool is_same = exists(out) && equivalent(from, out);
  if (is_same || exists(out / last) || !std::ranges::all_of(folders, may_be_written))
    refuse_used_folder(out, "a new or an empty folder");
}

int analyze(const AnalyzeOptions& options) {
  (void)read_any_campaign(options.folder); // before the lock makes a file in some other folder
  const bool elsewhere = !options.out.empty();
  if (elsewhere) refuse_other_folder(options.folder, options.out);
  const FolderLock lock(options.folder, lock_purpose(options), statistics_elsewhere);
  std::optional<FolderLock> other;
  if (elsewhere) other.emplace(options.out);
  const std::filesystem::path& to = elsewhere ? options.out : options.folder;
  if (is_cases_folder(options.folder)) return analyze_cases(options, to);
  StoredCampaign stored = as_asked(read_any_campaign(options.folder), options);
  const Summary summary = summarize_again(stored, to);
  warn_of_cases_file(stored);
  return show_results(stored, summary, display_of(options));
}

void add_merge_options(CLI::App& command, MergeOptions& options) {
  command.add_option("folders", options.folders, "The shards' results folders, in any order")
      ->required();
  command
      .add_option("--out", options.out,
                  "The results folder to write: new, empty, or an earlier preview")
      ->required();
  command.add_flag("--preview", options.preview,
                   "Merge the runs made so far, of any shards with rows, finished or not");
  add_display_options(command, options.display);
  command.footer(
      std::string("The result is the same, byte for byte, as running the campaign at once.\n") +
      display_help +
      R"( If shards or runs are missing, nothing is written: standard error lists them with the commands that
make them. --preview merges the runs made so far. Such a folder is marked as a preview wherever it
is read: it cannot be resumed or merged, and it has no verdicts, except those of cases whose runs
are all there (exit code 1 if the campaign has requirements). A later merge may replace it.

Shards of a design for Sobol' indices (`sensitivity --shard`) are merged in the same way.

Example:
  wingspread merge results/part1 results/part2 --out results/whole
  wingspread merge results/part* --out results/so_far --preview --table)");
}

void add_analyze_options(CLI::App& command, AnalyzeOptions& options) {
  command.add_option("folder", options.folder, "The results folder")->required();
  command
      .add_option("--quantiles", options.quantiles,
                  "Quantiles, each > 0 and < 1, e.g. 0.1,0.9; default: the campaign's")
      ->type_name("P,...");
  add_confidence_option(command, options.confidence);
  command.add_option("--bins", options.bins, "Bins of the histograms: from 1 to 10000, or auto");
  add_requirements_option(command, options.requirements);
  command.add_option("--out", options.out,
                     "A new folder (or an interrupted one), which gets a copy of the rows");
  add_display_options(command, options.display);
  command.footer(
      std::string("Writes summary.json, histograms.json and histograms.csv again, into the results "
                  "folder or\n--out; for a campaign with cases those of each case, and cases.json. "
                  "`report` shows what\nthe last `analyze` was asked for.\n") +
      display_help +
      R"(Exit code 1: a requirement is not shown to be met.

To analyze the runs of another tool, put a campaign.json beside its runs.csv, with the same number
of runs in "sampling"; the columns run, status, latch_order, the draws and the outputs may be in any
order.

Example:
  wingspread analyze results/first --quantiles 0.001,0.5,0.999 --histograms
  wingspread analyze results/first --requirements late.json --out results/late)");
}

} // namespace

void add_merge(CLI::App& app, Action& action) {
  add_command<MergeOptions>(app, action, "merge", "Merge the shards of a campaign",
                            add_merge_options, merge);
}

void add_analyze(CLI::App& app, Action& action) {
  add_command<AnalyzeOptions>(app, action, "analyze",
                              "Make the statistics of a results folder again", add_analyze_options,
                              analyze);
}

} // namespace wingspread
