/// Intervals of numbers. The laws state their bounds over an interval of motion as such ranges.
#pragma once

#include "core/number/scalar.hpp"

#include <array>
#include <cstddef>

namespace wingspread {

template <class T> struct ValueRange {
  T low, high;

  friend ValueRange operator+(const ValueRange& a, const ValueRange& b) {
    return {a.low + b.low, a.high + b.high};
  }
  void include(const T& x) { low = smaller(low, x), high = larger(high, x); }
};

/// The range times a factor of either sign.
template <class T> [[nodiscard]] ValueRange<T> scaled(const T& by, const ValueRange<T>& range) {
  const T a = by * range.low, b = by * range.high;
  return {smaller(a, b), larger(a, b)};
}

/// The products of a number of one range and a number of the other.
template <class T>
[[nodiscard]] ValueRange<T> operator*(const ValueRange<T>& a, const ValueRange<T>& b) {
  ValueRange<T> range = scaled(a.low, b);
  range.include(a.high * b.low), range.include(a.high * b.high);
  return range;
}

/// The range that a polynomial's Bernstein coefficients span; its values lie inside.
template <class T, std::size_t N> [[nodiscard]] ValueRange<T> hull(const std::array<T, N>& p) {
  ValueRange<T> range{p[0], p[0]};
  for (std::size_t k = 1; k < N; ++k) range.include(p[k]);
  return range;
}

/// The largest magnitude in a range.
template <class T> [[nodiscard]] T largest_magnitude_of(const ValueRange<T>& range) {
  using std::abs;
  return larger(T(abs(range.low)), T(abs(range.high)));
}

/// The smallest magnitude in a range; 0 where the range holds numbers of both signs.
template <class T> [[nodiscard]] T smallest_magnitude_of(const ValueRange<T>& range) {
  using std::abs;
  return select(range.low < T(0) && range.high > T(0), T(0),
                smaller(T(abs(range.low)), T(abs(range.high))));
}

/// A range, and whether it is known; for packs: in which lanes.
template <class T> struct KnownRange {
  using Mask = decltype(T(0) < T(0));
  ValueRange<T> range{T(0), T(0)};
  Mask known = T(0) <= T(0);

  void add(const ValueRange<T>& more) { range = range + more; }
  void add(const KnownRange& more) { known = known && more.known, add(more.range); }
};

} // namespace wingspread
