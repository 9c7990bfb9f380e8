/// Several statements at once, each with a risk of its own.
#pragma once

#include <span>

namespace wingspread {

/// α = 1 − confidence split equally over several statements: of intervals with this confidence each,
/// all hold at once with the confidence given, however they depend on each other (Bonferroni). So a
/// bound that is taken at each of several looks at growing data holds wherever one stops.
/// @pre count ≥ 0; none and one are the confidence itself
[[nodiscard]] double at_each_of(double confidence, long count);

/// At least the confidence with which statements of these confidences all hold together, however
/// they depend on each other: 1 − Σ(1 − c), and 0 where that is less. 1 without any.
[[nodiscard]] double joint_confidence(std::span<const double> confidences);

} // namespace wingspread
