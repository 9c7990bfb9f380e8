/// Counts consecutive steps whose size is limited by stability and not by accuracy.
#pragma once

#include "core/number/scalar.hpp"

namespace wingspread {

/// The end of a step.
template <class P> struct StepMark {
  P time;        ///< s
  P evaluations; ///< of the run
  P steps;       ///< of the phase
};

/// The rule by which `auto` considers another method: after enough held-back steps in a row. P is
/// double in a run, and a pack in an engine, whose lanes must know when to ask their runs.
template <class P> struct HeldBackSteps {
  /// Held-back steps in a row. Heuristic: fewer, and single long steps cause vain trials of the implicit
  /// method; more, and stiff latches are noticed later.
  static constexpr double enough = 10;

  P shortest;            ///< a longer step is held back, s
  P wait_until;          ///< no other method is considered before so many steps of the phase
  StepMark<P> last_free; ///< of the last step that was not held back, or the phase's start

  [[nodiscard]] auto holds_back(const P& h) const { return h > shortest; }

  /// Whether another method is to be considered after a step of h, the phase's `steps`-th.
  [[nodiscard]] auto may_leave(const P& h, const P& steps) const {
    return holds_back(h) && steps >= last_free.steps + P(enough) && steps >= wait_until;
  }

  /// Counts an accepted step of h. @param these the lanes that accepted it
  template <class Mask> void accepted(const Mask& these, const P& h, const StepMark<P>& now) {
    const auto free = these && !holds_back(h);
    last_free.time = select(free, now.time, last_free.time);
    last_free.evaluations = select(free, now.evaluations, last_free.evaluations);
    last_free.steps = select(free, now.steps, last_free.steps);
  }
};

} // namespace wingspread
