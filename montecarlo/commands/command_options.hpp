/// What several commands have in common: settings given on the command line, and results shown.
#pragma once

#include "montecarlo/folder/results_folder.hpp"
#include "montecarlo/runs/evaluator.hpp"

#include <functional>
#include <optional>
#include <string>
#include <string_view>

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

/// How results are shown on standard output.
struct Display {
  bool table = false;      ///< the table even when standard output is no terminal
  bool histograms = false; ///< and a drawing of each output's histogram below it
};
void add_display_options(CLI::App& command, Display& display);

/// What --help says of it.
inline constexpr const char* display_help =
    "Standard output is the table of results if that is a terminal; otherwise the paths of the\n"
    "files written, one a line.\n";

/// Says on standard error that runs failed numerically.
/// @param consequence behind it, e.g. "; summary.json has their reasons"
/// @return the exit status
int report_failed(long failed, long runs, std::string_view consequence = "");

/// Shows the results, and says on standard error when runs failed and requirements are not met.
/// @return the exit status: that runs failed numerically comes before a requirement that is not
///   met, and a shard alone is not held to those
int show_results(const StoredCampaign& stored, const Summary& summary, const Display& display);

} // namespace wingspread
