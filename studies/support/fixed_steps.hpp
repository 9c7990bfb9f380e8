/// The methods with a constant step, without step control and events: for measurements of stability.
#pragma once

#include "studies/support/linear_wing.hpp"

#include <complex>
#include <functional>
#include <string>
#include <vector>

namespace wingspread::study {

/// Advances x by one step of h.
using Step = std::function<void(LinearWing::AnySystem& system, State<double>& x, double h)>;

/// One formula with a constant step.
struct FixedStepMethod {
  std::string name;            ///< from methods()
  int order;                   ///< as methods() counts it: of Adams' the prediction's
  double evaluations;          ///< a step
  std::function<Step()> start; ///< a new sequence of steps; forgets what a multistep method keeps
  /// Growth in one step of a mode λ, z = hλ.
  std::function<double(std::complex<double> z)> growth;
};

/// Every method of methods() but `auto`; those that choose their order at several. Formulas are the
/// product's own, so is odeint's where the product has it. For a one-step method `growth` is |R(z)|
/// by a real step of a panel with one latch; for Adams' it is the largest root of the formula's
/// characteristic polynomial.
[[nodiscard]] std::vector<FixedStepMethod> fixed_step_methods();

} // namespace wingspread::study
