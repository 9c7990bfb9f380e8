/// A step of any method, and the state inside it.
#pragma once

#include "core/mechanics/layout.hpp"
#include "core/number/quintic.hpp"

namespace wingspread {

/// An accepted step and its dense output.
template <class T> struct Step {
  T t, h;
  State<T> x, dxdt;   ///< at t
  State<T> x1, dxdt1; ///< at t + h

  /// Coordinate k of q over the step. @param freedoms index of q̇ less that of q in the state
  [[nodiscard, gnu::always_inline]] Quintic<T> coordinate(int k, int freedoms) const {
    const int r = k + freedoms;
    return hermite<T>(h, {x[k], x[r], dxdt[r]}, {x1[k], x1[r], dxdt1[r]});
  }

  /// The way of coordinate k since the step's start. `coordinate` is a sum with the angle, which rounds it to ε φ. In a
  /// short step the difference of the angles at its ends is such rounding, too: there the way's end follows from the
  /// rates and accelerations at the ends.
  [[nodiscard]] Quintic<T> way(int k, int freedoms) const {
    const int r = k + freedoms;
    const T by_angles = x1[k] - x[k];
    const T by_rates =
        fused(T(0.5) * h, x[r] + x1[r], h * h * (T(1) / T(12)) * (dxdt[r] - dxdt1[r]));
    const T end = select(is_rounding(T(by_angles - by_rates), k), by_rates, by_angles);
    return hermite<T>(h, {T(0), x[r], dxdt[r]}, {end, x1[r], dxdt1[r]});
  }

  /// The distance of coordinate k from `there` over the step. Near `there` it is far more accurate than `coordinate`.
  [[nodiscard]] Quintic<T> distance(int k, int freedoms, const T& there) const {
    Quintic<T> d = way(k, freedoms);
    const T start = x[k] - there;
    for (T& c : d) c = start + c;
    return d;
  }

  /// The rate of coordinate k over the step.
  [[nodiscard]] Quintic<T> rate(int k, int freedoms) const {
    return derivative(way(k, freedoms), h);
  }

  /// Angles and rates at t + s·h: `coordinate` and `rate`. The states of smoothed latches: latch_states.hpp.
  void interpolate(const Layout& at, const T& s, State<T>& out) const {
    const int n = at.freedoms();
    for (int k = 0; k < n; ++k) {
      const T v = h * x[k + n], a = h * h * dxdt[k + n]; // the same quintic about the start
      const T V = fused(h, x1[k + n] - x[k + n], -a), A = fused(h * h, dxdt1[k + n], -a);
      const T way = (x1[k] - x[k]) - fused(T(0.5), a, v),
              by_rates = fused(T(0.5), V, A * (T(-1) / T(12)));
      const T D = select(is_rounding(T(way - by_rates), k), by_rates, way);
      const T c3 = fused(T(10), D, fused(T(-4), V, T(0.5) * A));
      const T c4 = fused(T(-15), D, fused(T(7), V, -A));
      const T c5 = fused(T(6), D, fused(T(-3), V, T(0.5) * A));
      const T tail = fused(s, fused(s, c5, c4), c3);
      const T slope = fused(s, fused(s, T(5) * c5, T(4) * c4), T(3) * c3);
      out[k] = fused(s, fused(s, fused(s, tail, T(0.5) * a), v), x[k]);
      out[k + n] = fused(s / h, fused(s, slope, a), x[k + n]);
    }
  }

private:
  /// Whether a difference in coordinate k may come from the rounding of its values at the ends. Extrapolation raises
  /// that rounding to 32 ε (tests of the methods' orders).
  [[nodiscard]] Truth<T> is_rounding(const T& difference, int k) const {
    using std::abs;
    return !(abs(difference) > T(32 * epsilon_of<T>) * (abs(x[k]) + abs(x1[k])));
  }
};

} // namespace wingspread
