/// Reasons that differ in nothing but their numbers: what many runs have in common.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// A reason cut at its numbers: words[0], numbers[0], words[1], … , the last of the words.
/// A digit within a name ("panel_1", "parent_point.0") is no number.
struct ReasonPattern {
  std::vector<std::string> words;
  std::vector<std::string> numbers; ///< one fewer than the words; "…" where reasons differ
};

[[nodiscard]] ReasonPattern pattern_of(std::string_view reason);

/// Widens a pattern to take in another with the same words.
void widen(ReasonPattern& pattern, const ReasonPattern& other);

/// "bodies.panel_1.mass is …, expected > 0"
[[nodiscard]] std::string to_string(const ReasonPattern& pattern);

} // namespace wingspread
