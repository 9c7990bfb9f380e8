#include "montecarlo/foundation/formats/printable.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wingspread {
namespace {

unsigned char byte_at(std::string_view text, std::size_t i) {
  return static_cast<unsigned char>(text[i]);
}

/// The length of the control character at `at` in bytes, 0 if there is none: 1 in ASCII, 2 for U+0080 to U+009F in
/// UTF-8.
std::size_t control_bytes(std::string_view text, std::size_t at) {
  const unsigned char first = byte_at(text, at);
  if (first < 0x20 || first == 0x7F) return 1;
  const unsigned char next = at + 1 < text.size() ? byte_at(text, at + 1) : 0;
  return first == 0xC2 && next >= 0x80 && next < 0xA0 ? 2 : 0;
}

/// The length of the UTF-8 character at `at` in bytes, 0 if there is none. Overlong forms, surrogates and code points
/// above U+10FFFF are none (table 3-7 of the Unicode standard).
std::size_t character_bytes(std::string_view text, std::size_t at) {
  const unsigned char first = byte_at(text, at);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || at + length > text.size()) return 0;
  const unsigned char least = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
  const unsigned char most = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
  if (byte_at(text, at + 1) < least || byte_at(text, at + 1) > most) return 0;
  for (std::size_t i = 2; i < length; ++i)
    if ((byte_at(text, at + i) & 0xC0) != 0x80) return 0;
  return length;
}

/// The number of bytes at `at` that are to be escaped; 0: a character to print.
std::size_t escaped_bytes(std::string_view text, std::size_t at) {
  if (text[at] == '\n' || text[at] == '\t') return 0;
  if (const std::size_t control = control_bytes(text, at); control > 0) return control;
  return character_bytes(text, at) == 0 ? 1 : 0;
}

} // namespace

bool has_control_characters(std::string_view text) {
  for (std::size_t at = 0; at < text.size(); ++at)
    if (control_bytes(text, at) > 0) return true;
  return false;
}

std::string printable(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t escaped = escaped_bytes(text, at);
    for (std::size_t i = 0; i < escaped; ++i)
      result += fmt::format("\\x{:02x}", byte_at(text, at + i));
    const std::size_t whole = escaped == 0 ? character_bytes(text, at) : 0;
    result += text.substr(at, whole);
    at += escaped + whole;
  }
  return result;
}

std::string shell_word(const std::string& word) {
  constexpr std::string_view plain = "_@%+=:,./-";
  const auto is_plain = [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           plain.find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string(R"('\'')") : std::string(1, c);
  return quoted + "'";
}

} // namespace wingspread
