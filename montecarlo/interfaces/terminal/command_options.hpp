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
class Option;
} // namespace CLI

namespace wingspread {

/// Takes integers from `least` to `most` only, and says so in the option's help, before its default.
CLI::Option* within(CLI::Option* option, std::int64_t least, std::int64_t most);
/// Adds the option's limits in words ("> 0 and < 1") to its help, before its default. Whoever reads the value checks
/// them.
CLI::Option* limited(CLI::Option* option, std::string_view limits);
/// Takes the words only, and suggests the nearest one.
CLI::Option* one_of(CLI::Option* option, std::vector<std::string> words);
/// Takes a number with a unit, too: "20 min" for an option in seconds.
CLI::Option* with_unit(CLI::Option* option, std::string_view unit);
/// Splits each value of an option at its commas.
/// @throws SpecError for a comma without an entry before or behind it
[[nodiscard]] std::vector<std::string> entries_of(const char* option,
                                                  std::span<const std::string> given);
/// Reads a number in the unit, or with a unit of its own; nothing for other text.
[[nodiscard]] std::optional<double> parse_quantity(std::string_view text, std::string_view unit);

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
/// Adds --requirements: a file for read_requirements_file.
void add_requirements_option(CLI::App& command, std::filesystem::path& file);
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
/// Adds --case NAME, for commands that take one case. @param more of its help: what is done without it
void add_case_option(CLI::App& command, std::string& name, const std::string& more = "");
inline constexpr const char* without_case = "; without it the wing in none";

} // namespace wingspread
