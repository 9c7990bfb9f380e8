#include "montecarlo/commands/command_options.hpp"

#include "montecarlo/commands/cli.hpp"
#include "montecarlo/formats/output_name.hpp"
#include "montecarlo/formats/text_layout.hpp"
#include "montecarlo/machine/progress.hpp"
#include "montecarlo/summary/table.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

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

/// The one asked for; refused where this processor has not got it.
InstructionSet instruction_set(const std::string& name, int lanes) {
  const std::vector<InstructionSet>& sets = instruction_sets();
  const auto fits = [&](InstructionSet set) {
    return (name.empty() || name == to_string(set)) && (lanes == 0 || lanes == lanes_of(set));
  };
  const auto found = std::find_if(sets.rbegin(), sets.rend(), fits);
  if (found != sets.rend()) return *found;
  std::vector<std::string> offered;
  for (const InstructionSet set : sets)
    offered.push_back(fmt::format("{} ({})", to_string(set), lanes_of(set)));
  throw CLI::ValidationError(
      name.empty()
          ? fmt::format("--lanes {}", lanes)
          : fmt::format("--isa {}{}", name, lanes ? fmt::format(" --lanes {}", lanes) : ""),
      fmt::format("this processor has not got that; it offers (lanes): {}",
                  fmt::join(offered, ", ")));
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

void add_crew_options(CLI::App& command, CrewOptions& options) {
  constexpr int most_threads = 1024;
  command.add_option("--threads", options.threads, "How many threads; all processors if left out")
      ->check(CLI::Range(1, most_threads).description(""))
      ->type_name("N");
  command
      .add_option("--lanes", options.lanes,
                  "How many runs a thread makes at once: 1, 2, 4 or 8; else the most")
      ->check(CLI::IsMember({1, 2, 4, 8}).description(""))
      ->type_name("L");
  command
      .add_option("--isa", options.isa,
                  "Instructions: scalar, neon, avx2 or avx512; else the widest")
      ->check(CLI::IsMember({"scalar", "neon", "avx2", "avx512"}).description(""))
      ->type_name("NAME");
}

Crew crew_of(const CrewOptions& options) {
  return {options.threads, instruction_set(options.isa, options.lanes)};
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

int report_failed(long failed, long runs, std::string_view consequence) {
  if (failed == 0) return exit_code::done;
  fmt::print(stderr, "error: {} of {} runs failed numerically{}\n", failed, runs, consequence);
  return exit_code::failed_runs;
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
  const auto failed = std::ranges::find(summary.statuses, Status::failed, &StatusShare::status);
  const int code =
      report_failed(failed->count, summary.runs,
                    fmt::format("; {} has their reasons", (stored.folder / summary_file).string()));
  return code != exit_code::done || met ? code : exit_code::not_met;
}

} // namespace wingspread
