/// Discrete, empirical and constant laws as a table of values.
#pragma once

#include "distributions/distribution.hpp"

#include <vector>

namespace wingspread {

/// The values of positive probability, in order, with the law's tails at each.
struct StepLaw {
  std::vector<double> values; ///< ascending; may repeat
  std::vector<double> below;  ///< P(X ≤ value), as far as this entry; the last is 1
  std::vector<double> above;  ///< P(X > value), likewise; the last is 0
};

/// The table of a law without faults. Cost O(n log n).
[[nodiscard]] StepLaw step_law(const Discrete& law);
[[nodiscard]] StepLaw step_law(const Empirical& law);
[[nodiscard]] StepLaw step_law(const Constant& law);

/// The generalized inverse: the smallest value with P(X ≤ value) ≥ u. Cost O(log n), as below.
[[nodiscard]] double quantile(const StepLaw& law, double u);

/// The smallest value with P(X > value) ≤ q. Not quantile(1 − q): a step that q meets exactly could
/// be missed by the rounding of 1 − q.
[[nodiscard]] double quantile_complement(const StepLaw& law, double q);

[[nodiscard]] double cdf(const StepLaw& law, double x);            ///< P(X ≤ x)
[[nodiscard]] double cdf_complement(const StepLaw& law, double x); ///< P(X > x)

} // namespace wingspread
