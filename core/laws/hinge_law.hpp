/// The interface of a law of a hinge's moment: the functions that every law defines and that all callers use.
///
/// | symbol | meaning                     | unit       |
/// |--------|-----------------------------|------------|
/// | φ, φ̇   | the hinge's angle and rate  | rad, rad/s |
/// | M      | moment on the hinge's body  | N·m        |
/// | P      | potential, −dP/dφ = M       | J          |
///
/// Every function adds to a sum, so one loop over the laws (for_each_law in real_hinge.hpp) serves all callers: the
/// right-hand side, the stiff methods, the peak search, the lanes of packs and the energy audit.
#pragma once

#include "core/number/scalar.hpp"

#include <array>
#include <concepts>
#include <cstddef>

namespace wingspread {

/// An interval of numbers. The laws state their bounds over an interval of motion as such ranges.
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

/// The range of the products of a number of one range with a number of the other.
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

/// −∂M/∂φ and −∂M/∂φ̇.
template <class T> struct HingeResistance {
  T stiffness; ///< N·m/rad
  T damping;   ///< N·m·s/rad
};

/// Ranges of ∂M/∂φ and ∂M/∂φ̇ over an interval of motion.
template <class T> struct MomentSlopes {
  ValueRange<T> by_angle{T(0), T(0)}; ///< N·m/rad
  ValueRange<T> by_rate{T(0), T(0)};  ///< N·m·s/rad

  /// A range of dM/dt, N·m/s.
  [[nodiscard]] ValueRange<T> change(const ValueRange<T>& rate,
                                     const ValueRange<T>& acceleration) const {
    return by_angle * rate + by_rate * acceleration;
  }
};

/// A law offers
///
/// | function       | adds                                                                                |
/// |----------------|-------------------------------------------------------------------------------------|
/// | add_moment     | M(φ, φ̇)                                                                             |
/// | add_resistance | −∂M/∂φ and −∂M/∂φ̇                                                                   |
/// | add_range      | a range that holds M over the given ranges of φ and φ̇                               |
/// | has_slopes     | (returns) whether add_slopes is valid over the range of φ; for packs: in which lanes |
/// | add_slopes     | ranges of ∂M/∂φ and ∂M/∂φ̇ over the given ranges of φ and φ̇                          |
/// | add_potential  | P(φ), zero at the latched angle, if the law stores energy                           |
template <class Law, class T>
concept HingeLaw = requires(const Law& law, T& sum, HingeResistance<T>& resistance,
                            ValueRange<T>& range, MomentSlopes<T>& slopes, const T& x,
                            const ValueRange<T>& over) {
  law.add_moment(sum, x, x);
  law.add_resistance(resistance, x, x);
  law.add_range(range, over, over);
  { law.has_slopes(over) } -> std::same_as<decltype(T(0) < T(0))>;
  law.add_slopes(slopes, over, over);
  law.add_potential(sum, x, x);
};

} // namespace wingspread
