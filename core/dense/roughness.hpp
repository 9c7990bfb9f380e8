/// Whether the interpolant over a step shows what happens inside.
#pragma once

#include "core/dense/step.hpp"
#include "core/number/power.hpp"

namespace wingspread {

/// The error of the quintic over a step against its tolerance, in hundredths of what the
/// coordinates move: near 1 a step spans a quarter of a period. Estimated by the difference to the
/// cubic, s²(1 − s)² times the line from d0/2 to d1/2, with
///
///     d0 + d1 = h² (φ̈0 + φ̈1) + 2h (φ̇0 − φ̇1)          the even part, 1/64 of it at the middle
///     d1 − d0 = h² (φ̈1 − φ̈0) + 12 (φ1 − φ0) − 6h (φ̇0 + φ̇1)   the odd one, at most 1/(100 √5)
///
/// which grow, against the move, with h³ and h⁴.
/// @return > 1 if the step is too long
template <class T> [[nodiscard]] T roughness(const Layout& at, const Step<T>& step, const T& atol) {
  using std::abs;
  const T& h = step.h;
  const State<T>&dxdt = step.dxdt, &dxdt1 = step.dxdt1;
  T worst(0);
  for (int k = 0; k < at.freedoms(); ++k) {
    const int a = at.freedoms() + k;
    const T even = fused(T(h / T(32)), dxdt[k] - dxdt1[k], h * h / T(64) * (dxdt[a] + dxdt1[a]));
    const T twelfth = fused(h * h / T(12), dxdt1[a] - dxdt[a],
                            fused(T(-0.5) * h, dxdt[k] + dxdt1[k], step.x1[k] - step.x[k]));
    const T rounding = T(4 * 0x1p-52) * larger(T(abs(step.x[k])), T(abs(step.x1[k])));
    const T odd = T(0.12 / 2.2360679774997896) * (abs(twelfth) - rounding);
    const T move = fused(h, larger(T(abs(dxdt[k])), T(abs(dxdt1[k]))), T(T(1e3) * atol));
    worst = larger(worst, larger(T(abs(even)), odd) / (T(0.01) * move));
  }
  return worst;
}

/// The largest factor to the next step, or try, that a step's roughness leaves.
template <class P> [[nodiscard]] P factor_by_roughness(const P& rough) {
  const P root = exp2_roughly(P(P(-1.0 / 3) * log2_roughly(larger(rough, P(0.1)))));
  return select(rough > P(1), larger(P(P(0.8) * root), P(0.2)),
                select(rough > P(0.1), P(P(0.9) * root), P(1e10)));
}

} // namespace wingspread
