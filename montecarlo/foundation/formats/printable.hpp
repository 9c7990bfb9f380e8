/// Text from outside that is printed: control characters, and words of a command to copy.
#pragma once

#include <string>
#include <string_view>

namespace wingspread {

/// The text with control characters escaped ("\\x1b") except line feeds and tabs, so that a file's text cannot move the
/// terminal's cursor, set colours or ring the bell. Bytes that are no UTF-8 are escaped too.
[[nodiscard]] std::string printable(std::string_view text);

/// Whether the text has control characters; line feeds and tabs count.
[[nodiscard]] bool has_control_characters(std::string_view text);

/// A word of a command as a POSIX shell takes it: in quotes where it has blanks, "&", quotes and the like. Every
/// command that the program prints has its paths, names and texts through this function; those of the page through W.shellWord.
[[nodiscard]] std::string shell_word(const std::string& word);

} // namespace wingspread
