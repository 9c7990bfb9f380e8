/// Strict JSON (RFC 8259) from text or a file.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace wingspread {

/// How deep brackets may stand within each other: campaigns take eight levels.
inline constexpr std::size_t most_json_levels = 64;

/// @param file the name that problems carry
/// @throws SpecError for broken syntax, NaN and Infinity included (with line and column), and for
///   numbers beyond a double and keys that stand twice in one object (with their pointer)
[[nodiscard]] Json parse_json(const std::string& text, const std::string& file = "");

/// @throws as parse_json and read_text (files.hpp) do, and SpecError when there is no such file
[[nodiscard]] Json parse_json_file(const std::filesystem::path& path);

/// A key as a JSON pointer's last token: "/key", with "~" and "/" escaped.
[[nodiscard]] std::string pointer_token(std::string_view key);

} // namespace wingspread
