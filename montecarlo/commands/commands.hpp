/// The commands. Each `add_` adds one to the command line, with its options and its help.
#pragma once

#include "montecarlo/machine/interrupt.hpp"

#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace wingspread {

/// What the program's exit status says.
namespace exit_code {
inline constexpr int done = 0;
inline constexpr int not_met = 1;         ///< done, but a requirement is not shown to be met
inline constexpr int bad_input = 2;       ///< nothing was done
inline constexpr int failed_runs = 3;     ///< done, but some runs failed numerically
inline constexpr int machine_refused = 4; ///< no room, memory or permission; what is done is kept
inline constexpr int interrupted = interrupted_status; ///< what is done is kept, can be resumed
} // namespace exit_code

/// What is to be done once the command line is understood; returns the exit status.
using Action = std::function<int()>;

void add_run(CLI::App& app, Action& action);
void add_merge(CLI::App& app, Action& action);
void add_analyze(CLI::App& app, Action& action);
void add_size(CLI::App& app, Action& action);
void add_simulate(CLI::App& app, Action& action);
void add_replay(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_sample(CLI::App& app, Action& action);
void add_sensitivity(CLI::App& app, Action& action);
void add_rare(CLI::App& app, Action& action);
void add_margin(CLI::App& app, Action& action);
void add_report(CLI::App& app, Action& action);
void add_methods(CLI::App& app, Action& action);
void add_version(CLI::App& app, Action& action);

/// "wingspread 0.1.0".
[[nodiscard]] std::string version_text();

} // namespace wingspread
