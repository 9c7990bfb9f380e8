/// Roughness: whether a step is too long for its interpolant.
#pragma once

#include "core/dense/step.hpp"
#include "core/laws/motor.hpp"
#include "core/number/power.hpp"

namespace wingspread {

/// The largest difference between quintic and cubic Hermite interpolant over a step, in hundredths of the move
/// h·max(abs(φ̇)); of the roughest coordinate. The difference is s²(1 − s)² times the line from d0/2 to d1/2,
///
///     d0 + d1 = h² (φ̈0 + φ̈1) + 2h (φ̇0 − φ̇1)                  its even part has 1/64 at s = ½        (1)
///     d1 − d0 = h² (φ̈1 − φ̈0) + 12 (φ1 − φ0) − 6h (φ̇0 + φ̇1)  its odd part at most 1/(100 √5)        (2)
///
/// (the largest u(1 − u²)²/64 over u = 2s − 1 lies at u = 1/√5). Relative to the move they grow as h³ and h⁴. The
/// code has (2)/12, so the factor 12/(100 √5). The code adds 1000 atol to the move (heuristic), so
/// that coordinates next to rest do not count.
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

/// The same for the moments of motors on open hinges, c (w − φ̇), and so for their work. With a large gain c the moment
/// depends on digits of the rate below the rate's tolerance, but an implicit method still takes long steps. By (1) and
/// (2) the rates of both interpolants differ by at most
///
///     (0.19245 max(|d0|, |d1|)/2 + |d1 − d0|/32)/h        0.19245 = 1/(3 √3) is the largest slope of s²(1 − s)²   (3)
///
/// Roughness 1: c times (3) is 2 % of the moment at the larger end, or of a thousandth of the torque limit. Heuristic: the
/// quintic is then off by far less (tests hold the work to 1e-4 at a gain of 1e5); a smaller share takes more steps.
template <class T, class AnySystem>
[[nodiscard]] T roughness_of_motors(const AnySystem& system, const Step<T>& step) {
  using std::abs;
  const T& h = step.h;
  T worst(0);
  for (int i = 1; i < static_cast<int>(system.wing().motors.size()); ++i) {
    if (!system.motor_runs(i) || system.work().engaged[i]) continue;
    const MotorTerms<T>& terms = system.wing().motors[i];
    const MotorPiece<T>& piece = system.work().motors[i];
    const int x = system.layout().angle(i), v = system.layout().rate(i);
    const auto moment = [&](const State<T>& at, const T& t) {
      return motor_moment(terms, piece, command_excess(piece, t, T(at[v])));
    };
    const T first = moment(step.x, step.t), last = moment(step.x1, T(step.t + h));
    if (first == last && abs(last) == terms.limit) continue;
    const T sum = fused(h * h, step.dxdt[v] + step.dxdt1[v], T(2) * h * (step.x[v] - step.x1[v]));
    const T change =
        fused(h * h, step.dxdt1[v] - step.dxdt[v],
              fused(T(-6) * h, step.x[v] + step.x1[v], T(12) * (step.x1[x] - step.x[x])));
    const T rounding = T(48 * 0x1p-52) * larger(T(abs(step.x[x])), T(abs(step.x1[x])));
    const T odd = larger(T(abs(change) - rounding), T(0));
    const T line = T(0.25) * (abs(sum) + odd);
    const T off = fused(T(0.19245), line, odd / T(32)) / h;
    const T size = larger(larger(T(abs(first)), T(abs(last))), T(T(1e-3) * terms.limit));
    worst = larger(worst, T(terms.gain * off / (T(0.02) * size)));
  }
  return worst;
}

/// Largest factor from a step to the next one, or to its next trial step, by the step's roughness. Roughness grows at
/// least as h³, hence the inverse cube root. Heuristic: 0.8 after a refusal and 0.9 after an accepted step keep a
/// distance to roughness 1; below 0.1 nothing is limited. Larger: more refused steps. Smaller: more steps.
template <class P> [[nodiscard]] P factor_by_roughness(const P& rough) {
  const P root = exp2_roughly(P(P(-1.0 / 3) * log2_roughly(larger(rough, P(0.1)))));
  return select(rough > P(1), larger(P(P(0.8) * root), P(0.2)),
                select(rough > P(0.1), P(P(0.9) * root), P(1e10)));
}

} // namespace wingspread
