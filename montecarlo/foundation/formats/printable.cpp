#include "montecarlo/foundation/formats/printable.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wingspread {
namespace {

/// The length of the control character at `at` in bytes, 0 if there is none: 1 in ASCII, 2 for U+0080 to U+009F in
/// UTF-8.
std::size_t control_bytes(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(at) < 0x20 || byte(at) == 0x7F) return 1;
  return at + 1 < text.size() && byte(at) == 0xC2 && byte(at + 1) >= 0x80 && byte(at + 1) < 0xA0
             ? 2
             : 0;
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
    const std::size_t count = text[at] == '\n' || text[at] == '\t' ? 0 : control_bytes(text, at);
    for (std::size_t i = 0; i < count; ++i)
      result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at + i]));
    if (count == 0) result += text[at];
    at += std::max<std::size_t>(count, 1);
  }
  return result;
}

} // namespace wingspread
