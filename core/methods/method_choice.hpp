/// `auto`: chooses the method, and reconsiders the choice during the run.
///
/// A phase begins with an explicit method, because the shock of a latch needs short steps anyway.
/// Later, when fast modes have died out, stability may hold the steps back, and no longer accuracy.
/// Then `auto` tries the linearly implicit extrapolation (seulex), keeps it while it integrates more
/// time for its cost, and returns to the explicit method otherwise.
///
/// Stability holds a step h back when h·ρ is near the method's limit. ρ is the spectral radius of the
/// linear model [0 E2; −M⁻¹K −M⁻¹D] of springs, latches and friction at the present configuration. A
/// bound of ρ that costs nothing decides first; ρ is measured once steps seem held back by that bound.
#pragma once

#include "core/methods/held_back_steps.hpp"
#include "core/methods/steppers.hpp"
#include "core/outcome.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace wingspread {

/// The constants of `auto`. All are heuristic: found by trying values on the shipped campaigns and on
/// the wings of the work-precision and stiffness studies (studies/ACCURACY.md). A wrong value costs
/// time and never accuracy, for every method meets the same tolerances. Results change within the
/// tolerance.
namespace choice {

/// Below this rtol order 8 (dop853) integrates, above it order 5 (dopri5). On the wings of
/// ACCURACY.md's table without friction dopri5 takes 3,490 evaluations at an error of 1e-3 and dop853
/// 3,706; at 1e-4 it is 3,767 against 3,706. With regularized friction dopri5 wins down to an error
/// of 1e-6: there `auto` costs up to 1.7 times the best method.
inline constexpr double order_8_below = 5e-3;
/// The same where latches are smoothed (the smoothed wings of the work-precision study).
inline constexpr double order_8_below_if_smoothed = 5e-4;
/// Below this rtol power series of order 16 integrate motions that have them. They reach an error of
/// 1e-3 in 236 µs and 1e-9 in 259, dop853 in 255 and 456 (ACCURACY.md).
inline constexpr double series_below = 5e-5;

/// A step counts as held back if it is longer than this share of the stable step, which is the limit on the real
/// axis. Where fast modes have died out, the estimate of the error may hold steps at 0.12 to 0.4 of it: with a stiff
/// elastic hold on a light panel, for a whole run (method_choice_test.cpp). Steps that resolve a ringing mode are as
/// long, 0.2 at rtol 1e-8. Smaller: the promise is checked more often. Larger: such steps are never left.
inline constexpr double held_back_share = 0.1;
/// Beyond this share a step is surely held back. On the imaginary axis the limit is 0.30 of the real one for dopri5,
/// 0.55 for taylor and 0.93 for dop853, and ρ is known to a fifth. Smaller: accurate steps count as surely held back.
/// Larger: modes that ring hold steps back unnoticed.
inline constexpr double surely_held_back_share = 0.4;
/// A step that is not surely held back is left if it is a smaller share than this of the time in which the motion
/// changes. Larger: vain trials on wings that move freely, which stand at 0.01. Smaller: steps behind an elastic hold,
/// at 0.002, stay short.
inline constexpr double clearly_promising_share = 0.004;
/// Steps from a phase's start to the first measurement of ρ, where nothing bounds ρ. Most phases of
/// ordinary wings are over by then and need none. Larger: stiff latches are noticed later.
inline constexpr int steps_to_first_radius = 7;
/// Steps between two measurements of ρ. One costs about six evaluations, half a step of order 8: 0.4 %.
/// Larger: the choice rests on a ρ from another configuration of the wing.
inline constexpr int steps_between_radii = 128;
/// Steps by series before `auto` considers another method. Most phases by series end sooner, and
/// accuracy limits long steps of high order, not stability.
inline constexpr int steps_before_leaving_series = 100;

/// Where steps are surely held back, the implicit method is promising if the stable step is a smaller share
/// than this of the time in which the motion changes (`highest_frequency`). Implicit steps cannot reach beyond that
/// time. An implicit step takes about 30 evaluations, which cost as much as 30·implicit_cost/12 = 6.5 steps
/// of order 8, so it breaks even at a share of 0.15; half of that, for `highest_frequency` is known to a factor of
/// two. Larger: more vain trials. Smaller: wings at the border stay with many short explicit steps.
inline constexpr double promising_share = 0.08;
/// Steps until `auto` checks the promise again, doubled from check to check between these limits.
inline constexpr int first_recheck = 10, longest_recheck = 80;
/// Factor on these limits after a step that was not surely held back: in a pack each check stops all lanes.
inline constexpr int longer_recheck = 4;
/// Held-back steps in a row after which a surely held-back one is left without a promise, for `highest_frequency` may be
/// wrong: of a wing that creeps it is. 200 steps of order 8 are 2,400 evaluations, a vain trial costs about a
/// third of that, and waits double. With 1,600 steps in place of 200 a wing that seulex alone integrates
/// in 1,300 evaluations took 29,000.
inline constexpr int steps_to_try_anyway = 200;

/// The first implicit step of a wing at rest, in explicit ones. The error of extrapolation has a hump where a step
/// lasts 1 to 10 time constants of a fast mode that has died out, and step control stays below it. Where nothing else
/// moves the first step is tried beyond the hump. Heuristic: smaller, and it may lie on the hump; larger, and more
/// trial steps are refused. A wing that moves begins with one explicit step: a long first step of low order can be
/// wrong there by more than its estimate.
inline constexpr double first_implicit_step = 30;

/// Implicit steps that are not judged: extrapolation needs them to find its order and step.
inline constexpr int unjudged_steps = 2;
/// Implicit steps at whose cost a loss against the explicit method ends the implicit phase. To come back
/// takes first_retry held-back steps, 64·12 evaluations: as much as ten implicit steps. So a bout of slow
/// steps, as after an event, is waited out while it costs less than to leave and return. With 1.5 in place
/// of 10 the methods alternate 110 times on the worst of 150 random wings, at 3 times the least cost.
inline constexpr double bearable_steps = 10;
/// Explicit steps after a vain trial before the next, doubled from trial to trial between these limits. On
/// chains of 20 panels a longest wait of 512 led to 2,629 implicit steps a run, of 4,096 to 229
/// (measured once; no driver repeats it).
inline constexpr int first_retry = 64, longest_retry = 4096;
/// Cost of an evaluation of the implicit method with its solves, in evaluations of an explicit one: 1.5 if
/// both are made alone. In lanes an explicit evaluation costs a third (20 panels) to a sixth (3 panels) of
/// one alone, real hinges and stuck ones gain less, and lanes have no implicit method; so there it is 1.5
/// times about three. A run must not depend on where it is made: the geometric mean √(1.5·4.5), which is at
/// most a factor of 1.75 off at either end.
inline constexpr double implicit_cost = 2.6;

} // namespace choice

