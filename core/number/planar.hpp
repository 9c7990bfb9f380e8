/// Vectors of the plane and symmetric 2×2 matrices.
///
/// Not Eigen's types: fused multiply-adds must be written out as `fused`, because contraction by the compiler is off.
/// And a symmetric matrix needs three numbers only.
#pragma once

#include "core/number/scalar.hpp"
#include "core/number/sine_cosine.hpp"

#include <cmath>

namespace wingspread {

template <class T> struct Vec2 {
  T x;
  T y;
};

/// [[xx, xy], [xy, yy]]
template <class T> struct Sym2 {
  T xx;
  T xy;
  T yy;
};

template <class T>
[[nodiscard, gnu::always_inline]] inline Vec2<T> operator+(const Vec2<T>& a, const Vec2<T>& b) {
  return {a.x + b.x, a.y + b.y};
}
template <class T>
[[nodiscard, gnu::always_inline]] inline Vec2<T> operator-(const Vec2<T>& a, const Vec2<T>& b) {
  return {a.x - b.x, a.y - b.y};
}
template <class T>
[[nodiscard, gnu::always_inline]] inline Sym2<T> operator+(const Sym2<T>& a, const Sym2<T>& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
}
template <class T>
[[nodiscard, gnu::always_inline]] inline Vec2<T> scaled(const T& s, const Vec2<T>& a) {
  return {s * a.x, s * a.y};
}
/// s·a + b
template <class T>
[[nodiscard, gnu::always_inline]] inline Vec2<T> fused(const T& s, const Vec2<T>& a,
                                                       const Vec2<T>& b) {
  return {fused(s, a.x, b.x), fused(s, a.y, b.y)};
}
/// a·b + c
template <class T>
[[nodiscard, gnu::always_inline]] inline T fused_dot(const Vec2<T>& a, const Vec2<T>& b,
                                                     const T& c) {
  return fused(a.x, b.x, fused(a.y, b.y, c));
}
template <class T>
[[nodiscard, gnu::always_inline]] inline T dot(const Vec2<T>& a, const Vec2<T>& b) {
  return fused(a.x, b.x, a.y * b.y);
}
/// a × b
template <class T>
[[nodiscard, gnu::always_inline]] inline T cross(const Vec2<T>& a, const Vec2<T>& b) {
  return a.x * b.y - a.y * b.x;
}
/// |a|
template <class T> [[nodiscard, gnu::always_inline]] inline T length(const Vec2<T>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}
/// K a
template <class T>
[[nodiscard, gnu::always_inline]] inline Vec2<T> operator*(const Sym2<T>& k, const Vec2<T>& a) {
  return {fused(k.xx, a.x, k.xy * a.y), fused(k.xy, a.x, k.yy * a.y)};
}
/// K a + b
template <class T>
[[nodiscard, gnu::always_inline]] inline Vec2<T> fused(const Sym2<T>& k, const Vec2<T>& a,
                                                       const Vec2<T>& b) {
  return {fused(k.xx, a.x, fused(k.xy, a.y, b.x)), fused(k.xy, a.x, fused(k.yy, a.y, b.y))};
}
/// e3 × a: a turned by +90°
template <class T> [[nodiscard, gnu::always_inline]] inline Vec2<T> turned(const Vec2<T>& a) {
  return {-a.y, a.x};
}

/// a turned by the angle whose sine and cosine are given
template <class T>
[[nodiscard, gnu::always_inline]] inline Vec2<T> rotated(const SineCosine<T>& r, const Vec2<T>& a) {
  return {fused(r.cosine, a.x, -(r.sine * a.y)), fused(r.sine, a.x, r.cosine * a.y)};
}

} // namespace wingspread
