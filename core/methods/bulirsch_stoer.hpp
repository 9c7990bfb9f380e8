/// Bulirsch and Stoer's explicit extrapolation, by odeint.
#pragma once

#include "core/methods/method.hpp"
#include "core/methods/state_algebra.hpp"

#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>

namespace wingspread {

/// Extrapolation of the modified midpoint rule; odeint chooses order (4 to 16) and step [Hairer, Nørsett &
/// Wanner I, II.9]. odeint does not tell the error, so verdicts say 0.5 (accepted) or 2. Factors 0.1 and 0.7
/// after a rejection are heuristic: larger means more trial steps, smaller shorter steps.
template <class T> class BulirschStoer {
public:
  static constexpr int order = 8;
  static constexpr bool fixed_step = false;

  void restart(const Tolerance& tolerance) { stepper_.emplace(tolerance.atol, tolerance.rtol); }

  template <class System>
  [[nodiscard]] StepVerdict attempt(System& system, const Start<T>& from, const T& h, State<T>& x1,
                                    State<T>& dxdt1) {
    T t = from.t, next = h;
    const bool good = stepper_->try_step(std::ref(system), from.x, from.dxdt, t, x1, next) ==
                      boost::numeric::odeint::success;
    evaluate_end(system, x1, dxdt1, T(from.t + h));
    if (!all_finite(x1) || !all_finite(dxdt1)) { // odeint would accept them
      stepper_->reset();
      return {std::numeric_limits<double>::quiet_NaN(), 0.1};
    }
    const double factor = static_cast<double>(T(next / h));
    return good ? StepVerdict{0.5, factor} : StepVerdict{2, std::min(factor, 0.7)};
  }

  void accepted(const StepVerdict& /*verdict*/, double /*h*/) {}
  void rejected() {}
  /// odeint's stepper, whose choice of order and step each trial step changes.
  [[nodiscard]] auto& control() { return stepper_; }

private:
  [[nodiscard]] static bool all_finite(const State<T>& x) {
    return is_finite(StateAlgebra::norm_inf(x));
  }
  std::optional<boost::numeric::odeint::bulirsch_stoer<State<T>, T, State<T>, T, StateAlgebra>>
      stepper_;
};

} // namespace wingspread
