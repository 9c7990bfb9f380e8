#include "montecarlo/commands/command_options.hpp"

#include "montecarlo/commands/cli.hpp"
#include "montecarlo/formats/output_name.hpp"
#include "montecarlo/formats/text_layout.hpp"
#include "montecarlo/machine/progress.hpp"
#include "montecarlo/summary/table.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

namespace wingspread {
namespace {

/// "/t_end" → "--t-end"; what lies deeper is the option's too.
std::string option_of(std::string_view pointer) {
  const std::string_view key = pointer.substr(std::min<std::size_t>(1, pointer.size()));
  std::string option = "--" + std::string(key.substr(0, key.find('/')));
  std::ranges::replace(option, '_', '-');
  return option;
}

/// CLI11 itself would take -1 for 2^64 − 1.
std::string refuse_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error == std::errc{} && end == text.data() + text.size()) return "";
  return fmt::format("found {}, expected an integer from 0 to 2^64 - 1", text);
}

std::string title(const StoredCampaign& stored, const Summary& summary) {
  const Campaign& campaign = stored.campaign;
  std::string text = fmt::format("{} · {} runs · {}, seed {}", campaign.scene.name, summary.runs,
                                 design_names[static_cast<std::size_t>(campaign.sampling.design)],
                                 campaign.sampling.seed);
  if (summary.replicates > 0)
    text += fmt::format(", {} replicate{}", summary.replicates, summary.replicates == 1 ? "" : "s");
  if (stored.stamp.shard) text += " · " + describe(stored.stamp.shard);
  if (summary.stopped)
    text += fmt::format(" · stopped, of {} at most", stored.runs().size());
  else if (summary.runs < stored.runs().size())
    text += fmt::format(" · partial, of {} runs", stored.runs().size());
  return text;
}

void print_histograms(const Summary& summary) {
  for (const OutputSummary& output : summary.outputs)
    fmt::print("\n{}", draw_histogram(output.name, parse_output_name(output.name).unit,
                                      output.histogram, table_width));
}

long count_failed(const Summary& summary) {
  const auto found = std::ranges::find(summary.statuses, Status::failed, &StatusShare::status);
  return found == summary.statuses.end() ? 0 : found->count;
}

/// Says which requirements are not met. @return whether all are
bool report_requirements(const Summary& summary) {
  bool met = true;
  for (const Verdict& verdict : summary.requirements) {
    if (verdict.decision == Decision::pass) continue;
    met = false;
    fmt::print(stderr, "not met: {}: {}: {}\n", to_string(verdict.requirement),
               to_string(verdict.decision), evidence(verdict));
  }
  return met;
}

} // namespace

void override_settings(const Json& given, const std::function<void(const JsonCursor&)>& read) {
  std::vector<Problem> problems;
  read(JsonCursor(given, "", problems));
  for (Problem& problem : problems) problem.pointer = option_of(problem.pointer);
  if (!problems.empty()) throw SpecError(std::move(problems));
}

void add_seed_option(CLI::App& command, std::optional<std::uint64_t>& seed) {
  command.add_option("--seed", seed, "The seed, in place of the campaign's")
      ->check(refuse_seed)
      ->type_name("N");
}

void add_threads_option(CLI::App& command, int& threads) {
  constexpr int most_threads = 1024;
  command.add_option("--threads", threads, "How many threads; all processors if left out")
      ->check(CLI::Range(1, most_threads).description(""))
      ->type_name("N");
}

void add_sampling_options(CLI::App& command, SamplingOptions& sampling) {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  command.add_option("--runs", sampling.runs, "How many runs, in place of the campaign's number")
      ->check(CLI::Range(std::int64_t{1}, most).description(""))
      ->type_name("N");
  add_seed_option(command, sampling.seed);
}

void add_display_options(CLI::App& command, Display& display) {
  command.add_flag("--table", display.table, "Print the table even when it is not to a terminal");
  command.add_flag("--histograms", display.histograms,
                   "Print the table, and each output's histogram below it");
}

int show_results(const StoredCampaign& stored, const Summary& summary, const Display& display) {
  if (display.table || display.histograms || is_terminal(stdout)) {
    fmt::print("{}", summary_table(summary, title(stored, summary), stored.folder.string()));
    if (display.histograms) print_histograms(summary);
  } else {
    for (const char* file :
         {campaign_file, runs_file, summary_file, histograms_json_file, histograms_csv_file})
      fmt::print("{}\n", (stored.folder / file).string());
  }
  const bool met = stored.stamp.shard || report_requirements(summary);
  const long failed = count_failed(summary);
  if (failed == 0) return met ? exit_code::done : exit_code::not_met;
  fmt::print(stderr, "error: {} of {} runs failed numerically; {} has their reasons\n", failed,
             summary.runs, (stored.folder / summary_file).string());
  return exit_code::failed_runs;
}

} // namespace wingspread
