/// Roughness: whether a step is too long for its interpolant.
#pragma once

#include "core/dense/step.hpp"
#include "core/number/power.hpp"

namespace wingspread {

/// The largest difference between quintic and cubic Hermite interpolant over a step, in hundredths of the move
/// h·max(abs(φ̇)); of the roughest coordinate. The difference is s²(1 − s)² times the line from d0/2 to d1/2,
///
///     d0 + d1 = h² (φ̈0 + φ̈1) + 2h (φ̇0 − φ̇1)                  its even part has 1/64 at s = ½        (1)
///     d1 − d0 = h² (φ̈1 − φ̈0) + 12 (φ1 − φ0) − 6h (φ̇0 + φ̇1)  its odd part at most 1/(100 √5)        (2)
///
/// (the largest u(1 − u²)²/64 over u = 2s − 1 lies at u = 1/√5). Both grow, against the move, as h³ and h⁴. The
/// code has (2)/12, so the factor 12/(100 √5).
///
/// The hundredth is a heuristic: roughness 1 is reached by a sine of 1.39 rad a step, whose quintic is off by 1.7e-4
/// of the move. A sine at its most favourable phase spans 2.6 rad at roughness 1, off by 2e-3. Too large a
/// share puts events and peaks inside steps off by more; too small a one shortens steps for nothing. It breaks for a
/// fine vibration on a fast coordinate: the move hides the difference, which only the tolerance bounds.
/// @return > 1 if the step is too long
template <class T> [[nodiscard]] T roughness(const Layout& at, const Step<T>& step, const T& atol) {
  using std::abs;
  const T& h = step.h;
  const State<T>&dxdt = step.dxdt, &dxdt1 = step.dxdt1;
  T worst(0);
  for (int k = 0; k < at.freedoms(); ++k) {
    const int a = at.freedoms() + k;
    const T even = fused(T(h / T(32)), dxdt[k] - dxdt1[k], h * h / T(64) * (dxdt[a] + dxdt1[a]));
    const T twelfth = fused(h * h * (T(1) / T(12)), dxdt1[a] - dxdt[a],
                            fused(T(-0.5) * h, dxdt[k] + dxdt1[k], step.x1[k] - step.x[k]));
    const T rounding = T(4 * 0x1p-52) * larger(T(abs(step.x[k])), T(abs(step.x1[k])));
    const T odd = T(0.12 / 2.2360679774997896) * (abs(twelfth) - rounding);
    const T move = fused(h, larger(T(abs(dxdt[k])), T(abs(dxdt1[k]))), T(T(1e3) * atol));
    worst = larger(worst, larger(T(abs(even)), odd) / (T(0.01) * move));
  }
  return worst;
}

/// Largest factor from a step to the next one, or to its next trial step, by the step's roughness.
template <class P> [[nodiscard]] P factor_by_roughness(const P& rough) {
  const P root = exp2_roughly(P(P(-1.0 / 3) * log2_roughly(larger(rough, P(0.1)))));
  return select(rough > P(1), larger(P(P(0.8) * root), P(0.2)),
                select(rough > P(0.1), P(P(0.9) * root), P(1e10)));
}

} // namespace wingspread
