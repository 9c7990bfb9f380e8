/// The command line.
#pragma once

#include "montecarlo/interfaces/commands/commands.hpp"

#include <span>
#include <string_view>

namespace wingspread {

/// A command, and what adds it to a command line.
struct Command {
  std::string_view name;
  void (*add)(CLI::App& app, Action& action);
};

/// All that there are, as --help lists them.
[[nodiscard]] std::span<const Command> all_commands();

/// What the arguments come to: something to do, or the exit status when all is said already.
struct Understood {
  Action action; ///< empty: nothing is left to do
  int code = exit_code::done;
};

/// Understands the arguments and does nothing yet, but to answer --help, or to refuse.
/// @param commands those that there are
[[nodiscard]] Understood understand(int argc, const char* const* argv,
                                    std::span<const Command> commands = all_commands());

/// Does it; what keeps it from being done is an error and its exit status.
[[nodiscard]] int carry_out(const Action& action);

/// Understands the arguments, does what they say and returns the exit status. What was asked for
/// goes to standard output, errors as lines that begin with "error: " to standard error.
[[nodiscard]] int command_line(int argc, const char* const* argv);

} // namespace wingspread
