/// What bounds a quantity with some confidence.
#pragma once

#include <optional>

namespace wingspread {

struct Interval {
  double lower, upper;
};

/// An interval whose ends may not exist: the sample is too small for them.
struct Bounds {
  std::optional<double> lower, upper;
};

} // namespace wingspread
