/// The largest value of a quantity so far, and its time.
#pragma once

#include "core/number/scalar.hpp"

namespace wingspread {

/// For one run or for packs of runs. The outcome reports it as `Peak`.
template <class T> struct PeakOf {
  T value = T(0);
  T time = T(0);

  void raise(const T& candidate, const T& when) {
    const auto higher = candidate > value && candidate - candidate == T(0);
    value = select(higher, candidate, value); // a value that overflows fails the run elsewhere
    time = select(higher, when, time);
  }
};

/// The maximum between samples is sought only if the largest of nine samples over a step reaches this share of the
/// known peak.
///
/// Heuristic. A swing of x rad over the step is sampled within x/16 of its crest, where it has cos(x/16) of its
/// height: 0.95 suffices up to x = 5.08, 0.8 of a period. Roughness (core/dense) keeps a swing that dominates its
/// coordinate below 2.6 rad. Too large a margin misses peaks; too small a one costs evaluations. A swing of
/// 1.27 periods breaks it (cos 0.5 = 0.88), and so does a jump: a damped loop drops ½ D ė where a strand goes
/// slack, and a crest at the jump may stand more than 5 % above both samples beside it.
inline constexpr double sample_margin = 0.95;

} // namespace wingspread
