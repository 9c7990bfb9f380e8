/// The command line.
#pragma once

namespace wingspread {

/// What the program's exit status says.
namespace exit_code {
inline constexpr int done = 0;
inline constexpr int not_met = 1;       ///< done, but a requirement is not shown to be met
inline constexpr int bad_input = 2;     ///< nothing was done
inline constexpr int failed_runs = 3;   ///< done, but some runs failed numerically
inline constexpr int interrupted = 130; ///< what is done is kept and can be resumed
} // namespace exit_code

/// Understands the arguments, does what they say and returns the exit status. What was asked for
/// goes to standard output, errors as lines that begin with "error: " to standard error.
[[nodiscard]] int command_line(int argc, const char* const* argv);

} // namespace wingspread
