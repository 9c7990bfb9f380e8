/// The interface of an integration method. A method is a class with these members:
///
///     order, fixed_step             constants: order of the first step's error; whether the step is given
///     restart(tolerance)            forgets all earlier steps; called first, and whenever the right-hand
///                                   side or the tolerance has changed
///     attempt(system, from, h, x1, dxdt1) → StepVerdict
///                                   makes a trial step from `from` (t, x, dxdt) to (x1, dxdt1) at t + h.
///                                   The system's last evaluation is at (x1, t + h). A method that knows
///                                   how long the step may be makes h shorter.
///     accepted(verdict, h)          the last trial step is accepted, possibly with another verdict
///     rejected()                    the last trial step is rejected
///     control()                     optional: what trial steps change that decides about order and size of later ones
///
/// An embedded formula offers only order, error_order and `estimate`, and `Adaptive` adds the rest. Events,
/// peaks and ends of runs are common to all methods (core/run).
#pragma once

#include "core/mechanics/layout.hpp"
#include "core/methods/step_control.hpp"

namespace wingspread {

/// Largest error of a step in every component x of the state: atol + rtol·|x|.
struct Tolerance {
  double rtol = 1e-8, atol = 1e-10;
};

/// scaled_error as a double, by the method's tolerance.
template <class T>
[[nodiscard]] double in_tolerances(const State<T>& x, const State<T>& x1, const State<T>& dxdt1,
                                   const State<T>& error, const Tolerance& tolerance) {
  return static_cast<double>(
      scaled_error(x, x1, dxdt1, error, T(tolerance.rtol), T(tolerance.atol)));
}

/// A method's judgement on a trial step.
struct StepVerdict {
  double error;  ///< in units of the tolerance: accepted if ≤ 1; NaN if anything is not finite
  double factor; ///< to the next step or, if rejected, the next trial step
  [[nodiscard]] bool accepted() const { return error <= 1; }
};

/// The start of a step.
template <class T> struct Start {
  const T& t;
  const State<T>&x, &dxdt;
};

/// Sets dxdt1 at the end x1 of a step. A system that keeps invariants first restores them in x1.
template <class T, class AnySystem>
void evaluate_end(AnySystem& system, State<T>& x1, State<T>& dxdt1, const T& t) {
  if constexpr (requires { system.end_step(x1, dxdt1, t); })
    system.end_step(x1, dxdt1, t);
  else
    system(x1, dxdt1, t);
}

/// A formula that shortens its steps to the tolerance before it makes them.
template <class Formula>
concept FitsSteps = requires {
  Formula::longest_growth;
};

/// Makes a trial step by a formula, and estimates its error. @param h shortened if FitsSteps<Formula>
template <class T, class Formula, class AnySystem>
void estimate(Formula& formula, AnySystem& system, const Start<T>& from, T& h, State<T>& x1,
              State<T>& dxdt1, State<T>& error, const T& rtol, const T& atol) {
  if constexpr (FitsSteps<Formula>)
    formula.estimate(system, from, h, x1, dxdt1, error, rtol, atol);
  else
    formula.estimate(system, from, h, x1, dxdt1, error);
}

/// Factor to the next (trial) step by a formula: step_factor. If FitsSteps<Formula>, the formula shortens the next step
/// anyway, and a rule suffices: longest_growth after an accepted step, half after a rejection, a tenth after NaN.
template <class Formula, class P>
[[nodiscard]] P factor_of(const P& error, const P& h, const StepMemory<P>& memory) {
  if constexpr (FitsSteps<Formula>)
    return select(error <= P(1), P(Formula::longest_growth),
                  select(error < P(1e100), P(0.5), P(0.1)));
  else
    return step_factor(Formula::error_order, error, h, memory);
}

/// An embedded formula with step control.
template <class T, class Formula> class Adaptive {
public:
  static constexpr int order = Formula::order;
  static constexpr bool fixed_step = false;

  void restart(const Tolerance& tolerance) {
    tolerance_ = tolerance;
    memory_ = {};
  }

  template <class System>
  [[nodiscard]] StepVerdict attempt(System& system, const Start<T>& from, T& h, State<T>& x1,
                                    State<T>& dxdt1) {
    const T rtol(tolerance_.rtol), atol(tolerance_.atol);
    error_.resize(from.x.size());
    estimate(formula_, system, from, h, x1, dxdt1, error_, rtol, atol);
    const T error = scaled_error_of(formula_, from.x, x1, dxdt1, error_, rtol, atol);
    return verdict(static_cast<double>(error), static_cast<double>(h));
  }

  /// The verdict on a trial step h with this scaled error.
  [[nodiscard]] StepVerdict verdict(double error, double h) const {
    return {error, factor_of<Formula>(error, h, memory_)};
  }
  [[nodiscard]] StepMemory<double>& memory() { return memory_; }
  [[nodiscard]] Formula& formula() { return formula_; }

  void accepted(const StepVerdict& verdict, double h) { memory_.accepted(verdict.error, h); }
  void rejected() { memory_.rejected(); }

private:
  Formula formula_;
  StepMemory<double> memory_;
  Tolerance tolerance_;
  State<T> error_;
};

} // namespace wingspread
