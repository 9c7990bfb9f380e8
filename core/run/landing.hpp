/// Steps that end at an event.
#pragma once

#include "core/events/events.hpp"
#include "core/run/underway.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace wingspread {

/// Replaces a step that holds an event by a step of the method that ends there: the state at the event
/// then has the method's accuracy, not the interpolant's. Newton's method, with real steps, corrects
/// the instant. Where a hinge only grazes its latched angle, Newton's method fails: the
/// interpolant's instant is kept.
template <class T, class AnySystem> class Landing {
public:
  Landing(Underway<T, AnySystem>& run, Events<T, AnySystem>& events) : run_(run), events_(events) {}

  /// Cuts a step just accepted at the first event inside.
  /// @param rtol relative tolerance of the step, 0 where the method does not resolve accelerations
  /// @return whether there is one: the step must then be made again, to the event
  [[nodiscard]] bool cut_at_event(const EventSearch& search, double rtol) {
    nearest_ = nearest(rtol);
    missed_ = false, searches_ = 0, rest_ = T(0);
    due_ = events_.first(run_.step, run_.x, run_.dxdt, search);
    if (due_) begin();
    return due_.has_value();
  }

  /// Cuts a refused step at a jump of a loop's moment, which may be why the step is refused.
  /// @return whether there is a jump: the step must then be made again, to the jump
  [[nodiscard]] bool cut_refused_step(const std::optional<KinkLimit>& kinks, double rtol) {
    nearest_ = nearest(rtol);
    if (!kinks || !kinks->leaps_only || missed_) return false;
    due_ = events_.first_jump(run_.step, *kinks);
    if (!due_) return false;
    searches_ = 0;
    begin();
    return true;
  }

  /// As cut_at_event where a lane has found that there is none.
  void expect_no_event() { due_.reset(), missed_ = false, rest_ = T(0); }

  /// Corrects the end of a cut step that was accepted: Newton's step to the event.
  /// @return whether the step is cut anew, and must be made again; if not, its end is the event
  [[nodiscard]] bool correct_end() {
    if (due_->event == Event::graze) return cut_at_release();
    Step<T>& step = run_.step;
    const auto at = events_.indicator(*due_, step);
    const T late = at.value / at.slope, size = larger(late, T(-late));
    missed_ = !(at.slope > T(0) && is_near(at, size) && corrections_ < 4);
    if (missed_) return false;
    const bool bent = !keeps_slope(at, size);
    if (size > (bent ? T(round_off) : nearest_) * step.h) {
      ++corrections_;
      cut(step.h - late);
      return true;
    }
    rest_ = bent ? T(-late) : T(-late * fused(T(0.5) * late, at.bend / at.slope, T(1)));
    return false;
  }

  /// Moves the end of the accepted step to the event, over the time by which the landing missed it.
  /// @return whether the end moved; the last evaluation is then at the new end, if loads need it
  bool carry_end_to_event() {
    const T way = std::exchange(rest_, T(0));
    if (way == T(0)) return false;
    Step<T>& step = run_.step;
    shift_end(way);
    step.h = smaller(T(step.h + way), longest_);
    // forces and accelerations at the new end
    if (run_.goal.peak_moment || run_.goal.peak_force || due_->event == Event::kink ||
        run_.system.work().locked > 0)
      run_.system(step.x1, step.dxdt1, step.t + step.h);
    return true;
  }

  /// Searches a step that ends at a kink for events before the kink. The kink was found in a longer step, whose dense
  /// output need not show them, because that step was refused or leapt over them: a detent may release a stuck hinge.
  /// @return whether there is one: the step must then be made again, to the event
  [[nodiscard]] bool cut_at_earlier_event(const std::optional<KinkLimit>& kinks) {
    constexpr int most_searches = 8; // heuristic: a kink that the landing misses is found anew
    if (due_->event != Event::kink || ++searches_ > most_searches) return false;
    const std::optional<Due<T>> seen = events_.first(run_.step, run_.x, run_.dxdt, {kinks});
    if (!seen) return false;
    due_ = seen;
    begin();
    return true;
  }

  /// Whether the step under way ends at an event.
  [[nodiscard]] bool at_event() const { return due_.has_value(); }

  /// Whether it ends at a kink.
  [[nodiscard]] bool at_kink() const { return due_ && due_->event == Event::kink; }

  /// Whether the moments jump there: a damped strand goes slack. (At other events they jump when the event is applied.)
  [[nodiscard]] bool at_jump() const { return at_kink() && due_->kink.of == Kink<T>::Of::strands; }

  /// Moves the state across that jump, from a step's end to the next one's start. @pre at_jump()
  void cross_jump() {
    Step<T>& step = run_.step;
    cross(run_.system, due_->kink, step.t, step.x, step.dxdt);
  }

  /// Whether that event is a hinge with exact friction that comes to rest or lets go.
  [[nodiscard]] bool at_friction() const {
    return due_ && (due_->event == Event::rest || due_->event == Event::release);
  }

  /// Applies the event that was due, and all others at the same instant, at the end of a step: latches
  /// engage (events/latches.hpp), hinges stick or begin to slide, holds let go.
  /// @param record to which the events are added
  /// @return whether anything happened; the right-hand side has then changed
  [[nodiscard]] bool apply_events(const LatchRecord& record) {
    const bool happened = events_.apply(due_, run_.step, record);
    run_.next_release = events_.releases().next();
    return happened;
  }

  /// The stuck hinge that was due to slide; 0: none.
  [[nodiscard]] int slides() const {
    return due_ && due_->event == Event::release ? due_->hinge : 0;
  }

private:
  void begin() {
    corrections_ = 0;
    rest_ = T(0);
    longest_ = run_.step.h;
    cut(due_->s * longest_);
  }

  /// Looks again for a release, in a step that ends where the moment that holds a hinge is largest.
  /// @return whether the moment passes its limit on the way; the step is then cut to end there
  [[nodiscard]] bool cut_at_release() {
    if (++corrections_ > 3) return false; // heuristic: the interpolant's instant is then kept
    const std::optional<Due<T>> seen = events_.first(run_.step, run_.x, run_.dxdt);
    if (!seen) return false;
    due_ = seen;
    longest_ = run_.step.h;
    cut(due_->s * longest_);
    return true;
  }

  /// Whether Newton's step to the event can be trusted: it is short, or the slope hardly changes over
  /// it. In a stiff motion accelerations are inaccurate, and the interpolant's instant may be off by
  /// much of a long step. Heuristic: too strict limits leave the interpolant's accuracy at the event;
  /// too loose ones let Newton's steps go astray, until the fourth correction stops them.
  [[nodiscard]] bool is_near(const typename Events<T, AnySystem>::Indicator& at,
                             const T& size) const {
    if (size < T(1e-2) * run_.step.h) return true;
    return size < T(0.5) * run_.step.h && keeps_slope(at, size) && at.bend != T(0);
  }

  /// Whether the slope changes by less than a tenth up to the event. It does not for a hinge that grazes its
  /// latch, where the slope vanishes.
  [[nodiscard]] static bool keeps_slope(const typename Events<T, AnySystem>::Indicator& at,
                                        const T& size) {
    using std::abs;
    return size * abs(at.bend) < T(0.1) * at.slope;
  }

  /// Cuts the step to end there; where a torque jumps, just before, so that no stage lies beyond. With one beyond, the
  /// method's error estimate would refuse the step.
  void cut(const T& to) {
    const T h = at_jump() ? T(to * (T(1) - T(0.5) * nearest_)) : to;
    const T shortest = T(8 * epsilon_of<T>) * larger(run_.step.t, longest_);
    run_.step.h = smaller(larger(h, shortest), longest_);
  }

  /// How far the end may miss the event, in steps, for the interpolant to carry the end there.
  ///
  /// Over s = dt/h steps the error of a rate is the third derivative's, h³ φ⁽⁶⁾/120 for a quintic, times
  /// dt²/2. For a swing at ω that is at most (ωh)⁵ s²/240 of its rate: with s² = 0.01 rtol, 4.2e-5 (ωh)⁵ rtol.
  /// Explicit methods are stable up to ωh = 5.96 (dop853). Computed for all phases, rtol 1e-4 and 1e-8, the loss
  /// there is 0.18 rtol, and 0.6 rtol at ωh = 9; positions lose less.
  /// Implicit methods, which step over swings, pass rtol = 0.
  [[nodiscard]] static T nearest(double rtol) {
    return larger(T(0.1 * std::sqrt(rtol)), T(round_off));
  }
  static constexpr double round_off = 1e-7; ///< in steps; its square is below round-off

  /// Moves the step's end by dt, along the quintic interpolant. Let D, V and A be what the step adds to a
  /// coordinate, to h times its rate and to h² times its acceleration, beyond the Taylor polynomial from
  /// the start (Step::interpolate). The third derivative at the end is
  ///
  ///     h³ φ⃛ = 60 D − 36 V + 9 A                                                              (1)
  ///
  /// or, in a step so short that rounding drowns (1), h³ φ⃛ = A.
  void shift_end(const T& dt) {
    using std::abs;
    Step<T>& step = run_.step;
    const int n = run_.at.freedoms();
    const T h = step.h, s = dt / h;
    for (int k = 0; k < n; ++k) {
      T &x = step.x1[k], &v = step.x1[k + n], &a = step.dxdt1[k + n];
      const T v0 = h * step.x[k + n], a0 = h * h * step.dxdt[k + n];
      const T D = (x - step.x[k]) - fused(T(0.5), a0, v0);
      const T V = fused(h, v - step.x[k + n], -a0), A = h * h * (a - step.dxdt[k + n]);
      const T rounding = T(64 * epsilon_of<T>) * larger(T(abs(x)), T(abs(step.x[k])));
      const bool drowned = rounding > T(1e-3) * larger(T(abs(a0)), T(abs(h * h * a)));
      const T bend = drowned ? A : fused(T(60), D, fused(T(-36), V, T(9) * A));
      const T third = bend / (h * h) * s; // φ⃛ dt
      x = fused(dt, fused(T(0.5) * dt, fused(T(1) / T(3), third, a), v), x);
      v = fused(dt, fused(T(0.5), third, a), v);
      a = a + third;
      step.dxdt1[k] = v;
    }
    for (int k = 2 * n; k < run_.at.size(); ++k) step.x1[k] = fused(dt, step.dxdt1[k], step.x1[k]);
  }

  Underway<T, AnySystem>& run_;
  Events<T, AnySystem>& events_;
  std::optional<Due<T>> due_; ///< the event that ends the step
  int corrections_ = 0;       ///< made to its instant
  int searches_ = 0;          ///< for earlier events, since the step was planned
  bool missed_ = false;       ///< the last landing ended before its event
  T nearest_ = T(0);          ///< how far the end may miss it, in steps
  T rest_ = T(0);             ///< from the end of the landing to the event, s
  T longest_ = T(0);          ///< the step in which it was found
};

} // namespace wingspread
