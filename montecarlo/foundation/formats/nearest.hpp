/// The known word that a misspelt word probably means.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace wingspread {

/// The fewest insertions, deletions and substitutions of bytes, and swaps of two neighbours, that turn one word into
/// the other; no byte is changed twice (optimal string alignment). Cost O(|a| |b|).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known word nearest to `word`, the first of several; empty if more than half of the longer word would change.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& known);

/// " (did you mean "mass"?)"; empty if no known word is near.
[[nodiscard]] std::string did_you_mean(std::string_view word,
                                       const std::vector<std::string>& known);

} // namespace wingspread
