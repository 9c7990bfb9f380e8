/// Integration methods behind one interface. A method tries a step and judges it:
///
///     verdict = attempt(system, from, h, x1, dxdt1)
///
/// from `from` (t, x, dxdt) to (x1, dxdt1) at t + h; nothing is kept of it until `accepted()`.
/// `restart(tolerance)` comes first, and again whenever the right-hand side or the tolerance has
/// changed. Events, peaks and the reasons to stop (integrator.hpp) are common to all.
///
/// The explicit ones are odeint's. What is their own is the verdict: odeint accepts a step whose
/// error is NaN.
#pragma once

#include "core/mechanics/system.hpp"
#include "core/methods/step_control.hpp"

#include <boost/numeric/odeint/stepper/adaptive_adams_bashforth_moulton.hpp>
#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_cash_karp54.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <tuple>
#include <utility>

namespace wingspread {

/// odeint's algebra for contiguous states: one plain loop whatever the number of operands.
struct StateAlgebra {
  template <class Operation, class First, class... Rest>
  static void apply(Operation operation, First& first, Rest&... rest) {
    const std::size_t size = first.size();
    for (std::size_t k = 0; k < size; ++k) operation(first[k], rest[k]...);
  }
  template <class A, class B, class Op> static void for_each2(A& a, B& b, Op op) {
    apply(op, a, b);
  }
  template <class A, class B, class C, class Op> static void for_each3(A& a, B& b, C& c, Op op) {
    apply(op, a, b, c);
  }
  template <class A, class B, class C, class D, class Op>
  static void for_each4(A& a, B& b, C& c, D& d, Op op) {
    apply(op, a, b, c, d);
  }
  template <class A, class B, class C, class D, class E, class Op>
  static void for_each5(A& a, B& b, C& c, D& d, E& e, Op op) {
    apply(op, a, b, c, d, e);
  }
  template <class A, class B, class C, class D, class E, class F, class Op>
  static void for_each6(A& a, B& b, C& c, D& d, E& e, F& f, Op op) {
    apply(op, a, b, c, d, e, f);
  }
  template <class A, class B, class C, class D, class E, class F, class G, class Op>
  static void for_each7(A& a, B& b, C& c, D& d, E& e, F& f, G& g, Op op) {
    apply(op, a, b, c, d, e, f, g);
  }
  // the long formulas: operation last, as odeint calls them
  template <class... Args> static void for_each8(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each9(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each10(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each11(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each12(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each13(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each14(Args&&... args) { operation_last(args...); }
  template <class... Args> static void for_each15(Args&&... args) { operation_last(args...); }

  /// Largest |x|; NaN when any is, unlike odeint's own.
  template <class S> [[nodiscard]] static typename S::value_type norm_inf(const S& x) {
    using std::abs;
    typename S::value_type largest(0), poison(0);
    for (const auto& v : x) largest = larger(largest, decltype(largest)(abs(v))), poison += v - v;
    return largest + poison;
  }

private:
  template <class... Args> static void operation_last(Args&... args) {
    const auto all = std::tie(args...);
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      apply(std::get<sizeof...(I)>(all), std::get<I>(all)...);
    }
    (std::make_index_sequence<sizeof...(Args) - 1>{});
  }
};

/// What a method may lose in a step, in every component of the state.
struct Tolerance {
  double rtol = 1e-8, atol = 1e-10;
};

/// `scaled_error` for a method's own use.
template <class T>
[[nodiscard]] double in_tolerances(const State<T>& x, const State<T>& x1, const State<T>& dxdt1,
                                   const State<T>& error, const Tolerance& tolerance) {
  return static_cast<double>(
      scaled_error(x, x1, dxdt1, error, T(tolerance.rtol), T(tolerance.atol)));
}

/// What a method thinks of its step.
struct Verdict {
  double error;  ///< in units of the tolerance: accepted if ≤ 1; NaN if anything is not finite
  double factor; ///< to the next step, or to the next try
  [[nodiscard]] bool accepted() const { return error <= 1; }
};

/// Where a step starts.
template <class T> struct Start {
  const T& t;
  const State<T>&x, &dxdt;
};

/// Formulas that estimate the error of a step, by odeint: `estimate` fills x1, dxdt1 and error.
/// `stable_real`, `stable_imaginary`: largest stable |hλ| on the half-axes (tests measure them).
template <class T> struct DormandPrince5 {
  static constexpr int order = 5, error_order = 4, evaluations = 6;
  static constexpr double stable_real = 3.307, stable_imaginary = 0.997;

  template <class System>
  void estimate(System& system, const Start<T>& from, const T& h, State<T>& x1, State<T>& dxdt1,
                State<T>& error) {
    stepper.do_step(std::ref(system), from.x, from.dxdt, from.t, x1, dxdt1, h, error);
  }

  boost::numeric::odeint::runge_kutta_dopri5<State<T>, T, State<T>, T, StateAlgebra> stepper;
};

/// Formulas whose last stage is not at the step's end: one evaluation more gives the derivative
/// there, which is also the next step's first.
template <class T, class Stepper> struct WithoutLastStage {
  template <class System>
  void estimate(System& system, const Start<T>& from, const T& h, State<T>& x1, State<T>& dxdt1,
                State<T>& error) {
    stepper.do_step(std::ref(system), from.x, from.dxdt, from.t, x1, h, error);
    system(x1, dxdt1, from.t + h);
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

/// Its estimate, (41/840)·h·(k1 + k11 − k12 − k13), has stages at the step's ends alone: it is
/// blind to pure quadratures, such as the state of a smoothed latch. For those components a Boole
/// rule on the dense output stands in.
template <class T>
struct Fehlberg78
    : WithoutLastStage<T, boost::numeric::odeint::runge_kutta_fehlberg78<State<T>, T, State<T>, T,
                                                                         StateAlgebra>> {
  static constexpr int order = 8, error_order = 7;
  static constexpr double stable_real = 5.008, stable_imaginary = 2.365;
};

/// A formula with step control.
template <class T, class Formula> class Adaptive {
public:
  static constexpr int order = Formula::order;
  static constexpr bool fixed_step = false;

  void restart(const Tolerance& tolerance) {
    tolerance_ = tolerance;
    memory_ = {};
  }

  template <class System>
  [[nodiscard]] Verdict attempt(System& system, const Start<T>& from, const T& h, State<T>& x1,
                                State<T>& dxdt1) {
    error_.resize(from.x.size());
    formula_.estimate(system, from, h, x1, dxdt1, error_);
    return verdict(static_cast<double>(scaled_error_of(formula_, from.x, x1, dxdt1, error_,
                                                       T(tolerance_.rtol), T(tolerance_.atol))),
                   static_cast<double>(h));
  }

  /// On a step over h of this scaled error.
  [[nodiscard]] Verdict verdict(double error, double h) const {
    return {error, step_factor(Formula::error_order, error, h, memory_)};
  }
  [[nodiscard]] StepMemory<double>& memory() { return memory_; }

  void accepted(const Verdict& verdict, double h) { memory_.accepted(verdict.error, h); }
  void rejected() { memory_.rejected(); }

private:
  Formula formula_;
  StepMemory<double> memory_;
  Tolerance tolerance_;
  State<T> error_;
};

/// The classical Runge-Kutta formula with a fixed step. Two steps are taken as one and compared
/// with one of twice the size [Hairer, Nørsett & Wanner I, II.4], so that a step that misses the
/// tolerance is known; it cannot be mended, and fails the run.
template <class T> class RungeKutta4 {
public:
  static constexpr int order = 4;
  static constexpr double stable_real = 2.785, stable_imaginary = 2.828; ///< of each of the two
  static constexpr bool fixed_step = true;

  void restart(const Tolerance& tolerance) { tolerance_ = tolerance; }

  template <class System>
  [[nodiscard]] Verdict attempt(System& system, const Start<T>& from, const T& h, State<T>& x1,
                                State<T>& dxdt1) {
    const T half = T(0.5) * h;
    middle_.resize(from.x.size());
    error_.resize(from.x.size());
    stepper_.do_step(std::ref(system), from.x, from.dxdt, from.t, middle_, half);
    system(middle_, dxdt1, from.t + half);
    stepper_.do_step(std::ref(system), middle_, dxdt1, T(from.t + half), x1, half);
    stepper_.do_step(std::ref(system), from.x, from.dxdt, from.t, error_, h);
    system(x1, dxdt1, from.t + h);
    for (std::size_t k = 0; k < x1.size(); ++k) error_[k] = (x1[k] - error_[k]) / T(15);
    return {in_tolerances(from.x, x1, dxdt1, error_, tolerance_), 1};
  }

  void accepted(const Verdict& /*verdict*/, double /*h*/) {}
  void rejected() {}

private:
  boost::numeric::odeint::runge_kutta4<State<T>, T, State<T>, T, StateAlgebra> stepper_;
  Tolerance tolerance_;
  State<T> middle_, error_;
};

/// Extrapolation of the modified midpoint rule, with its own choice of order (4 to 16) and step
/// [Hairer, Nørsett & Wanner I, II.9].
template <class T> class BulirschStoer {
public:
  static constexpr int order = 8;
  static constexpr bool fixed_step = false;

  void restart(const Tolerance& tolerance) { stepper_.emplace(tolerance.atol, tolerance.rtol); }

  template <class System>
  [[nodiscard]] Verdict attempt(System& system, const Start<T>& from, const T& h, State<T>& x1,
                                State<T>& dxdt1) {
    T t = from.t, next = h;
    const bool good = stepper_->try_step(std::ref(system), from.x, from.dxdt, t, x1, next) ==
                      boost::numeric::odeint::success;
    system(x1, dxdt1, from.t + h);
    if (!all_finite(x1) || !all_finite(dxdt1)) { // odeint would go on with them
      stepper_->reset();
      return {std::numeric_limits<double>::quiet_NaN(), 0.1};
    }
    const double factor = static_cast<double>(T(next / h));
    return good ? Verdict{0.5, factor} : Verdict{2, std::min(factor, 0.7)};
  }

  void accepted(const Verdict& /*verdict*/, double /*h*/) {}
  void rejected() {}

private:
  [[nodiscard]] static bool all_finite(const State<T>& x) {
    return is_finite(StateAlgebra::norm_inf(x));
  }
  std::optional<boost::numeric::odeint::bulirsch_stoer<State<T>, T, State<T>, T, StateAlgebra>>
      stepper_;
};

/// Adams-Bashforth-Moulton of variable order (1 to 8) and step, predict-evaluate-correct-evaluate,
/// on odeint's divided differences. Order and step follow Shampine and Gordon: one order up or down
/// when the estimate there promises less error.
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
  [[nodiscard]] Verdict attempt(System& system, const Start<T>& from, const T& h, State<T>& x1,
                                State<T>& dxdt1) {
    x1.resize(from.x.size()), error_.resize(from.x.size()); // kept sizes: no allocation
    h_ = h;
    stepper_.do_step_impl(std::ref(system), from.x, from.t, x1, h_, error_);
    system(x1, dxdt1, from.t + h);
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
  void accepted(const Verdict& /*verdict*/, double /*h*/) {
    auto& history = stepper_.coeff();
    history.do_step(dxdt_);
    history.confirm();
    after_rejection_ = false;
    choose_order();
  }
  void rejected() { after_rejection_ = true; }

private:
  [[nodiscard]] std::size_t current() { return stepper_.coeff().m_eo; }

  /// Error that order k would have had over the last step, in units of the tolerance.
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
