#include "montecarlo/interfaces/terminal/command_options.hpp"

#include "montecarlo/foundation/formats/number_text.hpp"
#include "montecarlo/foundation/platform/thread_pool.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace wingspread {
namespace {

constexpr std::size_t most_notices = 30; // in one list

/// CLI11 itself would take -1 for 2^64 − 1.
std::string refuse_seed(const std::string& text) {
  if (parse_number<std::uint64_t>(text)) return "";
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

} // namespace

void add_seed_option(CLI::App& command, std::optional<std::uint64_t>& seed) {
  command.add_option("--seed", seed, "The seed, in place of the campaign's")
      ->check(refuse_seed)
      ->type_name("N");
}

void add_crew_options(CLI::App& command, CrewOptions& options) {
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

ThreadPool crew_of(const CrewOptions& options) {
  return {options.threads, instruction_set(options.isa, options.lanes)};
}

std::optional<Shard> parse_shard(std::string_view text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto index = parse_number<long>(text.substr(0, slash));
  const auto of = parse_number<long>(text.substr(std::min(slash + 1, text.size())));
  if (!index || !of || *index < 1 || *index > *of || *of > most_shards) return std::nullopt;
  return Shard{*index, *of};
}

std::string refuse_shard(const std::string& text) {
  if (parse_shard(text)) return "";
  return fmt::format("found {}, expected I/N with whole numbers 1 ≤ I ≤ N ≤ {}", text, most_shards);
}

void add_set_option(CLI::App& command, std::vector<std::string>& changes) {
  command
      .add_option("--set", changes, "Change the nominal scene, e.g. hinges.root.spring.scale=0.9")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
}

void add_case_option(CLI::App& command, std::string& name) {
  command.add_option("--case", name, "The case that is meant, of a campaign that has cases")
      ->type_name("NAME");
}

void add_sampling_options(CLI::App& command, SamplingOptions& sampling) {
  command.add_option("--runs", sampling.runs, "How many runs, in place of the campaign's number")
      ->check(CLI::Range(std::int64_t{1}, most_runs).description(""))
      ->type_name("N");
  add_seed_option(command, sampling.seed);
}

void add_strict_option(CLI::App& command, bool& strict) {
  command.add_flag("--strict", strict,
                   "What is warned of is an error: nothing is done, exit code 2");
}

void heed(const std::vector<Notice>& notices, bool strict) {
  if (strict && !notices.empty()) throw as_errors(notices);
  for (std::size_t i = 0; i < std::min(notices.size(), most_notices); ++i)
    fmt::print(stderr, "warning: {}\n", to_string(notices[i]));
  if (notices.size() > most_notices)
    fmt::print(stderr, "warning: and {} more\n", notices.size() - most_notices);
}

} // namespace wingspread
