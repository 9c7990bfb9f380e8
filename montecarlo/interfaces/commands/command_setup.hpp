/// Adds commands to the command line, and options for the machine that makes the runs.
#pragma once

#include "montecarlo/engine/runs/evaluator.hpp"
#include "montecarlo/foundation/formats/spec_error.hpp"
#include "montecarlo/interfaces/commands/commands.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>

namespace wingspread {

/// Makes every argument and option of the command refuse an empty text. An empty path would count as an option that is
/// not given, or as the current folder.
void refuse_empty_arguments(CLI::App& command);

/// Adds a command to the command line. Its options live as long as the action that uses them.
/// @param add_options adds options and the footer: void(CLI::App&, Options&)
/// @param run         carries the command out: int(const Options&), the exit status
template <class Options, class AddOptions, class Run>
void add_command(CLI::App& app, Action& action, const char* name, const char* description,
                 AddOptions add_options, Run run) {
  const auto options = std::make_shared<Options>();
  CLI::App& command = *app.add_subcommand(name, description);
  add_options(command, *options);
  refuse_empty_arguments(command);
  command.callback([options, run, &action] { action = [options, run] { return run(*options); }; });
}

/// Adds the campaign's file to those problems of an error that name a key of the campaign ("/margin") and no file.
/// Problems with an option ("--range") stay as they are.
[[nodiscard]] SpecError in_file(const SpecError& error, const std::filesystem::path& file);

/// How this machine makes the runs. The results do not depend on it.
struct MachineOptions {
  int threads = 0; ///< 0: OMP_NUM_THREADS, or all processors
  int lanes = 0;   ///< runs that one thread makes at once; 0: the most
  std::string isa; ///< instruction set; empty: the widest
};
/// Adds --threads, --lanes and --isa.
void add_machine_options(CLI::App& command, MachineOptions& options);

/// @throws CLI::ValidationError when this processor lacks the instruction set or the lanes
[[nodiscard]] ThreadPool pool_of(const MachineOptions& options);

} // namespace wingspread
