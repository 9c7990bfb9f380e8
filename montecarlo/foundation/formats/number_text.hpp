/// Numbers from text, in any locale.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace wingspread {

/// The number that the whole of the text spells; nothing when it spells none, or one beyond its
/// type. "inf" and "nan" are numbers of a floating-point type.
template <class Number> [[nodiscard]] std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, number);
  return error == std::errc{} && last == end ? std::optional(number) : std::nullopt;
}

} // namespace wingspread
