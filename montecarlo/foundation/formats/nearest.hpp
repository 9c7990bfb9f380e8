/// The known word that a misspelt one was probably meant to be.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// Levenshtein's distance: the fewest insertions, deletions and substitutions of bytes that turn
/// one word into the other. Cost O(|a| |b|).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known word nearest to `word`, the first among equals; empty when none is near enough to be
/// meant (more than half of the longer word would have to change).
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& known);

/// " (did you mean "mass"?)", or nothing when no known word is near.
[[nodiscard]] std::string did_you_mean(std::string_view word,
                                       const std::vector<std::string>& known);

} // namespace wingspread
