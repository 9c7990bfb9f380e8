/// Strict JSON (RFC 8259) from text or a file.
#pragma once

#include "montecarlo/formats/json.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace wingspread {

/// @param file the name that problems carry
/// @throws SpecError for broken syntax, NaN and Infinity included (with line and column), and for
///   numbers beyond a double and keys that stand twice in one object (with their pointer)
[[nodiscard]] Json parse_json(const std::string& text, const std::string& file = "");

/// @throws SpecError as parse_json does, and when the file cannot be read
[[nodiscard]] Json parse_json_file(const std::filesystem::path& path);

/// A key as a JSON pointer's last token: "/key", with "~" and "/" escaped.
[[nodiscard]] std::string pointer_token(std::string_view key);

} // namespace wingspread
