/// Explicit Runge-Kutta formulas, by odeint.
#pragma once

#include "core/methods/method.hpp"
#include "core/methods/state_algebra.hpp"

#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_cash_karp54.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include <functional>

namespace wingspread {

/// Formulas that estimate the error of a step, by odeint: `estimate` fills x1, dxdt1 and error.
/// `stable_real`, `stable_imaginary`: largest stable |hλ| on the half-axes (tests measure them).
template <class T> struct DormandPrince5 {
  static constexpr int order = 5, error_order = 4, evaluations = 6;
  static constexpr bool ends_with_stage = true; ///< its last stage is at the step's end
  static constexpr double stable_real = 3.307, stable_imaginary = 0.997;

  template <class System>
  void estimate(System& system, const Start<T>& from, const T& h, State<T>& x1, State<T>& dxdt1,
                State<T>& error) {
    stepper.do_step(std::ref(system), from.x, from.dxdt, from.t, x1, dxdt1, h, error);
    if constexpr (requires { system.work().keeps_momenta; }) // its last stage is at the end
      if (system.work().keeps_momenta) evaluate_end(system, x1, dxdt1, T(from.t + h));
  }

  boost::numeric::odeint::runge_kutta_dopri5<State<T>, T, State<T>, T, StateAlgebra> stepper;
};

/// Formulas whose last stage is not at the step's end. One more evaluation gives the derivative there, which
/// is also the next step's first stage.
template <class T, class Stepper> struct WithoutLastStage {
  template <class System>
  void estimate(System& system, const Start<T>& from, const T& h, State<T>& x1, State<T>& dxdt1,
                State<T>& error) {
    stepper.do_step(std::ref(system), from.x, from.dxdt, from.t, x1, h, error);
    evaluate_end(system, x1, dxdt1, T(from.t + h));
  }
  Stepper stepper;
};

template <class T>
struct CashKarp54
    : WithoutLastStage<T, boost::numeric::odeint::runge_kutta_cash_karp54<State<T>, T, State<T>, T,
                                                                          StateAlgebra>> {
  static constexpr int order = 5, error_order = 4;
  static constexpr double stable_real = 3.734, stable_imaginary = 0;
};

/// Its error estimate, (41/840)·h·(k1 + k11 − k12 − k13), uses stages at the step's ends only. It is blind
/// to pure quadratures, such as the state of a smoothed latch: see quadrature_error.
template <class T>
struct Fehlberg78
    : WithoutLastStage<T, boost::numeric::odeint::runge_kutta_fehlberg78<State<T>, T, State<T>, T,
                                                                         StateAlgebra>> {
  static constexpr int order = 8, error_order = 7;
  static constexpr double stable_real = 5.008, stable_imaginary = 2.365;
};

/// The classical Runge-Kutta formula with a fixed step. Makes two steps at once and compares them with one
/// of twice the size [Hairer, Nørsett & Wanner I, II.4]. A step that misses the tolerance fails the run, for
/// it cannot be made shorter.
template <class T> class RungeKutta4 {
public:
  static constexpr int order = 4;
  static constexpr double stable_real = 2.785, stable_imaginary = 2.828; ///< of each of the two
  static constexpr bool fixed_step = true;

  void restart(const Tolerance& tolerance) { tolerance_ = tolerance; }

  template <class System>
  [[nodiscard]] StepVerdict attempt(System& system, const Start<T>& from, const T& h, State<T>& x1,
                                    State<T>& dxdt1) {
    const T half = T(0.5) * h;
    middle_.resize(from.x.size());
    error_.resize(from.x.size());
    stepper_.do_step(std::ref(system), from.x, from.dxdt, from.t, middle_, half);
    system(middle_, dxdt1, from.t + half);
    stepper_.do_step(std::ref(system), middle_, dxdt1, T(from.t + half), x1, half);
    stepper_.do_step(std::ref(system), from.x, from.dxdt, from.t, error_, h);
    evaluate_end(system, x1, dxdt1, T(from.t + h));
    for (std::size_t k = 0; k < x1.size(); ++k) error_[k] = (x1[k] - error_[k]) / T(15);
    return {in_tolerances(from.x, x1, dxdt1, error_, tolerance_), 1};
  }

  void accepted(const StepVerdict& /*verdict*/, double /*h*/) {}
  void rejected() {}

private:
  boost::numeric::odeint::runge_kutta4<State<T>, T, State<T>, T, StateAlgebra> stepper_;
  Tolerance tolerance_;
  State<T> middle_, error_;
};

} // namespace wingspread
