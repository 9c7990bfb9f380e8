#include "montecarlo/interfaces/terminal/results_display.hpp"

#include "montecarlo/foundation/formats/json_parse.hpp"
#include "montecarlo/foundation/formats/output_name.hpp"
#include "montecarlo/foundation/formats/printable.hpp"
#include "montecarlo/foundation/formats/text_layout.hpp"
#include "montecarlo/foundation/platform/progress.hpp"
#include "montecarlo/foundation/platform/standard_error.hpp"
#include "montecarlo/interfaces/terminal/exit_code.hpp"
#include "montecarlo/results/streaming/streaming_folder.hpp"
#include "montecarlo/results/summary/compact_table.hpp"
#include "montecarlo/results/summary/table.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

namespace wingspread {
namespace {

/// The title of a table. @param count "1000 runs", "3 cases" @param summary of the runs; empty for several cases
std::string title(const StoredCampaign& stored, const std::string& count, const Summary& summary) {
  const Campaign& campaign = stored.campaign;
  const std::string of_case = campaign.of_case.empty() ? "" : " · " + campaign.of_case;
  std::string text = fmt::format("{}{} · {} · {}, seed {}", campaign.scene.name, of_case, count,
                                 design_names[static_cast<std::size_t>(campaign.sampling.design)],
                                 campaign.sampling.seed);
  if (summary.replicates > 0) text += ", " + counted(summary.replicates, "replicate", "replicates");
  if (stored.stamp.shard) text += " · " + describe(stored.stamp.shard);
  if (!summary.interim.before.empty())
    text += fmt::format(" · interim analysis {}, after {}", summary.interim.count(),
                        fmt::join(summary.interim.before, ", "));
  if (const auto& preview = stored.stamp.preview)
    text += fmt::format(" · PREVIEW: {} of {} runs, {} missing", preview->runs, preview->of,
                        preview->of - preview->runs);
  return text;
}

std::string title(const StoredCampaign& stored, const Summary& summary) {
  std::string text = title(stored, counted(summary.runs, "run", "runs"), summary);
  if (stored.stamp.preview) return text;
  if (summary.stopped)
    text += fmt::format(" · stopped, of at most {}", stored.runs().size());
  else if (summary.runs < stored.runs().size())
    text += fmt::format(" · partial, of {} runs", stored.runs().size());
  return text;
}

void print_histograms(const Summary& summary) {
  for (const OutputSummary& output : summary.outputs)
    fmt::print("\n{}", draw_histogram(output.name, parse_output_name(output.name).unit,
                                      output.histogram, table_width));
}

bool are_met(const Summary& summary) {
  return std::ranges::all_of(summary.requirements, [](const Verdict& verdict) {
    return verdict.decision == Decision::pass;
  });
}

void print_not_met(std::string_view of_case, const Verdict& verdict, std::string_view others) {
  print_message("not met: {}{}: {}: {}{}\n", of_case, to_string(verdict.requirement),
                to_string(verdict.decision), evidence(verdict), others);
}

/// Whether `run --resume` can add runs to the campaign's. @pre it has requirements, so its design is random
bool may_grow(const StoredCampaign& stored) {
  return !stored.foreign && stored.campaign.until.empty() && !is_streaming_folder(stored.folder);
}

/// Whether more runs may decide a verdict: more of the same run do not, nor do more runs whose peaks t_end cuts.
bool is_open(const Verdict& verdict) {
  return !is_decided(verdict) && !verdict.one_run && !verdict.of_part &&
         !rests_on_cut_peaks(verdict);
}

/// Prints how adding runs affects verdicts that are undecided, or that were judged before. @pre at least one summary
void print_notes(const std::vector<const Summary*>& summaries, bool may_grow) {
  const Summary& last = **std::ranges::max_element(
      summaries, {}, [](const Summary* each) { return each->interim.count(); });
  if (!last.interim.before.empty() && !last.requirements.empty())
    print_message(
        "note: analysis {} of the same draws, after {} runs: a requirement passes if the "
        "risk of a wrong pass at any of them is at most 1 - confidence (summary.json states "
        "it)\n",
        last.interim.count(), fmt::join(last.interim.before, ", "));
  if (std::ranges::any_of(summaries, [](const Summary* each) {
        return std::ranges::any_of(each->requirements, is_open);
      }))
    print_message("note: each further test after a failed one, with more runs or another --seed, "
                  "adds a risk of a wrong pass{}\n",
                  may_grow ? ". `run --resume --runs N` adds runs and judges all analyses together "
                             "at the promised confidence"
                           : "");
}

/// Prints the goals that all runs together have not reached.
void print_open_goals(std::string_view of_case, const Summary& summary) {
  for (const GoalState& each : summary.until)
    if (!each.met)
      print_message("note: {}goal not reached in {}: {}\n", of_case,
                    counted(summary.runs, "run", "runs"), to_string(each.goal));
}

/// Prints each requirement that some case does not meet, with its worst case, and the notes once. Cases that are a part
/// of their runs are not judged.
void report_cases(const std::vector<CaseSummary>& cases, bool may_grow) {
  std::vector<const CaseSummary*> judged;
  for (const CaseSummary& each : cases)
    if (std::ranges::none_of(each.summary.requirements, &Verdict::of_part)) judged.push_back(&each);
  if (judged.empty()) return;
  for (std::size_t i = 0; i < cases.front().summary.requirements.size(); ++i) {
    const auto verdict = [i](const CaseSummary* each) -> const Verdict& {
      return each->summary.requirements[i];
    };
    const CaseSummary* worst = *std::ranges::min_element(judged, is_worse, verdict);
    std::vector<std::string> others;
    for (const CaseSummary* each : judged)
      if (each != worst && verdict(each).decision != Decision::pass) others.push_back(each->name);
    if (verdict(worst).decision != Decision::pass)
      print_not_met(worst->name + ": ", verdict(worst),
                    others.empty() ? "" : fmt::format(" (nor met: {})", fmt::join(others, ", ")));
  }
  std::vector<const Summary*> summaries;
  for (const CaseSummary* each : judged) summaries.push_back(&each->summary);
  print_notes(summaries, may_grow);
  for (const CaseSummary* each : judged) print_open_goals(each->name + ": ", each->summary);
}

} // namespace

void add_display_options(CLI::App& command, Display& display) {
  command.add_flag("--table", display.table,
                   "Print the table even if standard output is not a terminal");
  command.add_flag("--all", display.all,
                   "Print every line of the table, with the accuracy of each output");
  command.add_flag("--histograms", display.histograms,
                   "Print the table and each output's histogram");
}

int report_failed(long failed, long runs, std::string_view consequence) {
  if (failed == 0) return exit_code::done;
  print_message("error: {} of {} runs failed numerically{}\n", failed, runs, consequence);
  return exit_code::failed_runs;
}

bool wants_table(const Display& display) {
  return display.table || display.histograms || display.all || is_terminal(stdout);
}

namespace {

void print_files(const std::filesystem::path& folder, const Display& display) {
  const bool rowless = is_streaming_folder(folder);
  std::vector<const char*> files{summary_file, histograms_json_file, histograms_csv_file};
  if (rowless) files.push_back(extremes_file);
  if (!display.statistics_only)
    files.insert(files.begin(), {campaign_file, rowless ? broken_runs_file : runs_file});
  if (!display.statistics_only && rowless) files.push_back(statistics_file);
  for (const char* file : files) fmt::print("{}\n", (folder / file).string());
}

} // namespace

int print_missing(const MissingRuns& missing, std::string_view alternative) {
  constexpr std::size_t most = 1000;
  for (const Problem& problem : missing.problems())
    print_message("error: {}\n", printable(to_string(problem)));
  const std::vector<std::string>& commands = missing.commands();
  print_message("made by ({}){}\n", counted(std::ssize(commands), "command", "commands"),
                alternative.empty() ? ":" : alternative);
  for (std::size_t i = 0; i < std::min(commands.size(), most); ++i)
    print_message("  {}\n", commands[i]);
  if (commands.size() > most) print_message("  … and {} more\n", commands.size() - most);
  return exit_code::bad_input;
}

void show_table(const StoredCampaign& stored, const Summary& summary, const Display& display) {
  fmt::print("{}",
             summary_table(summary, title(stored, summary), stored.folder.string(), display.all));
  if (display.histograms) print_histograms(summary);
}

void warn_of_preview(const StoredCampaign& stored) {
  if (const auto& preview = stored.stamp.preview)
    print_message("warning: {} is a PREVIEW: {} of the campaign's {} runs; {} are missing, and the "
                  "results may change\n",
                  stored.folder.string(), preview->runs, preview->of, preview->of - preview->runs);
}

namespace {

/// The exit status of the results; prints what failed, and the previews.
int judge_quietly(const StoredCampaign& stored, const Summary& summary) {
  warn_of_preview(stored);
  bool met = stored.stamp.shard || are_met(summary);
  if (stored.stamp.preview && !summary.requirements.empty()) {
    print_message("not met: a preview has no verdicts\n");
    met = false;
  }
  const auto failed = std::ranges::find(summary.statuses, Status::failed, &StatusShare::status);
  const int code =
      report_failed(failed->count, summary.runs,
                    fmt::format("; {} has their reasons", (stored.folder / summary_file).string()));
  return code != exit_code::done || met ? code : exit_code::not_met;
}

} // namespace

int judge_results(const StoredCampaign& stored, const Summary& summary) {
  if (!stored.stamp.is_part()) {
    for (const Verdict& verdict : summary.requirements)
      if (verdict.decision != Decision::pass) print_not_met("", verdict, "");
    print_notes({&summary}, may_grow(stored));
    print_open_goals("", summary);
  }
  return judge_quietly(stored, summary);
}

int judge_cases(const StoredCampaign& whole, const std::vector<CaseSummary>& cases) {
  if (!whole.stamp.shard && !cases.empty()) report_cases(cases, may_grow(whole));
  for (const CaseSummary& each : cases)
    if (!whole.stamp.is_part() && std::ranges::any_of(each.summary.requirements, &Verdict::of_part))
      print_message("not met: {}: not judged: it has {} of {} runs\n", each.name, each.summary.runs,
                    whole.runs().size());
  int worst = exit_code::done;
  for (const CaseSummary& each : cases)
    worst = std::max(worst,
                     judge_quietly(read_stored_campaign(whole.folder / each.name), each.summary));
  return worst;
}

void show_cases(const StoredCampaign& whole, const std::vector<CaseSummary>& cases,
                const Display& display) {
  if (wants_table(display)) {
    const std::string first = title(whole, counted(std::ssize(cases), "case", "cases"), {});
    fmt::print("{}", display.all ? cases_table(cases, first, whole.folder.string())
                                 : compact_cases_table(cases, first, whole.folder.string()));
    return;
  }
  if (!display.statistics_only) fmt::print("{}\n", (whole.folder / campaign_file).string());
  fmt::print("{}\n", (whole.folder / cases_file).string());
  for (const CaseSummary& each : cases) print_files(whole.folder / each.name, display);
}

Json show_finished(const std::filesystem::path& file, bool whole) {
  Json study = parse_json_file(file);
  fmt::print("{}", whole ? json_text(study) : file.string() + '\n');
  print_message("note: this study was finished already\n");
  return study;
}

int show_results(const StoredCampaign& stored, const Summary& summary, const Display& display) {
  if (wants_table(display))
    show_table(stored, summary, display);
  else
    print_files(stored.folder, display);
  return judge_results(stored, summary);
}

} // namespace wingspread