/// Which method is active, and when that changes.
class MethodChoice {
public:
  /// @param how how.method is a name from `methods()`
  /// @param series has_series(wing): if not, dop853 takes their place
  MethodChoice(const Integration& how, bool series) : automatic_(how.method == "auto") {
    const double limit = how.smoothing ? choice::order_8_below_if_smoothed : choice::order_8_below;
    explicit_ = how.rtol < limit ? Method::dop853 : Method::dopri5;
    if (series && how.rtol < choice::series_below) explicit_ = Method::taylor;
    for (std::size_t k = 0; k < method_names.size(); ++k)
      if (method_names[k] == how.method) explicit_ = static_cast<Method>(k);
    if (explicit_ == Method::taylor && (!series || how.smoothing)) explicit_ = Method::dop853;
    active_ = explicit_;
  }

  [[nodiscard]] Method active() const { return active_; }
  [[nodiscard]] bool automatic() const { return automatic_; }

  /// Begins a phase after an event. The implicit method stays active: the wing is probably as stiff as before, and if
  /// it is not, leave_implicit soon ends the method. A wait after a vain trial goes on too, except at latches, which
  /// change the wing.
  /// @param most upper bound of ρ in the phase, 1/s; infinity: none, and ρ counts as 0 until measured
  /// @param latched whether the run begins or a latch has engaged
  void restart(double time, long evaluations, double most, bool latched) {
    const long left = static_cast<long>(held_back_.wait_until) - steps_;
    steps_ = 0;
    held_back_.last_free = mark(time, evaluations);
    held_back_.wait_until = explicit_ == Method::taylor ? choice::steps_before_leaving_series : 0;
    if (latched) {
      wait_after_trial_ = choice::first_retry;
      wait_after_check_ = choice::first_recheck;
    } else {
      held_back_.wait_until = std::max(held_back_.wait_until, static_cast<double>(left));
    }
    before_ = held_back_.last_free;
    if (active_ != explicit_) return; // ρ is measured a few steps on
    measured_ = !std::isfinite(most);
    wants_first_ = false;
    keep_radius(measured_ ? 0 : most);
  }

