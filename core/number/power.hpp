/// Powers with the same bits for a double and in every lane of a pack. Rough ones, with errors of about 1e-7, serve
/// step control. A precise one, with an error of some roundings, serves laws of hinges.
#pragma once

#include "core/number/pack.hpp"

#include <array>
#include <cstddef>
#include <initializer_list>

namespace wingspread {

/// log2 x, absolute error ≤ 5e-8. @pre x is positive, normal and finite
template <class P> [[nodiscard, gnu::always_inline]] inline P log2_roughly(const P& x) {
  const auto bits = detail::bits_of(x);
  const auto exponent = (bits - 0x3fe6a09e667f3bcd) >> 52; // x = m 2ᵉ, √½ ≤ m < √2
  const P m = detail::number_of(bits - (exponent << 52));
  const P e = detail::number_of(exponent + 0x4338000000000000) - P(0x1.8p52);
  const P s = (m - P(1.0)) / (m + P(1.0)), z = s * s;
  const P series = fused(
      z, fused(z, fused(z, P(0.41219858311113244), P(0.57707801635558535)), P(0.96179669392597560)),
      P(2.8853900817779268)); // 2/ln 2 · artanh s
  return fused(s, series, e);
}

/// 2ˣ, relative error ≤ 2e-7. @pre |x| ≤ 1000
template <class P> [[nodiscard, gnu::always_inline]] inline P exp2_roughly(const P& x) {
  const P shifted = x + P(0x1.8p52); // the nearest integer stands in the low mantissa bits
  const P r = x - (shifted - P(0x1.8p52));
  P p(1.5403530393381606e-4); // ln2ⁿ/n!, n = 6 … 0
  for (const double c : {1.3333558146428443e-3, 9.6181291076284772e-3, 5.5504108664821580e-2,
                         0.24022650695910072, 0.69314718055994531, 1.0})
    p = fused(r, p, P(c));
  return detail::number_of(detail::bits_of(p) + (detail::bits_of(shifted) << 52));
}

/// xʸ to 1e-6, while |y log2 x| ≤ 1000. @pre x is positive, normal and finite
[[nodiscard]] inline double power_roughly(double x, double y) {
  return exp2_roughly(y * log2_roughly(x));
}

namespace detail {

/// Σ c_k xᵏ by Estrin's scheme [1960]: sums in pairs, which the processor computes at the same time.
template <class P, std::size_t n>
[[nodiscard, gnu::always_inline]] inline P estrin(P x, const std::array<double, n>& c) {
  std::array<P, (n + 1) / 2> sums;
  for (std::size_t k = 0; k < sums.size(); ++k)
    sums[k] = 2 * k + 1 < n ? fused(x, P(c[2 * k + 1]), P(c[2 * k])) : P(c[2 * k]);
  for (std::size_t left = sums.size(); left > 1; left = (left + 1) / 2) {
    x = x * x;
    for (std::size_t k = 0; k < (left + 1) / 2; ++k)
      sums[k] = 2 * k + 1 < left ? fused(x, sums[2 * k + 1], sums[2 * k]) : sums[2 * k];
  }
  return sums[0];
}

} // namespace detail

/// xʸ with relative error ≤ (4 + 2|y|) 2⁻⁵³. With x = m 2ᵉ, √½ ≤ m < √2:
///
///     xʸ = 2ⁿ 2ʳ,  n the integer nearest to y (e + log2 m),  r = (y e − n) + y log2 m
///
/// y is split, and its upper bits times e are exact, so that y e − n loses no digits. Wider number types
/// use the library. Results beyond 2^±1000 are 2^±1000; x = NaN or ∞ gives NaN.
/// @pre x is positive and normal
template <class P>
[[nodiscard, gnu::always_inline]] inline P power_precisely(const P& x, const P& y) {
  if constexpr (!is_of_doubles<P>) {
    using std::pow;
    return pow(x, y);
  } else {
    const auto bits = detail::bits_of(x);
    const auto exponent = (bits - 0x3fe6a09e667f3bcd) >> 52;
    const P m = detail::number_of(bits - (exponent << 52));
    const P e = detail::number_of(exponent + 0x4338000000000000) - P(0x1.8p52);
    const P s = (m - P(1.0)) / (m + P(1.0)), z = s * s;
    const P log = fused( // 2/((2k + 1) ln 2)
        z,
        detail::estrin(z, std::array{0.96179669392597560, 0.57707801635558530, 0.41219858311113240,
                                     0.32059889797532520, 0.26230818925253880, 0.22195308321368667,
                                     0.19235933878519512, 0.16972882833987804, 0.15186263588304877,
                                     0.13739952770371080}),
        P(2.8853900817779268));
    const P high = detail::number_of(detail::bits_of(y) >> 12 << 12); // times e without rounding
    const P part = fused(y - high, e, y * (s * log)), most = high * e;
    const P whole = larger(P(-1000.0), smaller(P(1000.0), P(most + part)));
    const P shifted = whole + P(0x1.8p52), n = shifted - P(0x1.8p52);
    const P r = larger(P(-1.0), smaller(P(1.0), P((most - n) + part)));
    const P p = fused( // ln2ⁿ/n!
        r,
        detail::estrin(
            r, std::array{0.69314718055994530, 0.24022650695910072, 5.5504108664821580e-2,
                          9.6181291076284770e-3, 1.3333558146428443e-3, 1.5403530393381610e-4,
                          1.5252733804059841e-5, 1.3215486790144310e-6, 1.0178086009239700e-7,
                          7.0549116208011230e-9, 4.4455382718708116e-10, 2.5678435993488206e-11,
                          1.3691488853904128e-12}),
        P(1.0));
    const P result = detail::number_of(detail::bits_of(p) + (detail::bits_of(shifted) << 52));
    return result + (x - x);
  }
}

} // namespace wingspread
