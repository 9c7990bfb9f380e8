/// A base driven by a table of time, over one piece of it.
///
/// | symbol  | meaning                                                  | unit          |
/// |---------|----------------------------------------------------------|---------------|
/// | u       | t − from                                                 | s             |
/// | a, α    | acceleration of its origin; angular: cubics in u         | m/s², rad/s²  |
/// | v, Ω, θ | velocity, rate, angle: exact integrals of these          | m/s, rad/s, rad |
///
/// Which piece it is, a run keeps as it keeps the modes of its hinges: it changes at knots, where
/// steps end, so that inside a step the motion is smooth, and no piece is looked for.
#pragma once

#include "core/number/planar.hpp"
#include "core/scene/base_table.hpp"

#include <array>

namespace wingspread {

inline constexpr double never = 1e300; ///< s

template <class T> struct DrivenPiece {
  int number;                     ///< of the table's pieces
  T from;                         ///< s
  T until;                        ///< the next knot, s; `never` after the last
  std::array<T, 4> x, y, turning; ///< a and α in powers of u
  Vec2<T> velocity;               ///< at `from`, as the next two
  T rate, angle;
};

/// c in powers of u + w instead of u.
template <class T> [[nodiscard]] std::array<T, 4> shifted(const std::array<T, 4>& c, const T& w) {
  return {fused(w, fused(w, fused(w, c[3], c[2]), c[1]), c[0]),
          fused(w, fused(w, T(3) * c[3], T(2) * c[2]), c[1]), fused(T(3) * c[3], w, c[2]), c[3]};
}

template <class T> [[nodiscard]] T cubic_at(const std::array<T, 4>& c, const T& u) {
  return fused(u, fused(u, fused(u, c[3], c[2]), c[1]), c[0]);
}
/// ∫ of it from 0 to u.
template <class T> [[nodiscard]] T cubic_integral(const std::array<T, 4>& c, const T& u) {
  const T high = fused(u, T(0.25) * c[3], c[2] / T(3));
  return u * fused(u, fused(u, high, T(0.5) * c[1]), c[0]);
}
/// ∫ of that from 0 to u.
template <class T> [[nodiscard]] T cubic_double_integral(const std::array<T, 4>& c, const T& u) {
  const T high = fused(u, c[3] / T(20), c[2] / T(12));
  return u * u * fused(u, fused(u, high, c[1] / T(6)), T(0.5) * c[0]);
}

template <class T> [[nodiscard]] Vec2<T> acceleration(const DrivenPiece<T>& base, const T& t) {
  const T u = t - base.from;
  return {cubic_at(base.x, u), cubic_at(base.y, u)};
}
template <class T> [[nodiscard]] Vec2<T> velocity(const DrivenPiece<T>& base, const T& t) {
  const T u = t - base.from;
  return base.velocity + Vec2<T>{cubic_integral(base.x, u), cubic_integral(base.y, u)};
}

/// How the base turns at t.
template <class T> struct Turning { T acceleration, rate, angle; };

template <class T> [[nodiscard]] Turning<T> turning(const DrivenPiece<T>& base, const T& t) {
  const T u = t - base.from;
  return {cubic_at(base.turning, u), base.rate + cubic_integral(base.turning, u),
          fused(u, base.rate, base.angle) + cubic_double_integral(base.turning, u)};
}

/// No |c|, |c'|, |c''| is larger for u from 0 to h.
template <class T> struct CubicBounds { T value, first, second; };

template <class T>
[[nodiscard]] CubicBounds<T> cubic_bounds(const std::array<T, 4>& c, const T& h) {
  using std::abs;
  const T c1 = abs(c[1]), c2 = abs(c[2]), c3 = abs(c[3]);
  return {fused(h, fused(h, fused(h, c3, c2), c1), T(abs(c[0]))),
          fused(h, fused(h, T(3) * c3, T(2) * c2), c1), fused(T(6) * h, c3, T(2) * c2)};
}

/// Whether nothing of the motion changes any more but the angle.
template <class T> [[nodiscard]] bool is_steady(const DrivenPiece<T>& base) {
  bool steady = !(base.until < T(never)) && base.turning[0] == T(0);
  for (int power = 1; power < 4; ++power)
    steady =
        steady && base.x[power] == T(0) && base.y[power] == T(0) && base.turning[power] == T(0);
  return steady;
}

} // namespace wingspread
