/// What the kernel asks of a number, so that one algorithm serves double, long double, quad and
/// packs of runs.
///
/// A number offers + − · /, comparison, and the functions below, found by overload: for a pack a
/// comparison yields a mask and `select` blends, so the kernel chooses with `select`, never with
/// `if`.
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#if defined(__FMA__) || defined(__aarch64__)
#define WINGSPREAD_HAS_FMA // this translation unit's instruction set multiplies and adds at once
#endif

namespace wingspread {

template <class T>
[[nodiscard, gnu::always_inline]] inline T select(bool mask, const T& a, const T& b) {
  return mask ? a : b;
}

/// Whether it holds in any lane.
[[nodiscard]] inline bool any(bool mask) { return mask; }

/// a·b + c. One rounding where the instruction set has it for this type, two elsewhere; written out
/// because the compiler's own contraction is off and results must not depend on its choices.
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

/// True when x is neither infinite nor NaN.
template <class T> [[nodiscard, gnu::always_inline]] inline bool is_finite(const T& x) {
  return x - x == T(0);
}

template <class T> [[nodiscard, gnu::always_inline]] inline T larger(const T& a, const T& b) {
  return select(a < b, b, a);
}
template <class T> [[nodiscard, gnu::always_inline]] inline T smaller(const T& a, const T& b) {
  return select(b < a, b, a);
}

/// Whether T is one number, whose comparisons are true or false; a pack's are masks.
template <class T>
inline constexpr bool is_one_number = std::is_same_v<decltype(std::declval<T>() < T(0)), bool>;

template <class T>
inline constexpr double epsilon_of = static_cast<double>(std::numeric_limits<T>::epsilon());

} // namespace wingspread
