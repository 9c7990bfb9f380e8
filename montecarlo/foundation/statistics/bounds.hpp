/// Confidence bounds.
#pragma once

#include <optional>

namespace wingspread {

struct Interval {
  double lower, upper;
};

/// An interval whose ends may not exist because the sample is too small.
struct Bounds {
  std::optional<double> lower, upper;
};

} // namespace wingspread
