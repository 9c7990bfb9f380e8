/// What a campaign asks of its statistics: plain data.
#pragma once

#include <array>
#include <string_view>
#include <variant>
#include <vector>

namespace wingspread {

/// Let the data choose the bins (Freedman–Diaconis, see histogram.hpp).
struct AutoBins {};
/// The data's choice, or a fixed number of bins > 0.
using Bins = std::variant<AutoBins, int>;

/// On which side of the values a limit is.
enum class Side { upper, lower, both };
inline constexpr std::array<std::string_view, 3> side_names{"upper", "lower", "both"};

/// Tolerance limits of every output: a share `probability` of all wings lies within them.
struct ToleranceSpec {
  double probability = 0, confidence = 0; ///< each in (0, 1)
  Side side = Side::upper;
};

struct StatisticsSpec {
  std::vector<double> quantiles{0.01, 0.5, 0.99}; ///< probabilities, each in (0, 1)
  double confidence = 0.95;                       ///< of every bound, two-sided, in (0, 1)
  Bins bins = AutoBins{};
  std::vector<ToleranceSpec> tolerance{};
};

} // namespace wingspread
