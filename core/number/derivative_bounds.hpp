/// Bounds of a quintic's derivatives over its step, by the hulls of their Bernstein coefficients.
#pragma once

#include "core/number/quintic.hpp"

namespace wingspread {

/// Factors that turn the k-th differences of a quintic's coefficients into the coefficients of its k-th derivative.
template <class T> struct DifferenceScale {
  explicit DifferenceScale(const T& h)
      : first(T(5) / h), second(T(0.8) * first * first), third(T(0.6) * first * second),
        fourth(T(0.4) * first * third) {}
  T first, second, third, fourth;
};

/// Largest |d/dt|, |d²/dt²|, … in the step.
template <class T> struct DerivativeBounds { T first, second, third, fourth; };

namespace detail {
template <class T, class... U>
[[nodiscard, gnu::always_inline]] inline T largest_magnitude(const T& first, const U&... rest) {
  using std::abs;
  T most = abs(first);
  ((most = larger(most, T(abs(rest)))), ...);
  return most;
}
} // namespace detail

template <class T>
[[nodiscard, gnu::always_inline]] inline DerivativeBounds<T>
derivative_bounds(const Quintic<T>& p, const DifferenceScale<T>& scale) {
  using detail::largest_magnitude;
  const T a0 = p[1] - p[0], a1 = p[2] - p[1], a2 = p[3] - p[2], a3 = p[4] - p[3], a4 = p[5] - p[4];
  const T b0 = a1 - a0, b1 = a2 - a1, b2 = a3 - a2, b3 = a4 - a3;
  const T c0 = b1 - b0, c1 = b2 - b1, c2 = b3 - b2;
  return {scale.first * largest_magnitude(a0, a1, a2, a3, a4),
          scale.second * largest_magnitude(b0, b1, b2, b3),
          scale.third * largest_magnitude(c0, c1, c2),
          scale.fourth * largest_magnitude(T(c1 - c0), T(c2 - c1))};
}

/// The same bounds for a step so short that the coefficients differ by little more than their rounding δ. Third
/// differences up to 8 δ and fourth ones up to 16 δ count as 0 (8 and 16 are the sums of the binomial coefficients).
template <class T>
[[nodiscard]] DerivativeBounds<T>
derivative_bounds_beyond_rounding(const Quintic<T>& p, const DifferenceScale<T>& scale) {
  DerivativeBounds<T> bounds = derivative_bounds(p, scale);
  const T rounding = T(2) * T(epsilon_of<T>) * bound(p);
  bounds.third = larger(T(0), T(bounds.third - scale.third * T(8) * rounding));
  bounds.fourth = larger(T(0), T(bounds.fourth - scale.fourth * T(16) * rounding));
  return bounds;
}

/// Upper bound of |d⁴/dt⁴ (cos θ, sin θ)| = |i θ⁽⁴⁾ − 4 θ̇ θ⃛ − 3 θ̈² − 6 i θ̇² θ̈ + θ̇⁴|, 1/s⁴.
/// @param angle bounds of the derivatives of θ
template <class T>
[[nodiscard, gnu::always_inline]] inline T fourth_of_direction(const DerivativeBounds<T>& angle) {
  const T square = angle.first * angle.first;
  const T slow = fused(square, square, T(3) * angle.second * angle.second);
  return angle.fourth +
         fused(T(4) * angle.first, angle.third, fused(T(6) * square, angle.second, slow));
}

/// h²/6: by how much a motion's second derivative may leave its chord over h, per unit of the largest fourth
/// derivative of the motion's quintic.
///
/// A function leaves its chord by at most h²/8 of its largest second derivative [Taylor]. Here the bound of the
/// motion's fourth derivative comes from a quintic, whose fourth derivative is below that of a swing. For a sine the
/// second derivative leaves its chord by h²/8 of the quintic's fourth derivative times 1.003, 1.03, 1.11 and 1.32,
/// where the step spans 1/4, 1/2, 0.8 and 1 period. The factor 4/3 covers one period. A faster swing breaks it: 2.2
/// times at 1.27 periods. The step control excludes such a swing unless its amplitude is within the tolerance.
template <class T> [[nodiscard]] T chord_excess(const T& h) { return h * h * T(1.0 / 6); }

} // namespace wingspread
