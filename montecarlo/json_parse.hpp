/// Strict JSON (RFC 8259) from text or a file.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace wingspread {

/// The JSON value used throughout: its objects keep the order in which they were written.
using Json = nlohmann::ordered_json;

/// @param file the name that problems carry
/// @throws SpecError for broken syntax, NaN and Infinity included (with line and column), and for
///   numbers beyond a double and keys that stand twice in one object (with their pointer)
[[nodiscard]] Json parse_json(const std::string& text, const std::string& file = "");

/// The bytes of a file.
/// @throws SpecError when it cannot be read
[[nodiscard]] std::string read_text(const std::filesystem::path& path);

/// @throws SpecError as parse_json and read_text do
[[nodiscard]] Json parse_json_file(const std::filesystem::path& path);

/// A key as a JSON pointer's last token: "/key", with "~" and "/" escaped.
[[nodiscard]] std::string pointer_token(std::string_view key);

} // namespace wingspread
