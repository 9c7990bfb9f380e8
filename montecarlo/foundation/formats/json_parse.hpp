/// Strict JSON (RFC 8259) from text or a file.
#pragma once

#include "montecarlo/foundation/formats/json.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace wingspread {

/// The deepest nesting that is read; campaigns have eight levels. Limits the recursion of functions that walk through a
/// document.
inline constexpr std::size_t most_json_levels = 64;

/// @param file name for the messages
/// @throws SpecError for wrong syntax, NaN and Infinity (with line and column), for numbers beyond a double, repeated
///   keys and too deep nesting (with the pointer)
[[nodiscard]] Json parse_json(const std::string& text, const std::string& file = "");

/// @throws as parse_json and read_text (files.hpp); SpecError if the file does not exist
[[nodiscard]] Json parse_json_file(const std::filesystem::path& path);

/// A key as a token of a JSON pointer: "/key", with "~" and "/" escaped.
[[nodiscard]] std::string pointer_token(std::string_view key);

} // namespace wingspread
