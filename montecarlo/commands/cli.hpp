/// The command line.
#pragma once

namespace wingspread {

/// Understands the arguments, does what they say and returns the exit status. What was asked for
/// goes to standard output, errors as lines that begin with "error: " to standard error.
[[nodiscard]] int command_line(int argc, const char* const* argv);

} // namespace wingspread
