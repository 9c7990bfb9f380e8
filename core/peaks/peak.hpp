/// The largest value that a quantity has taken, and when.
#pragma once

#include "core/number/scalar.hpp"

namespace wingspread {

/// In the run's own numbers, or in packs of runs; `Peak` of the outcome is what is told of it.
template <class T> struct PeakOf {
  T value = T(0);
  T time = T(0);

  void raise(const T& candidate, const T& when) {
    const auto higher = candidate > value && candidate - candidate == T(0);
    value = select(higher, candidate, value); // what overflows fails the run
    time = select(higher, when, time);
  }
};

/// How far below the peak a sample may lie
/// for the maximum beside it to be looked for, times the peak.
inline constexpr double sample_margin = 0.95;

} // namespace wingspread
