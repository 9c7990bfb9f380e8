/// What the parts of a run share: the wing, what is asked of it, and the step under way.
#pragma once

#include "core/dense/step.hpp"
#include "core/mechanics/system.hpp"
#include "core/outcome.hpp"

namespace wingspread {

/// A run under way: it stands at the start of `step`, whose end is that of the step last made.
template <class T, class AnySystem> struct Underway {
  Underway(AnySystem& wing, const Integration& integration, const Goal& asked)
      : system(wing), at(wing.layout()), how(integration), goal(asked) {
    for (State<T>* state : {&step.x, &step.dxdt, &step.x1, &step.dxdt1, &x, &dxdt})
      state->assign(at.size(), T(0));
  }

  /// Evaluates inside the step, on its dense output. @return the state there
  const State<T>& evaluate_at(const T& s) {
    step.interpolate(at, s, x);
    system(x, dxdt, step.t + s * step.h);
    return x;
  }

  AnySystem& system;
  const Layout at;
  const Integration& how;
  const Goal& goal;
  Step<T> step;
  State<T> x, dxdt; ///< somewhere inside the step: scratch
};

} // namespace wingspread
