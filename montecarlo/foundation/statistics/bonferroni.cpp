#include "montecarlo/foundation/statistics/bonferroni.hpp"

#include <algorithm>

namespace wingspread {

double at_each_of(double confidence, long count) {
  return count > 1 ? 1 - (1 - confidence) / static_cast<double>(count) : confidence;
}

double joint_confidence(std::span<const double> confidences) {
  double risk = 0;
  for (const double confidence : confidences) risk += 1 - confidence;
  return std::max(0.0, 1 - risk);
}

} // namespace wingspread
