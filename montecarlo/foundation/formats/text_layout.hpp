/// Text for a terminal: UTF-8, at most 100 columns wide, a column to each character.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace wingspread {

inline constexpr int table_width = 100;

/// How many characters (code points) UTF-8 text has.
[[nodiscard]] std::size_t count_characters(std::string_view text);

/// The first `width` characters, the last of them "…" when there are more.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t width);

/// The text, filled up with blanks to the width; a text that leaves no blank before the next column is not cut off, but
/// ends its line, and the next one begins with the column.
[[nodiscard]] std::string in_column(std::string_view text, std::size_t width);
/// The text at the end of a column, with a blank before it at least.
[[nodiscard]] std::string right_aligned(std::string_view text, std::size_t width);

/// Text that goes on a line that stands at column `indent`: broken at blanks to stay within `table_width`, its further
/// lines indented. A word alone may be longer.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t indent);

/// Five significant digits, trailing zeros among them, so that columns line up; "–" of NaN.
[[nodiscard]] std::string in_digits(double value);

/// Lines indented by so many columns and within `table_width`, broken at blanks.
[[nodiscard]] std::string paragraph(std::string_view text, std::size_t indent = 2);

/// "0.500 %" of 0.005; "–" of NaN.
[[nodiscard]] std::string percent(double share, int decimals = 3);

/// "0.500 – 0.700 %" of 0.005 and 0.007.
[[nodiscard]] std::string percent_range(double lower, double upper);

/// "timed out" of "timed_out".
[[nodiscard]] std::string spaced(std::string_view name);

/// "1 body", "3 bodies".
[[nodiscard]] std::string counted(long count, std::string_view one, std::string_view many);

} // namespace wingspread
