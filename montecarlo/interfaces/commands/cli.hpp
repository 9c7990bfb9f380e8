/// The command line.
#pragma once

#include "montecarlo/interfaces/commands/commands.hpp"

#include <span>
#include <string_view>

namespace wingspread {

/// A command and the function that adds it to the command line.
struct Command {
  std::string_view name;
  void (*add)(CLI::App& app, Action& action);
};

/// All commands, in the order of --help.
[[nodiscard]] std::span<const Command> all_commands();

/// The parsed arguments: an action, or the exit status if nothing is left to do.
struct ParsedArguments {
  Action action; ///< empty when nothing is left to do
  int code = exit_code::done;
};

/// Parses the arguments. Answers --help and --version, and prints errors; does nothing else.
[[nodiscard]] ParsedArguments parse_arguments(int argc, const char* const* argv,
                                              std::span<const Command> commands = all_commands());

/// Runs the action and prints its exceptions as errors. @return the exit status
[[nodiscard]] int run_action(const Action& action);

/// Parses the arguments, runs the command and returns the exit status. Results go to standard output; errors go to
/// standard error, in lines that begin with "error: ".
[[nodiscard]] int command_line(int argc, const char* const* argv);

} // namespace wingspread
