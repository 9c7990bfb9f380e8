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
  int order;                   ///< as in methods(); for Adams' the order of the prediction
  double evaluations;          ///< a step
  std::function<Step()> start; ///< starts a new sequence of steps, without earlier values
  /// The factor by which one step of h multiplies a mode with eigenvalue λ, z = hλ.
  std::function<double(std::complex<double> z)> growth;
};

/// Methods of methods() with constant steps, without `auto`; a method that chooses its order is here once for each of
/// several orders. The formulas are those of core/ and of odeint. For a one-step method `growth` is |R(z)|, measured by a
/// step of a panel with one latch. For Adams' it is the largest root of the formula's characteristic polynomial.
[[nodiscard]] std::vector<FixedStepMethod> fixed_step_methods();

} // namespace wingspread::study