  /// Goes on after a hinge has come to rest or let go. That changes neither springs nor latches, so ρ need not be
  /// measured anew. @return false where the phase must begin anew all the same
  [[nodiscard]] bool goes_on(double time, long evaluations) {
    if (explicit_ == Method::taylor || !measured_) return false;
    held_back_.last_free = before_ = mark(time, evaluations);
    return true;
  }

  /// Whether ρ should be measured anew before the next step.
  [[nodiscard]] bool wants_radius() const {
    return automatic_ &&
           (measured_ ? steps_ % choice::steps_between_radii == choice::steps_to_first_radius
                      : wants_first_);
  }
  /// Takes a measured ρ, 1/s. @param time, evaluations of the run
  void set_radius(double radius, double time, long evaluations) {
    if (!measured_) {
      // By the bound alone a number of steps counted as held back. By ρ itself only seven more are
      // needed, so that `auto` decides as early as where ρ is measured from the start.
      held_back_.last_free = mark(time, evaluations);
      held_back_.last_free.steps -= HeldBackSteps<double>::enough - choice::steps_to_first_radius;
      measured_ = true;
    }
    keep_radius(radius);
  }

private:
  void keep_radius(double radius) {
    const double limit = explicit_ == Method::taylor   ? TaylorSeries<double>::stable_real
                         : explicit_ == Method::dop853 ? DormandPrince853<double>::stable_real
                                                       : DormandPrince5<double>::stable_real;
    const double before = stable_step_;
    stable_step_ = radius > 0 ? limit / radius : 1e300;
    if (active_ != explicit_) explicit_speed_ *= stable_step_ / before;
    held_back_.shortest = choice::held_back_share * stable_step_;
  }

public:
  /// Whether `after_step` may change the method after a step of h, and needs the highest frequency for that.
  [[nodiscard]] bool may_leave(double h) const {
    return automatic_ &&
           (active_ != explicit_ || held_back_.may_leave(h, static_cast<double>(steps_ + 1)));
  }

  /// Counts an accepted step of h that ends at `time`, and chooses the next step's method.
  /// @param evaluations of the run
  /// @param highest_frequency of time_scales.hpp, 1/s; unused unless may_leave(h)
  /// @return whether the method changes
  [[nodiscard]] bool after_step(double h, double time, long evaluations, double highest_frequency) {
    if (!automatic_) return false;
    ++steps_;
    const Mark now = mark(time, evaluations);
    return active_ == explicit_ ? leave_explicit(h, now, highest_frequency) : leave_implicit(now);
  }

  /// The first trial step of the active method, s. @param h the step planned by the method before
  [[nodiscard]] double first_step(double h) const {
    if (active_ == explicit_) return std::min(h, 0.5 * stable_step_);
    return is_still_ ? choice::first_implicit_step * h : h;
  }

  // ---- steps that a lane makes with the explicit method

