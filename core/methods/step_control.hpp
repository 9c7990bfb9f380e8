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

/// scaled_error by the formula's own rule, if it has one.
template <class T, class Formula>
[[nodiscard]] T scaled_error_of(const Formula& formula, const State<T>& x, const State<T>& x1,
                                const State<T>& dxdt1, const State<T>& error, const T& rtol,
                                const T& atol) {
  if constexpr (requires { formula.scaled_error(x, x1, dxdt1, error, rtol, atol); })
    return formula.scaled_error(x, x1, dxdt1, error, rtol, atol);
  else
    return scaled_error(x, x1, dxdt1, error, rtol, atol);
}

/// The memory of step control: numbers of earlier steps.
template <class P> struct StepMemory {
  /// log2 of 1e-4: smaller errors count as 1e-4 [PI control in DOPRI5's code, facold ≥ 1e-4]. Without
  /// a floor one step of no error, as in a motion that is a parabola, would cut the next.
  static constexpr double least_log_error = -13.287712379549449;
  /// Largest factor from a step to the next [Hairer, Nørsett & Wanner I, II.4: facmax from 1.5 to 5, in
  /// their codes up to 10]. Larger: steps leap from quiet motion over a change.
  static constexpr double longest_growth = 10;

  P log_error = P(least_log_error); ///< log2 of the last accepted step's scaled error
  P most = P(longest_growth);       ///< of the next factor; 1 after a rejection for its error
  P h = P(0);                       ///< the last accepted step, s; 0 without `foresee`

  void accepted(const P& error, const P& step) {
    log_error = larger(log2_roughly(larger(error, P(1e-10))), P(least_log_error));
    most = P(longest_growth);
    h = select(h > P(0), step, h);
  }
  void rejected() { most = P(1); }
  /// Notes that a step is rejected because of a kink at this fraction of it, and is made again up to the kink. The step
  /// after that may be as long as the rejected one.
  void cut(const P& fraction) { most = smaller(P(longest_growth), P(P(1) / fraction)); }
  /// Makes step_factor extrapolate the next step from now on.
  void foresee() { h = P(1e-300); }
};

/// Proportional-integral step control [Hairer, Nørsett & Wanner I, II.4; Gustafsson 1991]: the
/// integral part keeps steps smooth where stability limits them, as in the ringing after a latch.
/// With StepMemory::foresee, steps that have become shorter are expected to become shorter still
/// [Gustafsson 1994; Hairer & Wanner II, IV.8]: otherwise every third trial step is rejected while
/// a motion gains speed. Not for ringing, where errors rise and fall and steps become 2 % shorter in vain.
///
/// Safety 0.9 and the least factor 0.2 are those of DOPRI5 and DOP853 [Hairer, Nørsett & Wanner I,
/// II.4]; the integral gain β = 0.04 is DOPRI5's. Heuristic: less safety means more rejections, more
/// means shorter steps. Factor 0.1: the step's numbers are not finite, so its error says nothing.
/// @param error scaled, of a trial step h with an estimate of order `error_order`
/// @return factor to the next step, or to the next trial step if this one is rejected (error > 1 or NaN)
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

/// A first step whose error is about the tolerance, from the sizes of x, ẋ and ẍ, with the constants
/// of the source [Hairer, Nørsett & Wanner I, II.4]. Wrong by 100 times it costs some rejected or
/// short steps. Costs one evaluation; overwrites `scratch` and `dscratch`.
/// @param longest upper limit, s
/// @return s
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
