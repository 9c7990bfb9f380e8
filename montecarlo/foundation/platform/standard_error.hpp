/// Messages on standard error.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace wingspread {

/// Prints to standard error, as fmt::print does, after all that was printed to standard output: a message about a table
/// follows it, also where both go to one pipe. A closed or full standard error takes no message, and ends no command.
template <class... Values>
void print_message(fmt::format_string<Values...> text, Values&&... values) {
  const std::string message = fmt::format(text, std::forward<Values>(values)...);
  (void)std::fflush(stdout);
  (void)std::fwrite(message.data(), 1, message.size(), stderr);
}

} // namespace wingspread
