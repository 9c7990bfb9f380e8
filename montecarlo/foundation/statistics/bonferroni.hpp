/// Confidence of several statements together.
#pragma once

#include <span>

namespace wingspread {

/// The confidence of each of `count` statements so that all hold together with the given confidence, however they
/// depend on each other: α is split equally (Bonferroni). So a bound taken at each of several interim analyses holds
/// wherever the campaign stops.
/// @pre count ≥ 0; for 0 and 1 the result is `confidence`
[[nodiscard]] double at_each_of(double confidence, long count);

/// A lower bound of the confidence with which statements of these confidences hold together, however they depend on
/// each other: 1 − Σ(1 − c), or 0 if that is negative. 1 without statements.
[[nodiscard]] double joint_confidence(std::span<const double> confidences);

} // namespace wingspread
