/// Accepting steps and choosing their size.
#pragma once

#include "core/system.hpp"

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

/// Proportional-integral step control [Hairer, Nørsett & Wanner I, II.4; Gustafsson 1991]: the
/// integral part keeps steps smooth where stability limits them, as in the ringing after a latch.
class StepControl {
public:
  explicit StepControl(int error_order)
      : exponent_(1.0 / (error_order + 1) - 0.75 * integral_gain) {}

  /// After a try of scaled error `error`: the factor to the next step, or, where it is rejected
  /// (error > 1, or NaN), to the next try.
  [[nodiscard]] double factor(double error) const {
    if (!std::isfinite(error)) return 0.1;
    if (error > 1) return std::max(least, safety * std::pow(error, -exponent_));
    const double floored = std::max(error, 1e-10);
    const double wanted =
        safety * std::pow(floored, -exponent_) * std::pow(previous_error_, integral_gain);
    return std::clamp(wanted, least, after_rejection_ ? 1.0 : most);
  }

  void accepted(double error) {
    previous_error_ = std::max(error, 1e-4);
    after_rejection_ = false;
  }
  void rejected() { after_rejection_ = true; }

  /// Forgets the history: the right-hand side has changed.
  void restart() {
    previous_error_ = 1e-4;
    after_rejection_ = false;
  }

private:
  static constexpr double safety = 0.9, least = 0.2, most = 10, integral_gain = 0.04;
  double exponent_;
  double previous_error_ = 1e-4;
  bool after_rejection_ = false;
};

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
  const double next =
      bend > 1e-15 ? std::pow(0.01 / bend, 1.0 / (order + 1)) : std::max(1e-6, h * 1e-3);
  return smaller(T(std::min(100 * h, next)), longest);
}

} // namespace wingspread
