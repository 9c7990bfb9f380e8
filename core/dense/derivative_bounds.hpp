/// Bounds of a quintic's derivatives over its step, by the hulls of their Bernstein coefficients.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/drive.hpp"

namespace wingspread {

/// Of differences of a quintic's coefficients: k-th ones make coefficients of the k-th derivative.
template <class T> struct DifferenceScale {
  explicit DifferenceScale(const T& h)
      : first(T(5) / h), second(T(0.8) * first * first), third(T(0.6) * first * second),
        fourth(T(0.4) * first * third) {}
  T first, second, third, fourth;
};

/// No |d/dt|, |d²/dt²|, … in the step is larger.
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

/// The same of a quintic over a step so short that its coefficients differ by little more than their
/// rounding, δ of the largest: third and fourth derivatives that 8 δ and 16 δ would explain are none.
template <class T>
[[nodiscard]] DerivativeBounds<T>
derivative_bounds_beyond_rounding(const Quintic<T>& p, const DifferenceScale<T>& scale) {
  DerivativeBounds<T> bounds = derivative_bounds(p, scale);
  const T rounding = T(2) * T(epsilon_of<T>) * bound(p);
  bounds.third = larger(T(0), T(bounds.third - scale.third * T(8) * rounding));
  bounds.fourth = larger(T(0), T(bounds.fourth - scale.fourth * T(16) * rounding));
  return bounds;
}

/// |d⁴/dt⁴ (cos θ, sin θ)| = |i θ⁽⁴⁾ − 4 θ̇ θ⃛ − 3 θ̈² − 6 i θ̇² θ̈ + θ̇⁴| is no larger.
template <class T>
[[nodiscard, gnu::always_inline]] inline T fourth_of_direction(const DerivativeBounds<T>& angle) {
  const T square = angle.first * angle.first;
  const T slow = fused(square, square, T(3) * angle.second * angle.second);
  return angle.fourth +
         fused(T(4) * angle.first, angle.third, fused(T(6) * square, angle.second, slow));
}

/// How far a base of prescribed motion turns over a step: exactly.
/// @param piece of the step, of a base with a table
template <class T>
[[nodiscard]] Quintic<T> turn_of_base(const BaseTerms<T>& base, const DrivenPiece<T>& piece,
                                      const Step<T>& step) {
  if (base.table) {
    const T u = step.t - piece.from, rate = piece.rate + cubic_integral(piece.turning, u);
    const std::array<T, 4> c = shifted(piece.turning, u);
    const T turned = fused(step.h, rate, cubic_double_integral(c, step.h));
    return hermite<T>(step.h, {T(0), rate, c[0]},
                      {turned, rate + cubic_integral(c, step.h), cubic_at(c, step.h)});
  }
  const T& second = base.angular_acceleration;
  const T first = fused(second, step.t, base.rate), last = fused(second, step.h, first);
  const T turned = step.h * fused(T(0.5) * step.h, second, first);
  return hermite<T>(step.h, {T(0), first, second}, {turned, last, second});
}

/// No acceleration that a wing on it feels, no first and no second derivative of that is larger in
/// the step: a base of prescribed motion.
template <class T>
[[nodiscard]] CubicBounds<T> push_of_base(const BaseTerms<T>& base, const DrivenPiece<T>& piece,
                                          const Step<T>& step) {
  using std::sqrt;
  const auto length = [](const T& x, const T& y) { return T(sqrt(fused(x, x, y * y))); };
  if (!base.table) return {length(base.felt().x, base.felt().y), T(0), T(0)};
  std::array<T, 4> x = shifted(piece.x, T(step.t - piece.from));
  std::array<T, 4> y = shifted(piece.y, T(step.t - piece.from));
  x[0] = x[0] - base.gravity.x, y[0] = y[0] - base.gravity.y;
  const CubicBounds<T> a = cubic_bounds(x, step.h), b = cubic_bounds(y, step.h);
  return {length(a.value, b.value), length(a.first, b.first), length(a.second, b.second)};
}

} // namespace wingspread
