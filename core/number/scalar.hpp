/// The functions that a number type must have, so that one algorithm serves double, long double, quad
/// and packs of runs.
///
/// A number has + − · /, comparisons, and overloads of the functions below. The comparison of two packs
/// is a mask, one truth value a lane. Algorithms therefore choose with `select`, and never with `if`.
///
/// The attributes of this room are measured together (callgrind; instructions of runs in AVX2 lanes or alone).
/// Without those of scalar.hpp, pack.hpp and planar.hpp GCC 12 takes 4 % more for seed wings in lanes, 1 % with
/// friction. Without those of the other files, too, it takes 35 % more for runs with friction alone.
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#if defined(__FMA__) || defined(__aarch64__)
#define WINGSPREAD_HAS_FMA // this translation unit may use fused multiply-add instructions
#endif

namespace wingspread {

template <class T>
[[nodiscard, gnu::always_inline]] inline T select(bool mask, const T& a, const T& b) {
  return mask ? a : b;
}

/// Whether a mask, or a truth value, is true in any lane.
[[nodiscard]] inline bool any(bool mask) { return mask; }

/// a·b + c, with one rounding if the instruction set can, else with two. Explicit, because results must
/// not depend on where a compiler contracts: -ffp-contract=off.
template <class T>
[[nodiscard, gnu::always_inline]] inline T fused(const T& a, const T& b, const T& c) {
  return a * b + c;
}
#ifdef WINGSPREAD_HAS_FMA
template <>
[[nodiscard, gnu::always_inline]] inline double fused<double>(const double& a, const double& b,
                                                              const double& c) {
  return __builtin_fma(a, b, c);
}
#endif

/// Whether x is neither infinite nor NaN.
template <class T> [[nodiscard, gnu::always_inline]] inline bool is_finite(const T& x) {
  return x - x == T(0);
}

template <class T> [[nodiscard, gnu::always_inline]] inline T larger(const T& a, const T& b) {
  return select(a < b, b, a);
}
template <class T> [[nodiscard, gnu::always_inline]] inline T smaller(const T& a, const T& b) {
  return select(b < a, b, a);
}

/// The type of a comparison: bool for a number, for a pack a mask.
template <class T> using Truth = decltype(std::declval<T>() < T(0));

/// Whether T is a single number and no pack.
template <class T> inline constexpr bool is_one_number = std::is_same_v<Truth<T>, bool>;

/// 2^(1 − digits): a library's number of many digits has no constant expression for it.
template <class T>
inline constexpr double epsilon_of = [] {
  double epsilon = 1;
  for (int digit = 1; digit < std::numeric_limits<T>::digits; ++digit) epsilon /= 2;
  return epsilon;
}();

} // namespace wingspread
