/// Text from outside on its way to a terminal.
#pragma once

#include <string>
#include <string_view>

namespace wingspread {

/// The text with its control characters spelled out ("\\x1b"), but for line feeds and tabs: what a file says may not
/// move the cursor, colour what follows or ring the bell.
[[nodiscard]] std::string printable(std::string_view text);

/// Whether it has any of those characters; line feeds and tabs among them.
[[nodiscard]] bool has_control_characters(std::string_view text);

} // namespace wingspread
