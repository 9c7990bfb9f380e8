/// The JSON value used throughout. Numbers that are not finite, and missing ones, are written as null (RFC 8259).
#pragma once

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace wingspread {

/// Objects keep the order of their keys.
using Json = nlohmann::ordered_json;

[[nodiscard]] Json json_number(double value);
/// The number rounded to so many significant digits.
[[nodiscard]] Json json_number(double value, int digits);
[[nodiscard]] Json json_number(const std::optional<double>& value);

/// Rounds to so many significant digits; −0 becomes 0, NaN and infinities stay.
[[nodiscard]] double rounded(double value, int digits);

/// The text of a JSON file: indented by two, with a line feed at the end. Numbers read back to the same double. Bytes
/// that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string json_text(const Json& json);

} // namespace wingspread
