/// The steps of a run: how long the next one is, by which method, and whether it is accepted.
#pragma once

#include "core/dense/friction_layer.hpp"
#include "core/events/kink_search.hpp"
#include "core/events/standstill.hpp"
#include "core/events/turning.hpp"
#include "core/methods/method_choice.hpp"
#include "core/methods/spectral_radius.hpp"
#include "core/methods/steppers.hpp"
#include "core/methods/time_scales.hpp"
#include "core/run/lane_protocol.hpp"
#include "core/run/record.hpp"
#include "core/run/underway.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wingspread {

/// Plans, makes and judges steps, and chooses the method.
template <class T, class AnySystem> class Stepping {
public:
  explicit Stepping(Underway<T, AnySystem>& run)
      : run_(run), first_choices_(first_choices(run.how)),
        choice_(first_choices_[0]), between_{run.step.x, run.step.dxdt} {}

  /// A run begins.
  void start() {
    tried_ = steps_ = rejected_ = 0;
    h_ = T(-1);
    engaged_ = -1;
    choice_ = first_choices_[has_series(run_.system.wing()) ? 1 : 0];
  }

  /// Begins anew after a change of the right-hand side. @param any_latch whether a latch has engaged
  /// @param by_friction whether a hinge has come to rest or let go
  void restart(bool any_latch, bool by_friction) {
    any_latch_ = any_latch;
    const std::vector<char>& latched = run_.system.work().engaged;
    const auto engaged = std::count(latched.begin(), latched.end(), true);
    const bool stiffens = engaged != std::exchange(engaged_, engaged);
    const auto time = static_cast<double>(run_.step.t);
    const bool friction_only = by_friction && !stiffens;
    if (!(friction_only && choice_.goes_on(time, evaluations())))
      choice_.restart(time, evaluations(), spectral_radius_bound<T>(run_.system), stiffens);
    begin_with_method();
    before_ = h_;
    if (!(friction_only && h_ > T(0) && has_lanes(method()))) h_ = T(-1);
  }

  /// Begins anew at a knot of a table (of the base or of a motor), with the step size so far.
  void restart_at_knot() { begin_with_method(); }

  [[nodiscard]] Method method() const { return choice_.active(); }
  [[nodiscard]] long steps() const { return steps_; } ///< accepted
  /// Evaluations without those of peak searches, by which `auto` compares methods.
  [[nodiscard]] long evaluations() const { return run_.system.work().evaluations - run_.searched; }
  [[nodiscard]] Work work() const { return {steps_, rejected_, run_.system.work().evaluations}; }

  /// The tolerance of a step. Before the first latch it is 32 times finer than asked: this phase takes
  /// a few per cent of a run's steps, and its errors shift all that follows. Heuristic: a smaller
  /// factor costs accuracy at every later event, a larger one costs steps.
  [[nodiscard]] Tolerance tolerance() const {
    const double finer = !any_latch_ && method() != Method::runge_kutta4 ? 32 : 1;
    return {run_.how.rtol / finer, run_.how.atol / finer};
  }

  /// The tolerance for landing on events. 0 for implicit methods: they step over fast motion, and the
  /// acceleration at a step's end does not predict the next instants.
  [[nodiscard]] double rtol_of_landing() const {
    return is_implicit(method()) ? 0 : tolerance().rtol;
  }

  /// Which kinks end a step of the method, if any does.
  [[nodiscard]] std::optional<KinkLimit> kinks() const {
    const bool smooth = needs_smooth_laws(method());
    if (!smooth && !run_.system.wing().is_real()) return std::nullopt;
    return KinkLimit{tolerance().rtol, tolerance().atol, !smooth};
  }

  // ---- a step: planned, made, judged

  /// Plans the next trial step. @return why none is possible, if so
  [[nodiscard]] std::optional<std::string> plan() {
    if (h_ < T(0)) choose_first_step();
    if (tried_ >= run_.how.max_steps)
      return "the limit of " + std::to_string(run_.how.max_steps) +
             " steps (max_steps) was reached";
    const T rest = end_of_stretch() - run_.step.t, wanted = wanted_step(rest);
    last_ = wanted >= rest * T(1 - 1e-12);
    run_.step.h = last_ ? rest : wanted;
    if (!(run_.step.h > T(4 * epsilon_of<T>) * run_.step.t))
      return "the step size fell below round-off: the equations are too stiff or not finite here";
    return std::nullopt;
  }

  /// Where a step ends at the latest, s: at t_end, at a knot of the base's table or a motor's, or where a hold lets go.
  [[nodiscard]] T end_of_stretch() const {
    return smaller(T(run_.how.t_end), smaller(run_.system.next_knot(), run_.next_release));
  }
  /// Whether the planned step ends there.
  [[nodiscard]] bool is_last() const { return last_; }

  /// Makes a trial step of h from where the run stands. A method may make it shorter, and sets h.
  [[nodiscard]] StepVerdict attempt(T& h, State<T>& x1, State<T>& dxdt1) {
    return steppers_.with(method(), [&](auto& stepper) {
      const Step<T>& step = run_.step;
      return stepper.attempt(run_.system, Start<T>{step.t, step.x, step.dxdt}, h, x1, dxdt1);
    });
  }

  /// The same inside an accepted step: order and size of the next step stay as that step has left them.
  [[nodiscard]] StepVerdict attempt_inside(T& h, State<T>& x1, State<T>& dxdt1) {
    return steppers_.keeping_control(method(), [&] { return attempt(h, x1, dxdt1); });
  }

  /// Shortens the planned step to what the method has made.
  void fit(const T& h) {
    if (!(h < run_.step.h)) return;
    run_.step.h = h;
    last_ = false;
  }

  /// Makes a step of h in parts, where the method rejects it as a whole: extrapolation raises its order
  /// step by step, and begins with a low one. The system's last evaluation is at the end.
  /// @return whether the parts lead there. Adams' method cannot: its history belongs to the start
  [[nodiscard]] bool reach_in_parts(const T& h, State<T>& x1, State<T>& dxdt1) {
    if (method() == Method::adams_bashforth_moulton) return false;
    return steppers_.keeping_control(method(), [&] {
      between_.x = run_.step.x, between_.dxdt = run_.step.dxdt;
      T rest = h, part = T(0.5) * h;
      for (int tries = 0; tries < 64; ++tries) { // heuristic: beyond, dense output must do
        const StepVerdict verdict = steppers_.with(method(), [&](auto& stepper) {
          const T t = run_.step.t + (h - rest);
          return stepper.attempt(run_.system, {t, between_.x, between_.dxdt}, part, x1, dxdt1);
        });
        if (verdict.accepted()) {
          if (!(part < rest)) return true;
          rest = rest - part;
          std::swap(between_.x, x1), std::swap(between_.dxdt, dxdt1);
        }
        part = part * T(verdict.accepted() ? verdict.factor : std::min(verdict.factor, 0.7));
        if (part > T(0.5) * rest) part = part < rest ? T(0.5) * rest : rest;
      }
      return false;
    });
  }

  /// Adds to the method's verdict what else a step must satisfy: it does not leap over a layer of
  /// friction, and with methods of long steps the dense output is accurate inside.
  [[nodiscard]] StepVerdict judged(StepVerdict verdict) const {
    if (verdict.accepted() && run_.system.wing().has_regularized_friction) limit_by_layers(verdict);
    if (verdict.accepted() && is_implicit(method()))
      limit_roughness(static_cast<double>(roughness_of_motors(run_.system, run_.step)), verdict);
    if (!verdict.accepted() || !takes_long_steps(method())) return verdict;
    // the interpolant decides whether a hinge that grazes its latch reaches it
    const double finer = method() == Method::bulirsch_stoer ? 10 : 1;
    const Step<T>& step = run_.step;
    const T rough = roughness(run_.at, step, T(run_.how.atol));
    limit_roughness(finer * static_cast<double>(rough), verdict);
    if (!verdict.accepted() || method() != Method::fehlberg78 || !run_.at.smoothed) return verdict;
    const double quadrature = quadrature_error<T>(run_.system, step, tolerance());
    if (quadrature > 1)
      verdict = {quadrature, std::max(0.2, 0.8 * power_roughly(quadrature, -1.0 / 6))};
    return verdict;
  }

  /// Rejects a step by series beyond the first turning point that counts: the dense output of so long a
  /// step would not show how far the hinge comes. @param verdict on the step under way
  template <class AnyEvents>
  [[nodiscard]] StepVerdict cut_at_turn(const StepVerdict& verdict, const AnyEvents& events) const {
    if (!verdict.accepted() || method() != Method::taylor) return verdict;
    T first(1);
    for (int i = 1; i <= run_.at.bodies; ++i)
      if (turns_near_an_end(run_.system.wing(), run_.at, run_.step, i, events.may_latch(i)))
        if (const std::optional<T> s = turning_point(run_.at, run_.step, i))
          first = smaller(first, *s);
    return first < T(1) ? StepVerdict{2, static_cast<double>(first)} : verdict;
  }

  /// Writes the method's own state at the fraction s of the step to the run's x. @return whether the
  /// method has one
  [[nodiscard]] bool evaluate_inside(const T& s) {
    if (method() != Method::taylor) return false;
    const Step<T>& step = run_.step;
    steppers_.taylor().formula().inside(run_.system, {step.t, step.x, step.dxdt}, T(s * step.h),
                                        run_.x);
    return true;
  }

  /// Counts a trial step and keeps its verdict. @return whether it is accepted
  [[nodiscard]] bool count_trial(const StepVerdict& judged) {
    ++tried_;
    verdict_ = judged;
    return verdict_.accepted();
  }

  /// Whether the last trial step's error is a number.
  [[nodiscard]] bool is_finite() const { return verdict_.error < 1e100; }

  /// Chooses the size of the step after the planned one, which was accepted.
  void choose_next_size() {
    const T next = run_.step.h * T(verdict_.factor);
    h_ = last_ && !(verdict_.factor < 1) ? larger(h_, next) : next;
  }

  /// Plans a shorter step after a rejection. @return why none is possible, if so
  [[nodiscard]] std::optional<std::string> plan_again() {
    ++rejected_;
    const bool fixed = steppers_.with(method(), [](auto& stepper) {
      stepper.rejected();
      return std::decay_t<decltype(stepper)>::fixed_step;
    });
    if (fixed) return why_fixed_step_fails();
    h_ = run_.step.h * T(verdict_.factor);
    return plan();
  }

  /// Where a kink of a hinge's law lies in a step that was refused, and may be why: a fraction of the step. An explicit
  /// formula's error hardly falls until the step ends before the kink.
  [[nodiscard]] std::optional<T> kink_inside() const {
    if (run_.system.wing().real.empty() || needs_smooth_laws(method()) || !has_memory())
      return std::nullopt;
    // A trial step in which the wing flies apart says nothing of kinks: it may even overflow. Heuristic: with a larger
    // limit such steps are cut to kinks that are not there.
    constexpr double believable = 1; // rad
    using std::abs;
    for (int i = 1; i <= run_.at.bodies; ++i)
      if (!(abs(run_.step.x1[run_.at.angle(i)] - run_.step.x[run_.at.angle(i)]) < T(believable)))
        return std::nullopt;
    const KinkLimit limit{tolerance().rtol, tolerance().atol};
    return KinkSearch<T, AnySystem>(run_.system, run_.step, limit).first_of_hinges();
  }

  /// Plans to make a refused step again, up to a kink at this fraction of it. @return why none is possible, if so
  [[nodiscard]] std::optional<std::string> plan_to_kink(const T& fraction) {
    constexpr double least =
        1e-3; // heuristic: three steps, each ten times longer, lead back to this one's size
    ++rejected_;
    const double part = std::max(static_cast<double>(fraction), least);
    memory().cut(part);
    h_ = run_.step.h * T(part);
    return plan();
  }

  /// Counts a refused step that is made again up to a jump inside. The next one is tried as long as this.
  void plan_to_jump(const T& h) {
    ++rejected_;
    steppers_.with(method(), [](auto& stepper) { stepper.rejected(); });
    h_ = h;
    last_ = false;
  }

  /// Moves the run to the end of an accepted step. @param at_event whether the step ends at an event
  void advance(bool at_event) {
    ++steps_;
    Step<T>& step = run_.step;
    steppers_.with(method(),
                   [&](auto& stepper) { stepper.accepted(verdict_, static_cast<double>(step.h)); });
    const T end = end_of_stretch();
    step.t = last_ && !at_event ? end : T(step.t + step.h);
    for (const T& next : {end, T(run_.how.t_end)})
      if (next <= reached_at(step.t)) step.t = larger(step.t, next);
    std::swap(step.x, step.x1);
    std::swap(step.dxdt, step.dxdt1);
  }

  /// Lets `auto` choose the method for what follows. @return whether the method changes
  [[nodiscard]] bool choose_method() {
    const double h = static_cast<double>(run_.step.h);
    const double quick =
        choice_.may_leave(h) ? highest_frequency(run_.system, run_.step, T(tolerance().atol)) : 0;
    const bool changes =
        choice_.after_step(h, static_cast<double>(run_.step.t), evaluations(), quick);
    if (changes) {
      begin_with_method();
      h_ = T(choice_.first_step(static_cast<double>(h_)));
    }
    if (choice_.wants_radius())
      choice_.set_radius(radius_.estimate(run_.system, run_.step.x, run_.step.t),
                         static_cast<double>(run_.step.t), evaluations());
    return changes;
  }

  // ---- steps made elsewhere

  /// tries_left: trial steps that a lane may make before it must return control, if no event, peak or proof is due.
  /// steps_to_radius: how many of them it may accept.
  [[nodiscard]] long tries_left() const { return run_.how.max_steps - tried_ - 1; }
  [[nodiscard]] long steps_to_radius() const { return choice_.steps_to_radius(); }
  [[nodiscard]] StepHistory<double> history() {
    return {static_cast<double>(choice_.steps()), memory(), choice_.held_back()};
  }
  /// Counts the steps that a lane has made. @return how many it accepted
  long resume(const LaneResult& result) {
    const long steps = static_cast<long>(result.history.steps) - choice_.steps();
    tried_ += result.trial_steps;
    steps_ += steps;
    rejected_ += result.trial_steps - steps;
    memory() = result.history.memory;
    choice_.resume(static_cast<long>(result.history.steps), result.history.held_back);
    return steps;
  }

private:
  void begin_with_method() {
    steppers_.with(method(), [&](auto& stepper) {
      stepper.restart(tolerance());
      if constexpr (requires { stepper.memory(); })
        if (!any_latch_) stepper.memory().foresee();
    });
  }

  /// The method's own first step, or the step size before the event if that is less: most events change the motion
  /// little, and an estimate from one point is too long as often as too short. (Events of friction leave the size as it
  /// was.)
  void choose_first_step() {
    const Step<T>& step = run_.step;
    const T rest = end_of_stretch() - step.t;
    const T longest = time_to_a_radian(run_.at, step, rest);
    h_ = steppers_.with(method(), [&](auto& stepper) {
      using Stepper = std::decay_t<decltype(stepper)>;
      if (Stepper::fixed_step) return T(2 * run_.how.step); // two steps per attempt
      if (method() == Method::taylor) return longest;       // the method shortens it
      return first_step(run_.system, step.x, step.dxdt, step.t, Stepper::order, tolerance().rtol,
                        tolerance().atol, longest, run_.x, run_.dxdt);
    });
    if (before_ > T(0) && method() != Method::taylor) h_ = smaller(h_, before_);
  }

  /// @param rest time to end_of_stretch(), s
  [[nodiscard]] T wanted_step(const T& rest) const {
    if (AnySystem::base_motion == BaseMotion::prescribed && run_.system.work().locked > 0 &&
        !is_stuck_for_good(run_.system, run_.step.x))
      return smaller(
          h_, time_of_base(run_.system.wing().base, run_.system.work().driven, run_.step.t, rest));
    return h_;
  }

  void limit_by_layers(StepVerdict& verdict) const {
    if (method() == Method::runge_kutta4) return; // the step is fixed
    const Tolerance limit = tolerance();
    const LayerLimits<T> layers =
        layer_limits(run_.system.wing(), run_.at, run_.step, T(limit.rtol), T(limit.atol));
    if (layers.cut < T(1))
      verdict = {2, static_cast<double>(layers.cut)};
    else
      verdict.factor = std::min(verdict.factor, static_cast<double>(layers.next));
  }

  [[nodiscard]] std::string why_fixed_step_fails() const {
    const std::string step = "the fixed step of " + in_words(run_.how.step) + " s ";
    if (!std::isfinite(verdict_.error)) return step + "gives numbers that are not finite";
    return step + "misses the tolerance " + in_words(verdict_.error) + "-fold";
  }

  [[nodiscard]] bool has_memory() const {
    return method() == Method::cash_karp54 || has_lanes(method());
  }

  /// The memory of step control. @pre has_memory()
  [[nodiscard]] StepMemory<double>& memory() {
    return steppers_.with(method(), [](auto& stepper) -> StepMemory<double>& {
      if constexpr (requires { stepper.memory(); }) return stepper.memory();
      std::abort();
    });
  }

  Underway<T, AnySystem>& run_;
  const FirstChoices first_choices_;
  MethodChoice choice_;
  SpectralRadius<T> radius_;
  Steppers<T> steppers_;
  struct {
    State<T> x, dxdt;
  } between_;                 ///< where the next part of a step starts
  StepVerdict verdict_{0, 1}; ///< on the last trial step
  T h_ = T(-1);               ///< size of the next step, s; negative: not chosen yet
  T before_ = T(-1);          ///< h_ before the last restart
  bool last_ = false;         ///< the planned step ends at end_of_stretch()
  bool any_latch_ = false;    ///< a latch has engaged
  long engaged_ = -1;         ///< latches at the last restart; -1: the run has not begun
  long tried_ = 0, steps_ = 0, rejected_ = 0;
};

} // namespace wingspread
