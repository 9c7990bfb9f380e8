/// The data that all parts of a run share: the wing, the goal, and the step under way.
#pragma once

#include "core/dense/latch_states.hpp"
#include "core/mechanics/system.hpp"
#include "core/outcome.hpp"

#include <vector>

namespace wingspread {

/// A run stands at the start of `step`; x1 and dxdt1 of `step` are the end of the step made last.
template <class T, class AnySystem> struct Underway {
  Underway(AnySystem& wing, const Integration& integration, const Goal& asked)
      : system(wing), at(wing.layout()), how(integration), goal(asked) {
    for (State<T>* state : {&step.x, &step.dxdt, &step.x1, &step.dxdt1, &x, &dxdt})
      state->assign(at.size(), T(0));
  }

  /// Evaluates at the fraction s of the step, by dense output. @return the state there
  const State<T>& evaluate_at(const T& s) {
    interpolate(system, step, s, x);
    system(x, dxdt, step.t + s * step.h);
    return x;
  }

  AnySystem& system;
  const Layout at;
  const Integration& how;
  const Goal& goal;
  Step<T> step;
  T next_release = T(never);  ///< when the next hold lets go, s; `never`: none, or not known
  std::vector<T> held_before; ///< 1 … n: moments on stuck hinges at the step's start, N·m
  State<T> x, dxdt;           ///< scratch: a state inside the step
  /// Evaluations of peak searches. `auto` leaves them out, so that asking for peaks does not change the motion.
  long searched = 0;
};

} // namespace wingspread
