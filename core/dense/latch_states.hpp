/// The states of smoothed latches inside a step.
#pragma once

#include "core/dense/step.hpp"
#include "core/laws/smoothed_latch.hpp"

namespace wingspread {

/// S of hinge i's smoothed latch over a step, s: its Hermite quintic, for S̈ = ḟ is known at both ends. A cubic would be too
/// coarse for long steps: the latch's weight h(S/ε) is steep.
/// @pre hinge i has a smoothed latch
template <class T, class AnySystem>
[[nodiscard]] Quintic<T> latch_state(const AnySystem& system, const Step<T>& step, int i) {
  const Layout& at = system.layout();
  const auto jet = [&](const State<T>& x, const State<T>& dxdt) {
    return Jet<T>{x[at.latch(i)], dxdt[at.latch(i)],
                  engagement_acceleration(system.wing().hinges[i], x[at.angle(i)], x[at.rate(i)],
                                          system.epsilon())};
  };
  return hermite<T>(step.h, jet(step.x, step.dxdt), jet(step.x1, step.dxdt1));
}

/// The whole state at t + s·h. @param out as long as the step's states
template <class T, class AnySystem>
void interpolate(const AnySystem& system, const Step<T>& step, const T& s, State<T>& out) {
  const Layout& at = system.layout();
  step.interpolate(at, s, out);
  for (int i = 1; at.smoothed && i <= at.bodies; ++i)
    out[at.latch(i)] =
        system.wing().hinges[i].has_latch ? value(latch_state(system, step, i), s) : T(0);
}

} // namespace wingspread
