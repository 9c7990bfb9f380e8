/// Options that several commands have, and settings that are given as options.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/foundation/formats/json_reader.hpp"
#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/campaign/overrides.hpp"
#include "montecarlo/model/input_checks/notice.hpp"
#include "montecarlo/results/results_folder/stamp.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace wingspread {

/// What replaces the campaign's own sampling.
struct SamplingOptions {
  std::optional<std::int64_t> runs;
  std::optional<std::uint64_t> seed;
};
void add_seed_option(CLI::App& command, std::optional<std::uint64_t>& seed);

/// How the runs are made, which changes nothing about their results.
struct CrewOptions {
  int threads = 0; ///< 0: all processors
  int lanes = 0;   ///< 0: as the instruction set has
  std::string isa; ///< none: the widest
};
void add_crew_options(CLI::App& command, CrewOptions& options);

/// @throws CLI::ValidationError where this processor has not got what is asked for
[[nodiscard]] ThreadPool crew_of(const CrewOptions& options);

/// "2/5"; nothing when it is no shard.
[[nodiscard]] std::optional<Shard> parse_shard(std::string_view text);
/// Why the text is none; empty when it is one.
[[nodiscard]] std::string refuse_shard(const std::string& text);

/// --strict: what is noticed is an error.
void add_strict_option(CLI::App& command, bool& strict);

/// Says on standard error what was noticed of the input, a line each.
/// @throws SpecError with all of it, if it is to be an error
void heed(const std::vector<Notice>& notices, bool strict);

void add_sampling_options(CLI::App& command, SamplingOptions& sampling);

/// `--set PATH=VALUE`, as often as wanted: the nominal scene changed before anything else.
void add_set_option(CLI::App& command, std::vector<std::string>& changes);
/// `--case NAME`, where one campaign is wanted.
void add_case_option(CLI::App& command, std::string& name);

} // namespace wingspread
