/// Since when steps are held back by stability, and no longer by accuracy.
#pragma once

#include "core/number/scalar.hpp"

namespace wingspread {

/// The end of a step.
template <class P> struct StepMark {
  P time;        ///< s
  P evaluations; ///< of the run
  P steps;       ///< of the phase
};

/// The rule by which `auto` thinks of another method: once enough steps in a row were held back by
/// stability. In double for a run alone; in packs for the lanes of an engine, which must know from
/// which step on the run has to be asked.
template <class P> struct HeldBackSteps {
  static constexpr double enough = 10; ///< in a row

  P shortest;            ///< a step that is longer is held back, s
  P wait_until;          ///< steps of the phase before which no other method is thought of
  StepMark<P> last_free; ///< of the last step that was not held back, or the phase's start

  [[nodiscard]] auto holds_back(const P& h) const { return h > shortest; }

  /// Whether another method is to be thought of after a step of h, the phase's `steps`-th.
  [[nodiscard]] auto may_leave(const P& h, const P& steps) const {
    return holds_back(h) && steps >= last_free.steps + P(enough) && steps >= wait_until;
  }

  /// A step of h was accepted. @param these in which lanes
  template <class Mask> void accepted(const Mask& these, const P& h, const StepMark<P>& now) {
    const auto free = these && !holds_back(h);
    last_free.time = select(free, now.time, last_free.time);
    last_free.evaluations = select(free, now.evaluations, last_free.evaluations);
    last_free.steps = select(free, now.steps, last_free.steps);
  }
};

} // namespace wingspread
