/// Several statements at once, each with a risk of its own.
#pragma once

namespace wingspread {

/// α = 1 − confidence split equally over several statements: of intervals with this confidence each,
/// all hold at once with the confidence given, however they depend on each other (Bonferroni). So a
/// bound that is taken at each of several looks at growing data holds wherever one stops.
/// @pre count ≥ 0; none and one are the confidence itself
[[nodiscard]] double at_each_of(double confidence, long count);

} // namespace wingspread
