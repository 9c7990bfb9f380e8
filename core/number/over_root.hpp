/// n/√x by multiplications alone, which overlap: a root and a division of all lanes wait for each
/// other in the one unit of a processor that makes both.
#pragma once

#include "core/number/pack.hpp"

namespace wingspread {

/// n/√x with a relative error of 2⁻⁵² at most and the same bits for a double and in every lane; of
/// wider numbers by root and division.
///
/// Halving the bits of x halves its exponent and gives y = 1/√x to 3.5 %; with e = 1 − x y² it is
/// y (1 − e)^−½, whose series takes that to 4e-7 in one move and to round-off in another.
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
