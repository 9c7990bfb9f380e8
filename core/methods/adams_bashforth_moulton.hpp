/// Adams-Bashforth-Moulton, an explicit multistep method by odeint.
#pragma once

#include "core/methods/method.hpp"
#include "core/methods/state_algebra.hpp"

#include <boost/numeric/odeint/stepper/adaptive_adams_bashforth_moulton.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

namespace wingspread {

/// Adams-Bashforth-Moulton of variable order (1 to 8) and step, predict-evaluate-correct-evaluate,
/// on odeint's divided differences. As in Shampine and Gordon's code (1975) the order changes by one where the
/// estimate there promises less error, and the step grows only if it may grow much, since every change of the
/// step changes the formula's coefficients: not below a factor of 1.2, and by 2 at most.
template <class T> class AdamsBashforthMoulton {
public:
  static constexpr int order = 1; ///< of the first step after a restart
  static constexpr bool fixed_step = false;
  static constexpr int highest = 8;

  void restart(const Tolerance& tolerance) {
    tolerance_ = tolerance;
    stepper_.reset();
    after_rejection_ = false;
  }

  template <class System>
  [[nodiscard]] StepVerdict attempt(System& system, const Start<T>& from, const T& h, State<T>& x1,
                                    State<T>& dxdt1) {
    x1.resize(from.x.size()), error_.resize(from.x.size()); // kept sizes: no allocation
    h_ = h;
    stepper_.do_step_impl(std::ref(system), from.x, from.t, x1, h_, error_);
    evaluate_end(system, x1, dxdt1, T(from.t + h));
    x_ = x1, dxdt_ = dxdt1;
    const double error = in_tolerances(from.x, x1, dxdt1, error_, tolerance_);
    if (!std::isfinite(error)) return {error, 0.1};
    const double wanted =
        0.9 * power_roughly(std::max(error, 1e-10), -1.0 / (static_cast<double>(current()) + 1));
    if (error > 1) return {error, std::clamp(wanted, 0.2, 0.9)};
    if (after_rejection_) return {error, std::min(wanted, 1.0)};
    return {error, wanted > 1.2 ? std::min(wanted, 2.0) : std::min(wanted, 1.0)};
  }

  /// @pre the last attempt was the step accepted
  void accepted(const StepVerdict& /*verdict*/, double /*h*/) {
    auto& history = stepper_.coeff();
    history.do_step(dxdt_);
    history.confirm();
    after_rejection_ = false;
    choose_order();
  }
  void rejected() { after_rejection_ = true; }

private:
  [[nodiscard]] std::size_t current() { return stepper_.coeff().m_eo; }

  /// Error that order k would have made in the last step, in units of the tolerance.
  [[nodiscard]] double estimate(std::size_t k) {
    auto& history = stepper_.coeff();
    const T weight = h_ * history.gs[k];
    for (std::size_t c = 0; c < error_.size(); ++c) error_[c] = weight * history.phi[1][k].m_v[c];
    return in_tolerances(x_, x_, dxdt_, error_, tolerance_);
  }

  void choose_order() {
    auto& history = stepper_.coeff();
    const std::size_t k = history.m_eo;
    if (history.m_steps_init - 1 < k || k < 3) { // still climbing after a restart
      history.m_eo = std::min<std::size_t>(k + 1, highest);
      return;
    }
    const double here = estimate(k), below = estimate(k - 1), far_below = estimate(k - 2);
    if (std::max(below, far_below) <= here)
      history.m_eo = k - 1;
    else if (k < highest && k < history.m_steps_init - 1 && estimate(k + 1) < 0.5 * here)
      history.m_eo = k + 1;
  }

  boost::numeric::odeint::adaptive_adams_bashforth_moulton<highest, State<T>, T, State<T>, T,
                                                           StateAlgebra>
      stepper_;
  Tolerance tolerance_;
  State<T> error_, x_, dxdt_;
  T h_ = T(0);
  bool after_rejection_ = false;
};

} // namespace wingspread
