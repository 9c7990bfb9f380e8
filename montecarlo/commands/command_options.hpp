/// Options that several commands have, and settings that are given as options.
#pragma once

#include "montecarlo/formats/json_reader.hpp"
#include "montecarlo/runs/evaluator.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace wingspread {

/// Reads settings that were given as options over those that hold, by the rules of the file they
/// otherwise stand in.
/// @param given their keys and values, as a campaign has them; "t_end" stands for --t-end
/// @param read  notes what is wrong
/// @throws SpecError that names the options
void override_settings(const Json& given, const std::function<void(const JsonCursor&)>& read);

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
[[nodiscard]] Crew crew_of(const CrewOptions& options);

void add_sampling_options(CLI::App& command, SamplingOptions& sampling);

} // namespace wingspread
