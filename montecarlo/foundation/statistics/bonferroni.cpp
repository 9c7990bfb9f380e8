#include "montecarlo/foundation/statistics/bonferroni.hpp"

#include <limits>

namespace wingspread {

double at_each_of(double confidence, long count) {
  return count > 1 ? 1 - (1 - confidence) / static_cast<double>(count) : confidence;
}

double joint_confidence(std::span<const double> confidences) {
  double risk = 0;
  for (const double confidence : confidences) risk += 1 - confidence;
  // Each term and each sum rounds by at most half of epsilon: a risk of 1 (ten times 0.9) can come out just below.
  const double rounding =
      static_cast<double>(confidences.size()) * std::numeric_limits<double>::epsilon();
  return risk < 1 - rounding ? 1 - risk : 0;
}

} // namespace wingspread
