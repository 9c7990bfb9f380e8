/// Groups reasons that differ only in their numbers.
#pragma once

#include "core/outcome.hpp"

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wingspread {

/// A reason cut at its numbers: words[0], numbers[0], words[1], …, last words. A digit within a name ("panel_1",
/// "parent_point.0") is no number.
struct ReasonPattern {
  std::vector<std::string> words;
  std::vector<std::string> numbers; ///< one fewer than words; "…" if reasons differ
};

[[nodiscard]] ReasonPattern pattern_of(std::string_view reason);

/// Replaces the numbers in which `other` differs by "…". @pre the same words
void widen(ReasonPattern& pattern, const ReasonPattern& other);

/// "bodies.panel_1.mass is …, expected > 0"
[[nodiscard]] std::string to_string(const ReasonPattern& pattern);

/// The number of runs with one status and one reason; in the reason "…" replaces numbers in which the runs differ.
struct ReasonCount {
  Status status;
  std::string reason;
  long count = 0;
};

/// Counts runs by status and reason. Reasons that differ only in their numbers are counted together.
struct ReasonCounts {
  struct Group {
    ReasonPattern pattern;
    long count = 0;
  };
  std::map<std::pair<Status, std::vector<std::string>>, Group> groups{}; ///< by status and words

  /// Counts a run; an empty reason is not counted.
  void add(Status status, std::string_view reason);
  void add(const ReasonCounts& other);
  /// By status, then the most frequent first, then by text.
  [[nodiscard]] std::vector<ReasonCount> sorted() const;
};

} // namespace wingspread
