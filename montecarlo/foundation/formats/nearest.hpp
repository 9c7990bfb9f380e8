/// The known word that a misspelt word probably means.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// Levenshtein's distance: the fewest insertions, deletions and substitutions of bytes that turn
/// one word into the other. Cost O(|a| |b|).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known word nearest to `word`, the first of several; empty if more than half of the longer word would change.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& known);

/// " (did you mean "mass"?)"; empty if no known word is near.
[[nodiscard]] std::string did_you_mean(std::string_view word,
                                       const std::vector<std::string>& known);

} // namespace wingspread
