/// Where two JSON documents differ: for messages about campaigns that are not the same.
#pragma once

#include "montecarlo/foundation/formats/json_parse.hpp"

#include <string>
#include <vector>

namespace wingspread {

/// Messages name at most so many differences.
inline constexpr std::size_t most_differences = 5;

/// A value that differs between two documents; null: missing. It points into both.
struct Difference {
  std::string pointer;
  const Json *found, *expected;
};

/// The innermost values that differ; arrays of different lengths differ as a whole.
/// @pre both documents outlive the result
[[nodiscard]] std::vector<Difference> find_differences(const Json& found, const Json& expected);

/// The value, or "nothing" if it is missing.
[[nodiscard]] std::string describe_or_nothing(const Json* value);

} // namespace wingspread
