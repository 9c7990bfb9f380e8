/// Powers, binary logarithm and exponential for step control: good to 1e-7, which is more than a
/// step's size needs, and with the same bits for a double and in every lane of a pack.
#pragma once

#include "core/number/pack.hpp"

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

} // namespace wingspread
