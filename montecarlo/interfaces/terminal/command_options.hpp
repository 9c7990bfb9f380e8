/// Options that several commands share, and the settings that they fill.
#pragma once

#include "montecarlo/model/campaign/overrides.hpp"
#include "montecarlo/model/input_checks/input_warning.hpp"
#include "montecarlo/results/results_folder/stamp.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace wingspread {

/// Replacements for the campaign's "sampling".
struct SamplingOptions {
  std::optional<std::int64_t> runs;
  std::optional<std::uint64_t> seed;
};
/// Adds --runs and --seed.
void add_sampling_options(CLI::App& command, SamplingOptions& sampling);
void add_seed_option(CLI::App& command, std::optional<std::uint64_t>& seed);

/// Adds --shard I/N, for parse_shard.
void add_shard_option(CLI::App& command, std::string& shard, const char* description);
/// Reads "2/5". @return nothing when the text is no shard
[[nodiscard]] std::optional<Shard> parse_shard(std::string_view text);

/// Adds --confidence.
void add_confidence_option(CLI::App& command, std::optional<double>& confidence);
/// @return the given confidence, or the campaign's own
/// @throws SpecError unless it is > 0 and < 1
[[nodiscard]] double confidence_of(const std::optional<double>& given, const StatisticsSpec& own);

/// Adds --strict: warnings become errors.
void add_strict_option(CLI::App& command, bool& strict);
/// Prints the warnings of the input checks on standard error, one per line.
/// @throws SpecError with all of them when `strict`
void print_warnings(const std::vector<InputWarning>& warnings, bool strict);

/// Adds --set PATH=VALUE, which may be repeated: changes of the nominal scene.
void add_set_option(CLI::App& command, std::vector<std::string>& changes);
/// Adds --case NAME, for commands that take one case.
void add_case_option(CLI::App& command, std::string& name);

} // namespace wingspread
