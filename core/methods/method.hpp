/// What every integration method offers. A method tries a step and judges it:
///
///     verdict = attempt(system, from, h, x1, dxdt1)
///
/// from `from` (t, x, dxdt) to (x1, dxdt1) at t + h; nothing is kept of it until `accepted()`. A formula that knows
/// before the step how long it may be makes h shorter.
/// `restart(tolerance)` comes first, and again whenever the right-hand side or the tolerance has
/// changed. Events, peaks and the reasons to stop are common to all methods (core/run).
///
/// An embedded formula needs only `estimate`, and `Adaptive` does the rest.
#pragma once

#include "core/mechanics/layout.hpp"
#include "core/methods/step_control.hpp"

namespace wingspread {

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

/// A formula that fits steps to the tolerance before it makes them.
template <class Formula>
concept FitsSteps = requires {
  Formula::longest_growth;
};

/// Makes a step by a formula, and its error. @param h made shorter by a formula that fits steps
template <class T, class Formula, class AnySystem>
void estimate(Formula& formula, AnySystem& system, const Start<T>& from, T& h, State<T>& x1,
              State<T>& dxdt1, State<T>& error, const T& rtol, const T& atol) {
  if constexpr (FitsSteps<Formula>)
    formula.estimate(system, from, h, x1, dxdt1, error, rtol, atol);
  else
    formula.estimate(system, from, h, x1, dxdt1, error);
}

/// `step_factor` of a formula.
template <class Formula, class P>
[[nodiscard]] P factor_of(const P& error, const P& h, const StepMemory<P>& memory) {
  if constexpr (FitsSteps<Formula>)
    return select(error <= P(1), P(Formula::longest_growth),
                  select(error < P(1e100), P(0.5), P(0.1)));
  else
    return step_factor(Formula::error_order, error, h, memory);
}

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
  [[nodiscard]] Verdict attempt(System& system, const Start<T>& from, T& h, State<T>& x1,
                                State<T>& dxdt1) {
    const T rtol(tolerance_.rtol), atol(tolerance_.atol);
    error_.resize(from.x.size());
    estimate(formula_, system, from, h, x1, dxdt1, error_, rtol, atol);
    const T error = scaled_error_of(formula_, from.x, x1, dxdt1, error_, rtol, atol);
    return verdict(static_cast<double>(error), static_cast<double>(h));
  }

  /// On a step over h of this scaled error.
  [[nodiscard]] Verdict verdict(double error, double h) const {
    return {error, factor_of<Formula>(error, h, memory_)};
  }
  [[nodiscard]] StepMemory<double>& memory() { return memory_; }
  [[nodiscard]] Formula& formula() { return formula_; }

  void accepted(const Verdict& verdict, double h) { memory_.accepted(verdict.error, h); }
  void rejected() { memory_.rejected(); }

private:
  Formula formula_;
  StepMemory<double> memory_;
  Tolerance tolerance_;
  State<T> error_;
};

} // namespace wingspread
