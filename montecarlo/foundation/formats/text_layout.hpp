/// Text for a terminal: UTF-8, at most 100 columns wide, one column for each character.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace wingspread {

inline constexpr int table_width = 100;

/// The number of characters (code points) of UTF-8 text.
[[nodiscard]] std::size_t count_characters(std::string_view text);

/// The text cut to `width` characters; "…" is the last one if it was cut.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t width);

/// The text padded with blanks to the width. A text that is not shorter is followed by a line feed and `width` blanks.
[[nodiscard]] std::string in_column(std::string_view text, std::size_t width);
/// The text at the end of a column, after at least one blank.
[[nodiscard]] std::string right_aligned(std::string_view text, std::size_t width);

/// Wraps text that starts at column `indent`: breaks at blanks to stay within `table_width` and indents further lines.
/// A single word may be longer.
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t indent);

/// Every line of a text, broken at blanks to stay within `table_width`; what goes on below is indented by four columns
/// more than the line. A line with columns (three blanks in a row) stays as it is.
[[nodiscard]] std::string wrapped_lines(std::string_view text);

/// Five significant digits with trailing zeros, so that columns line up; "–" of NaN.
[[nodiscard]] std::string in_digits(double value);

/// The fewest significant digits, from `least` to 17, that tell neighbours of an ascending sequence apart.
[[nodiscard]] int digits_that_tell(std::span<const double> ascending, int least);

/// Lines indented by `indent`, broken at blanks to stay within `table_width`; ends with a line feed.
[[nodiscard]] std::string paragraph(std::string_view text, std::size_t indent = 2);

/// "0.500 %" of 0.005; "–" of NaN. A share below 1 has as many decimals as tell it from 100 %.
[[nodiscard]] std::string percent(double share, int decimals = 3);

/// percent() rounded down, so that a lower bound stays one; rounded up, so that an upper bound does.
[[nodiscard]] std::string percent_at_least(double share, int decimals = 3);
[[nodiscard]] std::string percent_at_most(double share, int decimals = 3);

/// in_digits() rounded up with `sign` 1, so that an upper bound stays one, down with -1, to nearest with 0.
[[nodiscard]] std::string in_digits_towards(double value, int sign, int digits = 5);
/// in_digits_towards() with the fewest digits, from five, that show whether the value is below, at or above the limit.
[[nodiscard]] std::string in_digits_beside(double value, double limit, int sign);

/// "0.500 – 0.700 %" of 0.005 and 0.007. Where three decimals do not tell a bound from 0 or 100 %, it has more and is
/// rounded outwards.
[[nodiscard]] std::string percent_range(double lower, double upper);

/// Four digits of an angle in degrees: "90" of π/2.
[[nodiscard]] std::string degrees_text(double radians);

/// A value as its author wrote it: an angle or a rate in degrees where that number is shorter, "8 deg/s" of
/// 0.13962634015954636 rad/s; else all its digits, "1.5 rad/s". A number that a conversion to SI gave more than ten
/// digits has six: "56.4924 N·m" of "500 in*lbf".
[[nodiscard]] std::string as_written(double value, std::string_view unit);

/// By what to multiply a value in `unit` so that it has the unit in which as_written states `limit`: 180/π or 1.
[[nodiscard]] double factor_as_written(double limit, std::string_view unit);

/// "timed out" of "timed_out".
[[nodiscard]] std::string spaced(std::string_view name);

/// "1 body", "3 bodies".
[[nodiscard]] std::string counted(long count, std::string_view one, std::string_view many);

/// "median" or "99 %", with as many digits as tell 1 − p to 0.1 %.
[[nodiscard]] std::string quantile_name(double p);

} // namespace wingspread