  /// Accepted steps of this phase.
  [[nodiscard]] long steps() const { return steps_; }
  /// How many more steps may be accepted before ρ is to be measured.
  [[nodiscard]] long steps_to_radius() const {
    if (!automatic_ || !measured_) return std::numeric_limits<long>::max();
    return (choice::steps_between_radii + choice::steps_to_first_radius - 1 -
            steps_ % choice::steps_between_radii) %
           choice::steps_between_radii;
  }
  [[nodiscard]] const HeldBackSteps<double>& held_back() const { return held_back_; }
  /// Takes the counts of a lane that has accepted steps. @param steps of the phase; may_leave was false for each
  void resume(long steps, const HeldBackSteps<double>& held_back) {
    if (!automatic_) return;
    steps_ = steps;
    held_back_ = held_back;
  }

private:
  using Mark = StepMark<double>;
  [[nodiscard]] Mark mark(double time, long evaluations) const {
    return {time, static_cast<double>(evaluations), static_cast<double>(steps_)};
  }

  /// Time integrated per evaluation.
  [[nodiscard]] static double speed(const Mark& from, const Mark& now) {
    return (now.time - from.time) / std::max(now.evaluations - from.evaluations, 1.0);
  }

  [[nodiscard]] bool leave_explicit(double h, const Mark& now, double highest_frequency) {
    held_back_.accepted(true, h, now);
    if (!held_back_.may_leave(h, now.steps)) return false;
    wants_first_ = !measured_;
    if (wants_first_) return false;
    const bool surely = h > choice::surely_held_back_share * stable_step_;
    const bool promising = surely ? stable_step_ * highest_frequency < choice::promising_share
                                  : h * highest_frequency < choice::clearly_promising_share;
    const bool anyway =
        surely && now.steps >= held_back_.last_free.steps + choice::steps_to_try_anyway;
    if (!promising && !anyway) {
      held_back_.wait_until = now.steps + (surely ? 1 : choice::longer_recheck) * wait_after_check_;
      wait_after_check_ = std::min(2 * wait_after_check_, choice::longest_recheck);
      return false;
    }
    explicit_speed_ = speed(held_back_.last_free, now);
    is_still_ = highest_frequency == 0;
    active_ = Method::seulex;
    before_ = now;
    tried_ = 0, loss_ = gain_ = 0;
    return true;
  }

  [[nodiscard]] bool leave_implicit(const Mark& now) {
    const double cost = choice::implicit_cost * (now.evaluations - before_.evaluations);
    const double lost = cost - (now.time - before_.time) / explicit_speed_;
    before_ = now;
    if (++tried_ <= choice::unjudged_steps) return false;
    gain_ -= lost;
    loss_ = std::max(0.0, loss_ + lost);
    if (loss_ < choice::bearable_steps * cost) return false;
    active_ = explicit_;
    if (gain_ > 0) wait_after_trial_ = choice::first_retry;
    held_back_.last_free = now;
    held_back_.wait_until = now.steps + wait_after_trial_;
    wait_after_trial_ = std::min(2 * wait_after_trial_, choice::longest_retry);
    return true;
  }

  bool automatic_;
  bool is_still_ = false;    ///< nothing moved where the implicit method was chosen
  bool measured_ = true;     ///< ρ is measured or unbounded; false: its bound stands in for it
  bool wants_first_ = false; ///< steps are held back by the bound: measure ρ
  Method explicit_ = Method::dopri5, active_ = Method::dopri5;
  double stable_step_ = 0, explicit_speed_ = 0;
  long steps_ = 0;
  HeldBackSteps<double> held_back_{}; ///< of the explicit method
  Mark before_{};                     ///< where the last implicit step began
  double loss_ =
      0; ///< of the implicit method against the explicit one since it last paid, evaluations
  double gain_ = 0; ///< of the implicit method since it was last chosen, evaluations
  int tried_ = 0, wait_after_trial_ = choice::first_retry,
      wait_after_check_ = choice::first_recheck;
};

/// The choices with which runs begin: [0] for wings without series, [1] for wings with.
using FirstChoices = std::array<MethodChoice, 2>;
[[nodiscard]] inline FirstChoices first_choices(const Integration& how) {
  return {MethodChoice(how, false), MethodChoice(how, true)};
}

} // namespace wingspread
