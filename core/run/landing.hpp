/// Steps that end at an event.
#pragma once

#include "core/events/events.hpp"
#include "core/run/underway.hpp"

#include <optional>
#include <vector>

namespace wingspread {

/// Replaces a step with an event inside by one that ends there, so that its state has the method's
/// accuracy and not the interpolant's; the instant is corrected by Newton's method with real steps.
/// A hinge that only grazes its latched angle has no useful Newton step: there the interpolant's
/// instant stands.
template <class T, class AnySystem> class Landing {
public:
  Landing(Underway<T, AnySystem>& run, Events<T, AnySystem>& events) : run_(run), events_(events) {}

  /// A whole step was accepted.
  /// @return whether it holds an event; then the step under way is cut to end there
  [[nodiscard]] bool finds_event() {
    due_ = events_.first(run_.step, run_.x, run_.dxdt);
    if (!due_) return false;
    corrections_ = 0;
    longest_ = run_.step.h;
    cut(due_->s * longest_);
    return true;
  }

  /// The step so cut was accepted.
  /// @return whether it must be cut anew; if not, its end is the event
  [[nodiscard]] bool misses_event() {
    if (due_->event == Event::graze) return finds_release();
    Step<T>& step = run_.step;
    const auto at = events_.indicator(*due_, step);
    const T late = at.value / at.slope, size = larger(late, T(-late));
    if (!(at.slope > T(0) && is_near(at, size) && corrections_ < 4)) return false;
    if (size > T(1e-7) * step.h) {
      ++corrections_;
      cut(step.h - late);
      return true;
    }
    shift_end(-late); // the rest is linear: its square is below round-off
    step.h = smaller(T(step.h - late), longest_);
    if (run_.goal.peak_moment || run_.goal.peak_force)
      run_.system(step.x1, step.dxdt1, step.t + step.h); // forces and accelerations follow
    return false;
  }

  /// Whether the step under way ends at an event.
  [[nodiscard]] bool at_event() const { return due_.has_value(); }

  /// At a step's end: what the event that was due, and others at the same instant, bring about.
  /// @param latches those that engage are added
  /// @return whether anything happened; then the right-hand side is another
  [[nodiscard]] bool happens(std::vector<LatchEvent>& latches) {
    return events_.happen(due_, run_.step, latches);
  }

  /// The hinge that was due to be let go; 0: none.
  [[nodiscard]] int let_go() const {
    return due_ && due_->event == Event::release ? due_->hinge : 0;
  }

private:
  /// The step ends where what holds a hinge is largest: did it pass its limit on the way there?
  [[nodiscard]] bool finds_release() {
    if (++corrections_ > 3) return false;
    const std::optional<Due<T>> seen = events_.first(run_.step, run_.x, run_.dxdt);
    if (!seen) return false;
    due_ = seen;
    longest_ = run_.step.h;
    cut(due_->s * longest_);
    return true;
  }

  /// Whether Newton's way to the event can be trusted: it is short, or the slope stays what it is on
  /// it. In a stiff motion accelerations are known so poorly that the interpolant's instant may be
  /// off by much of a long step.
  [[nodiscard]] bool is_near(const typename Events<T, AnySystem>::Indicator& at,
                             const T& size) const {
    using std::abs;
    if (size < T(1e-2) * run_.step.h) return true;
    return size < T(0.5) * run_.step.h && size * abs(at.bend) < T(0.1) * at.slope &&
           at.bend != T(0);
  }

  void cut(const T& h) {
    const T shortest = T(8 * epsilon_of<T>) * larger(run_.step.t, longest_);
    run_.step.h = smaller(larger(h, shortest), longest_);
  }

  /// Moves the step's end by dt, to first order in x.
  void shift_end(const T& dt) {
    Step<T>& step = run_.step;
    for (std::size_t k = 0; k < step.x1.size(); ++k)
      step.x1[k] = fused(dt, step.dxdt1[k], step.x1[k]);
  }

  Underway<T, AnySystem>& run_;
  Events<T, AnySystem>& events_;
  std::optional<Due<T>> due_; ///< the event that ends the step
  int corrections_ = 0;       ///< of its instant
  T longest_ = T(0);          ///< the step in which it was found
};

} // namespace wingspread
