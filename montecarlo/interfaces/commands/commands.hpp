/// The commands. Each `add_` function adds one to the command line, with its options and its help.
#pragma once

#include "montecarlo/interfaces/terminal/exit_code.hpp"

#include <filesystem>
#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace wingspread {

struct Display;

/// Carries out the command with the parsed options. Returns the exit status.
using Action = std::function<int()>;

void add_new(CLI::App& app, Action& action);
void add_run(CLI::App& app, Action& action);
void add_merge(CLI::App& app, Action& action);
void add_analyze(CLI::App& app, Action& action);
void add_size(CLI::App& app, Action& action);
void add_simulate(CLI::App& app, Action& action);
void add_replay(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_modes(CLI::App& app, Action& action);
void add_sample(CLI::App& app, Action& action);
void add_sensitivity(CLI::App& app, Action& action);
void add_rare(CLI::App& app, Action& action);
void add_margin(CLI::App& app, Action& action);
void add_fit(CLI::App& app, Action& action);
void add_report(CLI::App& app, Action& action);
void add_export(CLI::App& app, Action& action);
void add_methods(CLI::App& app, Action& action);
void add_version(CLI::App& app, Action& action);
void add_schema(CLI::App& app, Action& action);

/// Prints the Sobol' indices of a folder that has all runs of a design, or the paths of its files, and writes
/// sensitivity.json and sensitivity.csv into it. @return the exit status
int show_design(const std::filesystem::path& folder, const Display& display);

/// "wingspread 0.1.0".
[[nodiscard]] std::string version_text();

} // namespace wingspread
