/// Whether the interpolant over a step shows what happens inside.
#pragma once

#include "core/mechanics/layout.hpp"
#include "core/number/power.hpp"

namespace wingspread {

/// The error of the quintic over a step against its tolerance, in hundredths of what the
/// coordinates move: near 1 a step spans a quarter of a period. Estimated by the difference to the
/// cubic at the middle, h/32 (φ̇0 − φ̇1) + h²/64 (φ̈0 + φ̈1), which grows with h³.
/// @return > 1 if the step is too long
template <class T>
[[nodiscard]] T roughness(const Layout& at, const T& h, const State<T>& dxdt, const State<T>& dxdt1,
                          const T& atol) {
  using std::abs;
  T worst(0);
  for (int k = 0; k < at.freedoms(); ++k) {
    const int a = at.freedoms() + k;
    const T gap = fused(T(h / T(32)), dxdt[k] - dxdt1[k], h * h / T(64) * (dxdt[a] + dxdt1[a]));
    const T move = fused(h, larger(T(abs(dxdt[k])), T(abs(dxdt1[k]))), T(T(1e3) * atol));
    worst = larger(worst, T(abs(gap)) / (T(0.01) * move));
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
