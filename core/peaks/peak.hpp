/// The largest value of a quantity so far, and its time.
#pragma once

#include "core/number/scalar.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace wingspread {

/// For one run or for packs of runs. The outcome reports it as `Peak`.
template <class T> struct PeakOf {
  T value = T(0); ///< largest magnitude, in the quantity's unit
  T time = T(0);  ///< s

  void raise(const T& candidate, const T& when) {
    const auto higher = candidate > value && candidate - candidate == T(0);
    value = select(higher, candidate, value); // a value that overflows fails the run elsewhere
    time = select(higher, when, time);
  }
};

/// How a peak may rise over a step.
enum class Rise : char {
  none,    ///< not at all
  to_ends, ///< to the larger value at the step's ends; none inside is larger
  inside   ///< perhaps to a value inside
};

/// Estimated upper bound of a function over a step from equidistant samples: the largest sample plus a quarter of the
/// largest second difference.
///
/// Heuristic: the vertex of the parabola through three samples stands at most an eighth of their second difference
/// above the largest. A swing of x rad over the step is sampled within a = x/16 of its crest by nine samples, where it
/// has cos a of its height, and (1 + sin² a) cos a ≥ 1 up to x = 14.5, 2.3 periods. Roughness (core/dense) keeps a
/// swing that dominates its coordinate below 2.6 rad. A spike between two samples breaks it: a damped loop drops ½ D ė
/// where a strand goes slack, and the moment may have risen steeply until there.
template <class T, std::size_t N> [[nodiscard]] T most_by_samples(const std::array<T, N>& samples) {
  using std::abs;
  T largest = larger(samples[0], samples[N - 1]), bend(0);
  for (std::size_t k = 1; k + 1 < N; ++k) {
    largest = larger(largest, samples[k]);
    bend = larger(bend, T(abs((samples[k - 1] - samples[k]) + (samples[k + 1] - samples[k]))));
  }
  return fused(T(0.25), bend, largest);
}

} // namespace wingspread
