/// Accepting steps and choosing their size.
#pragma once

#include "core/mechanics/layout.hpp"
#include "core/number/power.hpp"

#include <algorithm>
#include <cmath>

namespace wingspread {

/// Largest error in units of its tolerance, atol + rtol·max(|x|, |x1|), over all components; NaN
/// when anything in the step is not finite, so that `<= 1` refuses it.
template <class T>
[[nodiscard]] T scaled_error(const State<T>& x, const State<T>& x1, const State<T>& dxdt1,
                             const State<T>& error, const T& rtol, const T& atol) {
  using std::abs;
  T largest(0), poison(0);
  for (std::size_t k = 0; k < x.size(); ++k) {
    const T tolerance = fused(rtol, larger(T(abs(x[k])), T(abs(x1[k]))), atol);
    largest = larger(largest, T(abs(error[k]) / tolerance));
    poison = poison + (x1[k] - x1[k]) + (dxdt1[k] - dxdt1[k]) + (error[k] - error[k]); // 0, or NaN
  }
  return largest + poison;
}

/// The same by the formula's own rule, if it has one.
template <class T, class Formula>
[[nodiscard]] T scaled_error_of(const Formula& formula, const State<T>& x, const State<T>& x1,
                                const State<T>& dxdt1, const State<T>& error, const T& rtol,
                                const T& atol) {
  if constexpr (requires { formula.scaled_error(x, x1, dxdt1, error, rtol, atol); })
    return formula.scaled_error(x, x1, dxdt1, error, rtol, atol);
  else
    return scaled_error(x, x1, dxdt1, error, rtol, atol);
}

/// What step control knows of the steps before.
template <class P> struct StepMemory {
  P log_error = P(-13.287712379549449); ///< log2 of the last accepted one's scaled error, ≥ 1e-4
  P most = P(10);                       ///< of the next factor: 1 after a rejection
  P h = P(0);                           ///< the last accepted step, s; 0 where none is foreseen

  void accepted(const P& error, const P& step) {
    log_error = larger(log2_roughly(larger(error, P(1e-10))), P(-13.287712379549449));
    most = P(10);
    h = select(h > P(0), step, h);
  }
  void rejected() { most = P(1); }
  /// From here on the next step is foreseen.
  void foresee() { h = P(1e-300); }
};

/// Proportional-integral step control [Hairer, Nørsett & Wanner I, II.4; Gustafsson 1991]: the
/// integral part keeps steps smooth where stability limits them, as in the ringing after a latch.
/// If asked for, steps that have grown shorter are foreseen to go on to [Gustafsson 1994; Hairer &
/// Wanner II, IV.8]: where a motion gains speed every third try would be rejected else. Not for
/// what rings: there errors go up and down, and steps would be 2 % shorter for nothing.
/// @param error scaled, of a try over h with an estimate of order `error_order`
/// @return the factor to the next step, or, where the try is rejected (error > 1, or NaN), to the
///         next try
template <class P>
[[nodiscard]] P step_factor(int error_order, const P& error, const P& h,
                            const StepMemory<P>& memory) {
  constexpr double safety = 0.9, least = 0.2, integral_gain = 0.04;
  const P exponent(0.75 * integral_gain - 1.0 / (error_order + 1));
  const auto finite = error < P(1e100), accepted = error <= P(1);
  const P known = select(finite, larger(error, P(1e-10)), P(1));
  const P history = select(accepted, P(P(integral_gain) * memory.log_error), P(0));
  const P log_error = log2_roughly(known);
  const P plain = P(safety) * exp2_roughly(fused(exponent, log_error, history));
  const P change = P(1.0 / (error_order + 1)) * (memory.log_error - log_error - log_error);
  const P foreseen = P(safety) * (h / larger(memory.h, P(1e-300))) * exp2_roughly(change);
  const P wanted = select(accepted && h < memory.h, smaller(plain, foreseen), plain);
  return select(finite, smaller(larger(wanted, P(least)), memory.most), P(0.1));
}

/// A first step whose error is about that of the tolerance, from the sizes of x, ẋ and ẍ
/// [Hairer, Nørsett & Wanner I, II.4]. One evaluation; `scratch` and `dscratch` are overwritten.
template <class T, class AnySystem>
[[nodiscard]] T first_step(AnySystem& system, const State<T>& x, const State<T>& dxdt, const T& t,
                           int order, double rtol, double atol, const T& longest, State<T>& scratch,
                           State<T>& dscratch) {
  using std::abs;
  const auto norm = [&](const State<T>& v, const State<T>* less) {
    double largest = 0;
    for (std::size_t k = 0; k < v.size(); ++k) {
      const T difference = less ? T(v[k] - (*less)[k]) : v[k];
      const double scale = atol + rtol * static_cast<double>(T(abs(x[k])));
      largest = std::max(largest, static_cast<double>(T(abs(difference))) / scale);
    }
    return largest;
  };
  const double size = norm(x, nullptr), slope = norm(dxdt, nullptr);
  double h = size < 1e-5 || slope < 1e-5 ? 1e-6 : 0.01 * size / slope;
  h = std::min(h, static_cast<double>(longest));
  for (std::size_t k = 0; k < x.size(); ++k) scratch[k] = fused(T(h), dxdt[k], x[k]);
  system(scratch, dscratch, t + T(h));
  const double bend = std::max(slope, norm(dscratch, &dxdt) / h);
  const bool known = bend > 1e-15 && bend < 1e100;
  const double next =
      known ? power_roughly(0.01 / bend, 1.0 / (order + 1)) : std::max(1e-6, h * 1e-3);
  return smaller(T(std::min(100 * h, next)), longest);
}

} // namespace wingspread
