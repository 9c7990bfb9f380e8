/// Control characters in text from outside.
#pragma once

#include <string>
#include <string_view>

namespace wingspread {

/// The text with control characters escaped ("\\x1b") except line feeds and tabs, so that a file's text cannot move the
/// terminal's cursor, set colours or ring the bell.
[[nodiscard]] std::string printable(std::string_view text);

/// Whether the text has control characters; line feeds and tabs count.
[[nodiscard]] bool has_control_characters(std::string_view text);

} // namespace wingspread
