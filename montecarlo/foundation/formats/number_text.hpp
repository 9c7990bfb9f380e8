/// Numbers from text, in any locale.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace wingspread {

/// The number that is the whole text; nothing otherwise, or if the type cannot hold it. Floating-point types take "inf"
/// and "nan".
template <class Number> [[nodiscard]] std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, number);
  return error == std::errc{} && last == end ? std::optional(number) : std::nullopt;
}

} // namespace wingspread
