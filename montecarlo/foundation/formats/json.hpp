/// The JSON value used throughout, and how it is written: strictly (RFC 8259), so that what is not
/// finite, or not there, is null.
#pragma once

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace wingspread {

/// Its objects keep the order in which they were written.
using Json = nlohmann::ordered_json;

[[nodiscard]] Json json_number(double value);
/// The number rounded to so many significant digits.
[[nodiscard]] Json json_number(double value, int digits);
[[nodiscard]] Json json_number(const std::optional<double>& value);

/// Rounds to so many significant digits; −0 becomes 0, NaN and infinities stay.
[[nodiscard]] double rounded(double value, int digits);

/// The text of a JSON file, indented by two and ended by a line feed. Numbers have as many digits as
/// it takes to read back the same double. Bytes that are not UTF-8 (in a reason read from a foreign
/// file, say) become U+FFFD.
[[nodiscard]] std::string json_text(const Json& json);

} // namespace wingspread
