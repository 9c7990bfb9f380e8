/// n/√x by multiplications, which the processor overlaps. A root and a division share
/// one unit of the processor, so they run one after the other.
#pragma once

#include "core/number/pack.hpp"

namespace wingspread {

/// n/√x with a relative error ≤ 2⁻⁵² and the same bits for a double and in every lane. Wider number types
/// use root and division.
///
/// Shifting the bits of x halves its exponent, and gives y ≈ 1/√x within 3.5 %. With e = 1 − x y² the exact
/// value is y (1 − e)^−½. Its series, applied twice, reduces the error to 4e-7 and then to round-off.
/// @pre x is positive, normal and finite
template <class T> [[nodiscard, gnu::always_inline]] inline T over_root(const T& n, const T& x) {
  using std::sqrt;
  if constexpr (!is_of_doubles<T>) {
    return n / sqrt(x);
  } else {
    const T rough = detail::number_of(0x5fe6eb50c7b537a9 - (detail::bits_of(x) >> 1));
    const T e = fused(-x * rough, rough, T(1)), square = e * e;
    const T near =
        fused(rough * e,
              fused(square, fused(T(0.2734375), e, T(0.3125)), fused(T(0.375), e, T(0.5))), rough);
    const T rest = fused(-x * near, near, T(1)), result = n * near;
    return fused(result * rest, fused(T(0.375), rest, T(0.5)), result);
  }
}

} // namespace wingspread
