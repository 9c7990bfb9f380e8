/// What a campaign asks of its statistics: plain data.
#pragma once

#include <variant>
#include <vector>

namespace wingspread {

/// Let the data choose the bins (Freedman–Diaconis, see histogram.hpp).
struct AutoBins {};
/// The data's choice, or a fixed number of bins > 0.
using Bins = std::variant<AutoBins, int>;

struct StatisticsSpec {
  std::vector<double> quantiles{0.01, 0.5, 0.99}; ///< probabilities, each in (0, 1)
  double confidence = 0.95;                       ///< of every bound, two-sided, in (0, 1)
  Bins bins = AutoBins{};
};

} // namespace wingspread
