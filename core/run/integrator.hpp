/// One run from release to its end: steps, events, peaks, and the reasons to stop.
#pragma once

#include "core/events/events.hpp"
#include "core/methods/long_steps.hpp"
#include "core/methods/method_choice.hpp"
#include "core/methods/spectral_radius.hpp"
#include "core/methods/steppers.hpp"
#include "core/methods/time_scales.hpp"
#include "core/packs/pack_engine.hpp"
#include "core/peaks/force_peaks.hpp"
#include "core/peaks/moment_peaks.hpp"
#include "core/proofs/energy_above_rest.hpp"
#include "core/proofs/peak_bounds.hpp"
#include "core/proofs/stall.hpp"
#include "core/run/record.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

namespace wingspread {

/// Integrates one wing. Storage is made before the first step; a step of the core's own methods
/// allocates nothing.
template <class T, class Topology, BaseMotion M> class Integrator {
public:
  using AnySystem = System<T, Topology, M>;

  Integrator(AnySystem& system, const Integration& how, const Goal& goal, const Observer& observer)
      : system_(system), at_(system.layout()), how_(how), goal_(goal), observer_(observer),
        events_(system), choice_(how.method, how.rtol, how.smoothing.has_value()) {
    for (State<T>* x : {&step_.x, &step_.dxdt, &step_.x1, &step_.dxdt1, &scratch_, &dscratch_})
      x->assign(at_.size(), T(0));
  }

  [[nodiscard]] Outcome run() {
    begin();
    while (!ended_) take(make_try());
    return std::move(outcome_);
  }

  // ---- a run as a dialogue: it asks for a step of its method and is told the verdict

  /// What is asked for: a step from `step()` over h into x1 and dxdt1.
  struct Try {
    T h;
    State<T>*x1, *dxdt1;
  };

  /// Starts anew, with the system's parameters as they now are.
  void begin() {
    start();
    if (finite(step_.dxdt))
      go_on();
    else
      fail("the accelerations are not finite at the start");
  }

  /// Whether the run is over; if not, a step is asked for.
  [[nodiscard]] bool ended() const { return ended_; }
  /// @pre ended()
  [[nodiscard]] Outcome&& outcome() { return std::move(outcome_); }

  /// Makes the step that is asked for.
  [[nodiscard]] Verdict make_try() {
    return steppers_.with(choice_.active(), [&](auto& stepper) {
      return stepper.attempt(system_, Start<T>{step_.t, step_.x, step_.dxdt}, try_.h, *try_.x1,
                             *try_.dxdt1);
    });
  }

  // ---- the same where steps are made elsewhere, several runs at once

  /// Whether an engine of packs for this method can make the step that is asked for.
  [[nodiscard]] bool fits_pack(Method method) const {
    return choice_.active() == method && !system_.wing().can_stick;
  }
  [[nodiscard]] const Try& asked() const { return try_; }
  [[nodiscard]] Step<T>& step() { return step_; }
  [[nodiscard]] ForcePeaks<T, AnySystem>& forces() { return forces_; }
  [[nodiscard]] const std::vector<PeakOf<T>>& moments() const { return moments_; }

  /// The verdict on a step of this scaled error.
  [[nodiscard]] Verdict verdict_of(double error) {
    return steppers_.with(choice_.active(), [&](auto& stepper) -> Verdict {
      if constexpr (requires { stepper.verdict(error, 1.0); })
        return stepper.verdict(error, static_cast<double>(try_.h));
      return {error, 1};
    });
  }

  /// How far an engine may go from here without a word. @pre fits_pack(its method)
  [[nodiscard]] Stretch stretch() {
    Stretch s;
    s.h = static_cast<double>(try_.h);
    s.memory = memory();
    s.t_end = how_.t_end;
    const bool plain = stage_ == Stage::step && !last_;
    s.tries =
        plain ? std::min({how_.max_steps - tried_ - 1, choice_.steps_to_radius(), steps_to_look()})
              : 0;
    s.held_back_step = choice_.held_back_step();
    s.last_free = static_cast<double>(choice_.last_free().steps - choice_.steps());
    s.enough = MethodChoice::enough;
    s.wait = static_cast<double>(choice_.wait_until() - choice_.steps());
    return s;
  }

  /// An engine has gone so far; the step that is asked for is now the one it made last.
  /// @param each evaluations of a try
  void catch_up(const Progress& progress, long each) {
    long& evaluations = system_.count_evaluations();
    const long before = evaluations;
    evaluations += (progress.tries + 1) * each;
    if (progress.tries == 0) return;
    tried_ += progress.tries;
    steps_ += progress.steps;
    rejected_ += progress.tries - progress.steps;
    if (proofs_may_end()) since_last_look_ += progress.steps;
    step_.t = T(progress.t);
    step_.h = try_.h = T(progress.h);
    memory() = progress.memory;
    choice_.catch_up(progress.steps, progress.last_free,
                     {progress.free_time, before + progress.tries_to_free * each});
  }

  /// The step asked for has been made, and the system's last evaluation was at its end.
  void take(const Verdict& verdict) {
    switch (stage_) {
    case Stage::step:
      return take_step(verdict);
    case Stage::event:
      return take_step_to_event(verdict);
    case Stage::force:
      return take_force();
    case Stage::moment:
      return take_moment();
    case Stage::repeat:
      return finish_step();
    }
  }

  /// What a step may lose now. Up to the first latch 32 times less than asked: the phase takes a
  /// few per cent of a run's steps, and what is lost in it shifts all that follows.
  [[nodiscard]] Tolerance tolerance() const {
    const double finer = latches_.empty() && choice_.active() != Method::runge_kutta4 ? 32 : 1;
    return {how_.rtol / finer, how_.atol / finer};
  }

private:
  /// What the step asked for is for.
  enum class Stage {
    step,   ///< to go on
    event,  ///< to end at the event that is due
    force,  ///< to make sure of a peak force inside the step accepted
    moment, ///< the same of a peak moment
    repeat  ///< to leave the method as the step accepted did
  };

  void ask(Stage stage, const T& h, State<T>& x1, State<T>& dxdt1) {
    stage_ = stage;
    try_ = {h, &x1, &dxdt1};
  }

  // ---- the run, step by step

  /// Of the step control of a method that an engine has.
  [[nodiscard]] StepMemory<double>& memory() {
    return steppers_.with(choice_.active(), [](auto& stepper) -> StepMemory<double>& {
      if constexpr (requires { stepper.memory(); }) return stepper.memory();
      std::abort();
    });
  }

  void start() {
    ended_ = stalled_ = bounds_ready_ = false;
    outcome_ = {};
    tried_ = steps_ = rejected_ = since_last_look_ = 0;
    largest_drift_ = 0;
    why_stalled_.clear();
    latches_.clear();
    phases_.clear();
    moments_.assign(at_.bodies + 1, {});
    events_.start();
    step_.t = T(0);
    system_.reset();
    system_.want_forces(goal_.peak_force);
    system_.start(step_.x);
    if constexpr (M == BaseMotion::free) kept_ = conserved(system_, step_.x, step_.t);
    initial_energy_ = total_energy(system_, step_.x, step_.t);
    if (goal_.peak_force) forces_.start(at_.bodies);
    choice_ = MethodChoice(how_.method, how_.rtol, at_.smoothed);
    restart(0);
  }

  /// Ends the run, or asks for the next step.
  void go_on() {
    if (finished()) {
      const Status status = ending();
      return end(status, status == Status::stalled ? why_stalled_ : "");
    }
    try_step();
  }

  void try_step() {
    if (h_ < T(0)) choose_first_step();
    if (tried_ >= how_.max_steps)
      return fail("the limit of " + std::to_string(how_.max_steps) + " steps was reached");
    const T limit = T(how_.t_end) - step_.t;
    T wanted = h_;
    if (M == BaseMotion::prescribed && system_.work().stuck > 0)
      wanted = smaller(wanted, time_of_base(system_.wing().base, step_.t, limit));
    last_ = wanted >= limit * T(1 - 1e-12);
    step_.h = last_ ? limit : wanted;
    if (!(step_.h > T(4 * epsilon_of<T>) * step_.t))
      return fail(
          "the step size fell below round-off: the equations are too stiff or not finite here");
    ask(Stage::step, step_.h, step_.x1, step_.dxdt1);
  }

  void take_step(const Verdict& given) {
    const Verdict verdict = judged(given);
    if (!verdict.accepted()) return refuse(verdict);
    verdict_ = verdict;
    h_ = last_ ? larger(h_, T(step_.h * T(verdict.factor))) : step_.h * T(verdict.factor);
    if (last_ && verdict.factor < 1) h_ = step_.h * T(verdict.factor);
    due_ = events_.first(step_, scratch_, dscratch_);
    if (!due_) return accept();
    correction_ = 0;
    longest_ = step_.h;
    try_step_to_event(due_->s * longest_);
  }

  /// Counts a try, and adds what else a step must satisfy where the method takes long ones: a dense
  /// output that shows what happens inside.
  [[nodiscard]] Verdict judged(Verdict verdict) {
    ++tried_;
    const Method method = choice_.active();
    if (!verdict.accepted() || !takes_long_steps(method)) return verdict;
    // whether a hinge that grazes its latch reaches it is the interpolant's word
    const double finer = method == Method::bulirsch_stoer ? 10 : 1;
    const T rough = roughness(at_, step_.h, step_.dxdt, step_.dxdt1, T(how_.atol));
    limit_roughness(finer * static_cast<double>(rough), verdict);
    if (!verdict.accepted() || method != Method::fehlberg78 || !at_.smoothed) return verdict;
    const double quadrature = quadrature_error<T>(system_, step_, tolerance());
    if (quadrature > 1)
      verdict = {quadrature, std::max(0.2, 0.8 * power_roughly(quadrature, -1.0 / 6))};
    return verdict;
  }

  /// Cuts the step after a rejection; fails where the method cannot.
  void refuse(const Verdict& verdict) {
    ++rejected_;
    const bool fixed = steppers_.with(choice_.active(), [](auto& stepper) {
      stepper.rejected();
      return std::decay_t<decltype(stepper)>::fixed_step;
    });
    if (fixed)
      return fail(std::isfinite(verdict.error)
                      ? "the fixed step of " + in_words(how_.step) + " s misses the tolerance " +
                            in_words(verdict.error) + "-fold"
                      : "the fixed step of " + in_words(how_.step) +
                            " s gives numbers that are not finite");
    h_ = step_.h * T(verdict.factor);
    try_step();
  }

  // ---- a step accepted: its peaks, some of them made sure of by steps of the method inside it,
  // then what it brings about

  void accept() {
    if constexpr (M == BaseMotion::free) restore_momentum();
    probed_ = false;
    due_moment_ = 0;
    if (goal_.peak_force) forces_.over_step(system_, step_, scratch_, dscratch_);
    probe_next();
  }

  /// Asks for the next step inside the one accepted, or goes on behind it.
  void probe_next() {
    if (goal_.peak_force && forces_.doubtful()) return probe(Stage::force, *forces_.doubtful());
    while (goal_.peak_moment && ++due_moment_ <= at_.bodies) {
      if (system_.sticks(due_moment_)) {
        raise_held_moment(moments_[due_moment_], system_, step_, due_moment_,
                          [this](const T& s) -> const State<T>& {
                            step_.interpolate(at_, s, scratch_);
                            system_(scratch_, dscratch_, step_.t + s * step_.h);
                            return scratch_;
                          });
        continue;
      }
      doubt_ = raise_moment(moments_[due_moment_], system_, step_, due_moment_);
      if (doubt_) return probe(Stage::moment, doubt_->s);
    }
    if (probed_ && choice_.active() == Method::adams_bashforth_moulton)
      return probe(Stage::repeat, T(1)); // what it will keep must be the step accepted
    finish_step();
  }

  void probe(Stage stage, const T& s) {
    probed_ = true;
    ask(stage, T(s * step_.h), scratch_, dscratch_);
  }

  void take_force() {
    forces_.confirm(system_);
    probe_next();
  }

  void take_moment() {
    if (confirm_moment(*doubt_, moments_[due_moment_], system_, step_, due_moment_, scratch_,
                       dscratch_))
      return probe(Stage::moment, doubt_->s);
    probe_next();
  }

  void finish_step() {
    const bool reaches_end = last_ && !due_;
    count_step();
    step_.t = reaches_end ? T(how_.t_end) : T(step_.t + step_.h);
    if (T(how_.t_end) - step_.t <= T(8 * epsilon_of<T>) * step_.t) step_.t = T(how_.t_end);
    std::swap(step_.x, step_.x1);
    std::swap(step_.dxdt, step_.dxdt1);
    if (goal_.audit && latches_.empty()) watch_energy();
    if (system_.work().stuck > 0) {
      system_(step_.x, dscratch_, step_.t);
      events_.begin_step(step_.x);
    }
    notify();
    if (!happens(due_)) {
      const double h = static_cast<double>(step_.h);
      const double quick = choice_.may_leave(h) ? quickness(system_, step_) : 0;
      const MethodChoice::Mark now{static_cast<double>(step_.t), system_.work().evaluations};
      if (choice_.after_step(h, now, quick)) change_method();
      if (choice_.wants_radius()) choice_.set_radius(radius_.estimate(system_, step_.x, step_.t));
    }
    if (angles_are_known(at_, step_.x))
      go_on();
    else
      fail("a hinge has turned past 1e8 rad");
  }

  void sample_moments() {
    using std::abs;
    for (int i = 1; i <= at_.bodies; ++i)
      moments_[i].raise(T(abs(system_.moment(step_.x, i))), step_.t);
  }

  void count_step() {
    ++steps_;
    steppers_.with(choice_.active(), [&](auto& stepper) {
      stepper.accepted(verdict_, static_cast<double>(step_.h));
    });
  }

  // ---- events

  /// Replaces the step by one that ends at the event, so that its state has the method's accuracy
  /// and not the interpolant's; the instant is corrected by Newton's method with real steps. A
  /// hinge that only grazes its latched angle has no useful Newton step: there the interpolant's
  /// instant stands.
  void try_step_to_event(const T& h) {
    const T shortest = T(8 * epsilon_of<T>) * larger(step_.t, longest_);
    step_.h = smaller(larger(h, shortest), longest_);
    ask(Stage::event, step_.h, step_.x1, step_.dxdt1);
  }

  void take_step_to_event(const Verdict& given) {
    const Verdict verdict = judged(given);
    if (!verdict.accepted()) return refuse(verdict);
    verdict_ = verdict;
    const auto at = events_.indicator(*due_, step_);
    const T late = at.value / at.slope, size = larger(late, T(-late));
    if (at.slope > T(0) && size < T(1e-2) * step_.h && correction_ < 3) {
      if (size > T(1e-7) * step_.h) {
        ++correction_;
        return try_step_to_event(step_.h - late);
      }
      shift(-late); // the rest is linear: its square is below round-off
      step_.h = smaller(T(step_.h - late), longest_);
    }
    accept();
  }

  /// Moves the step's end by dt, to first order in x.
  void shift(const T& dt) {
    for (std::size_t k = 0; k < step_.x1.size(); ++k)
      step_.x1[k] = fused(dt, step_.dxdt1[k], step_.x1[k]);
  }

  /// At a step's end: what the event that was due, and others at the same instant, bring about.
  /// @return whether anything happened
  [[nodiscard]] bool happens(const std::optional<Due<T>>& due) {
    if (!events_.happen(due, step_, latches_)) return false;
    restart(due && due->event == Event::release ? due->hinge : 0);
    return true;
  }

  /// The right-hand side has changed, or is new: evaluates it, at t⁺.
  void restart(int let_go) {
    if (system_.wing().can_stick)
      sort_contacts(system_, step_.x, step_.dxdt, step_.t, let_go);
    else
      system_(step_.x, step_.dxdt, step_.t);
    sample_moments();
    if (goal_.peak_force) forces_.sample(system_, step_.t);
    events_.begin_step(step_.x);
    notify();
    choice_.restart(static_cast<double>(step_.t), system_.work().evaluations);
    begin_phase();
    h_ = T(-1);
  }

  // ---- methods

  /// `auto` goes on with another one.
  void change_method() {
    begin_phase();
    h_ = T(choice_.first_step(static_cast<double>(h_)));
  }

  void begin_phase() {
    const std::string name = name_of(choice_.active());
    if (phases_.empty() || phases_.back().method != name) {
      close_phase();
      phases_.push_back({name, static_cast<double>(step_.t), 0, -steps_});
    }
    steppers_.with(choice_.active(), [&](auto& stepper) {
      stepper.restart(tolerance());
      if constexpr (requires { stepper.memory(); })
        if (latches_.empty()) stepper.memory().foresee();
    });
  }

  void close_phase() {
    if (phases_.empty()) return;
    phases_.back().to = static_cast<double>(step_.t);
    phases_.back().steps += steps_;
  }

  void choose_first_step() {
    const T rest = T(how_.t_end) - step_.t;
    h_ = steppers_.with(choice_.active(), [&](auto& stepper) {
      using Stepper = std::decay_t<decltype(stepper)>;
      if (Stepper::fixed_step) return T(2 * how_.step); // it takes two at a time
      return first_step(system_, step_.x, step_.dxdt, step_.t, Stepper::order, tolerance().rtol,
                        tolerance().atol, time_to_a_radian(at_, step_, rest), scratch_, dscratch_);
    });
  }

  void restore_momentum() {
    const T end = step_.t + step_.h;
    if constexpr (M == BaseMotion::free) keep_momentum(system_, kept_, step_.x1, end);
    system_(step_.x1, step_.dxdt1, end);
  }

  // ---- the end

  [[nodiscard]] bool any_latch() const { return !latches_.empty(); }

  [[nodiscard]] bool finished() {
    if (!(step_.t < T(how_.t_end))) return true;
    if (goal_.first_latch_only && any_latch()) return true;
    if (goal_.to_t_end) return false;
    if (rests_for_ever() && (events_.latches_left() > 0 || any_latch())) return true;
    if (!proofs_may_end()) return events_.latches_left() == 0 && any_latch() && !wants_peaks();
    const bool look = steps_to_look() == 0;
    ++since_last_look_;
    return look && (events_.latches_left() > 0 ? lacks_energy() : no_peak_can_rise());
  }

  [[nodiscard]] bool wants_peaks() const { return goal_.peak_moment || goal_.peak_force; }

  /// Whether the run may end, from here to the next event, by a proof that nothing more can happen.
  [[nodiscard]] bool proofs_may_end() const {
    if (goal_.to_t_end) return false;
    return events_.latches_left() > 0 ? !wants_peaks() : any_latch() && wants_peaks();
  }

  /// Steps until the proofs are tried: they cost an evaluation and more.
  [[nodiscard]] long steps_to_look() const {
    const int interval = events_.latches_left() > 0 ? 64 : 16;
    if (!proofs_may_end()) return std::numeric_limits<long>::max();
    return interval - 1 - since_last_look_ % interval;
  }

  /// All hinges stick, under a load that stays as it is.
  [[nodiscard]] bool rests_for_ever() {
    if (system_.work().stuck < at_.bodies || !loads_are_constant(system_.wing())) return false;
    stall("every hinge sticks, and the load on them stays as it is");
    return true;
  }

  [[nodiscard]] bool lacks_energy() {
    if (stalled_) return true;
    const std::optional<T> missing = energy_missing(system_, step_.x, step_.t);
    if (missing)
      stall("energy: no hinge can reach its latch, the nearest to it lacks " +
            in_words(static_cast<double>(*missing)) + " J");
    return stalled_;
  }

  void stall(const std::string& why) {
    if (stalled_) return;
    stalled_ = true;
    why_stalled_ = why + ", from t = " + in_words(static_cast<double>(step_.t)) + " s on";
  }

  /// The status of a run that has come to its end.
  [[nodiscard]] Status ending() {
    if (events_.latches_left() == 0) return any_latch() ? Status::deployed : Status::timed_out;
    return rests_for_ever() || lacks_energy() ? Status::stalled : Status::timed_out;
  }

  [[nodiscard]] bool no_peak_can_rise() {
    const std::optional<T> energy = energy_above_rest(system_, step_.x, step_.t);
    if (!energy) return false;
    if (!bounds_ready_) bounds_.prepare(system_);
    bounds_ready_ = true;
    bounds_.bound(system_, *energy);
    for (int i = 1; i <= at_.bodies; ++i) {
      if (goal_.peak_moment && bounds_.moment[i] > moments_[i].value) return false;
      if (goal_.peak_force && bounds_.force[i] > forces_.peaks[i].value) return false;
    }
    return true;
  }

  void fail(const std::string& why) {
    end(Status::failed, why + ", at t = " + std::to_string(static_cast<double>(step_.t)) + " s");
  }

  // ---- what is told of it

  void watch_energy() {
    largest_drift_ = std::max(largest_drift_,
                              std::abs(total_energy(system_, step_.x, step_.t) - initial_energy_));
  }

  void notify() {
    if (observer_) observer_(sample_at(system_, step_.x, step_.t));
  }

  void end(Status status, std::string reason) {
    close_phase();
    ended_ = true;
    Outcome& out = outcome_;
    out.status = status;
    out.reason = std::move(reason);
    out.phases = std::move(phases_);
    out.t_end = static_cast<double>(step_.t);
    out.latches = std::move(latches_);
    if (goal_.peak_moment) out.peak_moment = in_scene_order(system_.wing(), moments_);
    if (goal_.peak_force) out.peak_force = in_scene_order(system_.wing(), forces_.peaks);
    out.work = {steps_, rejected_, system_.work().evaluations};
    out.final = configuration_at(system_, step_.x, step_.t);
    out.energy = {initial_energy_, total_energy(system_, step_.x, step_.t), largest_drift_};
  }

  /// Four significant digits.
  [[nodiscard]] static std::string in_words(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.4g", value);
    return text.data();
  }

  [[nodiscard]] static bool finite(const State<T>& x) {
    for (const T& v : x)
      if (!is_finite(v)) return false;
    return true;
  }

  AnySystem& system_;
  const Layout at_;
  const Integration& how_;
  const Goal& goal_;
  const Observer& observer_;
  Events<T, AnySystem> events_;
  MethodChoice choice_;
  SpectralRadius<T> radius_;
  Steppers<T> steppers_;
  Verdict verdict_{0, 1}; ///< of the step last accepted
  Step<T> step_;
  Stage stage_ = Stage::step;
  Try try_{};
  bool last_ = false, ended_ = false;
  std::optional<Due<T>> due_;              ///< the event that ends the step
  int correction_ = 0;                     ///< of its instant
  T longest_ = T(0);                       ///< the step in which it was found
  int due_moment_ = 0;                     ///< the hinge whose moment is looked at
  std::optional<DoubtfulMoment<T>> doubt_; ///< of it
  Outcome outcome_;
  State<T> scratch_, dscratch_;
  T h_ = T(0); ///< of the next step, s; negative: to be chosen
  std::vector<PeakOf<T>> moments_;
  ForcePeaks<T, AnySystem> forces_;
  bool probed_ = false; ///< the method has made steps inside the one accepted
  PeakBounds<T> bounds_;
  bool bounds_ready_ = false;
  Conserved<T> kept_{};
  std::vector<LatchEvent> latches_;
  std::vector<Phase> phases_;
  bool stalled_ = false; ///< no hinge can reach its latch any more
  std::string why_stalled_;
  long tried_ = 0, steps_ = 0, rejected_ = 0, since_last_look_ = 0;
  double initial_energy_ = 0, largest_drift_ = 0;
};

} // namespace wingspread
