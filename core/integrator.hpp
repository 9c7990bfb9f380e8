/// One run from release to its end: steps, events, peaks, and the reasons to stop.
#pragma once

#include "core/contact.hpp"
#include "core/method_choice.hpp"
#include "core/record.hpp"
#include "core/settled.hpp"
#include "core/stall.hpp"
#include "core/steppers.hpp"

#include <array>
#include <cstdio>
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
        choice_(how.method, how.rtol) {
    for (State<T>* x : {&step_.x, &step_.dxdt, &step_.x1, &step_.dxdt1, &scratch_, &dscratch_})
      x->assign(at_.size(), T(0));
    moments_.assign(at_.bodies + 1, {});
    for (int i = 1; i <= at_.bodies; ++i) latches_left_ += system_.wing().hinges[i].has_latch;
  }

  [[nodiscard]] Outcome run() {
    start();
    if (!finite(step_.dxdt)) return fail("the accelerations are not finite at the start");
    while (!finished()) {
      if (tried_ >= how_.max_steps)
        return fail("the limit of " + std::to_string(how_.max_steps) + " steps was reached");
      if (!advance()) return fail(why_no_step_);
    }
    const Status status = ending();
    return report(status, status == Status::stalled ? why_stalled_ : "");
  }

private:
  struct Due;

  // ---- the run, step by step

  void start() {
    step_.t = T(0);
    system_.want_forces(goal_.peak_force);
    system_.start(step_.x);
    if constexpr (M == BaseMotion::free) kept_ = conserved(system_, step_.x, step_.t);
    initial_energy_ = total_energy(system_, step_.x, step_.t);
    if (goal_.peak_force) forces_.start(at_.bodies);
    restart(0);
  }

  /// Accepts one step, with what happens in it. @return false if no step can be accepted
  [[nodiscard]] bool advance() {
    const T limit = T(how_.t_end) - step_.t;
    const T wanted = smaller(h_, longest_step());
    const bool last = wanted >= limit * T(1 - 1e-12);
    step_.h = last ? limit : wanted;
    if (!(step_.h > T(4 * epsilon_of<T>) * step_.t)) {
      why_no_step_ =
          "the step size fell below round-off: the equations are too stiff or not finite here";
      return false;
    }
    const Verdict verdict = attempt(step_.h);
    if (!verdict.accepted()) return refuse(verdict);
    verdict_ = verdict;
    h_ = last ? larger(h_, T(step_.h * T(verdict.factor))) : step_.h * T(verdict.factor);
    if (last && verdict.factor < 1) h_ = step_.h * T(verdict.factor);
    const std::optional<Due> due = first_event();
    if (due && !step_to_event(*due)) return why_no_step_.empty();
    if constexpr (M == BaseMotion::free) restore_momentum();
    finish_step(last && !due, due);
    return angles_are_known();
  }

  /// A double cannot tell the sine of an angle this large to the accuracy that is promised.
  [[nodiscard]] bool angles_are_known() {
    using std::abs;
    constexpr double largest = 1e8; // rad
    for (int i = 1; i <= at_.bodies; ++i)
      if (!(abs(step_.x[at_.angle(i)]) < T(largest))) {
        why_no_step_ = "a hinge has turned past 1e8 rad";
        return false;
      }
    return true;
  }

  /// One try of the method from step_.x over h.
  [[nodiscard]] Verdict attempt(const T& h) {
    ++tried_;
    const Method method = choice_.active();
    step_.h = h;
    Verdict verdict = steppers_.with(method, [&](auto& stepper) {
      return stepper.attempt(system_, Start<T>{step_.t, step_.x, step_.dxdt}, h, step_.x1,
                             step_.dxdt1);
    });
    if (verdict.accepted() && takes_long_steps(method)) judge_interpolant(method, verdict);
    return verdict;
  }

  /// What else a step must satisfy where the method takes long ones: a dense output that shows what
  /// happens inside.
  void judge_interpolant(Method method, Verdict& verdict) const {
    // whether a hinge that grazes its latch reaches it is the interpolant's word
    const double finer = method == Method::bulirsch_stoer ? 10 : 1;
    const double rough = finer * roughness(at_, step_.h, step_.dxdt, step_.dxdt1, how_.atol);
    if (rough > 1)
      verdict = {2, std::max(0.2, 0.8 * std::pow(rough, -1.0 / 3))};
    else if (rough > 0.1)
      verdict.factor = std::min(verdict.factor, 0.9 * std::pow(rough, -1.0 / 3));
    if (method != Method::fehlberg78 || !at_.smoothed) return;
    const double quadrature = quadrature_error<T>(system_, step_, tolerance());
    if (quadrature > 1) verdict = {quadrature, std::max(0.2, 0.8 * std::pow(quadrature, -1.0 / 6))};
  }

  /// Cuts the step after a rejection. @return false where the method cannot
  [[nodiscard]] bool refuse(const Verdict& verdict) {
    ++rejected_;
    const bool fixed = steppers_.with(choice_.active(), [](auto& stepper) {
      stepper.rejected();
      return std::decay_t<decltype(stepper)>::fixed_step;
    });
    if (fixed) {
      why_no_step_ =
          std::isfinite(verdict.error)
              ? "the fixed step of " + in_words(how_.step) + " s misses the tolerance " +
                    in_words(verdict.error) + "-fold"
              : "the fixed step of " + in_words(how_.step) + " s gives numbers that are not finite";
      return false;
    }
    h_ = step_.h * T(verdict.factor);
    return true;
  }

  /// Up to the first latch the tolerance is this much tighter than asked: the phase takes a few per
  /// cent of a run's steps, and what is lost in it shifts all that follows.
  [[nodiscard]] double strictness() const {
    return latches_.empty() && choice_.active() != Method::runge_kutta4 ? 32 : 1;
  }
  [[nodiscard]] Tolerance tolerance() const {
    return {how_.rtol / strictness(), how_.atol / strictness()};
  }

  /// While hinges stick nothing need change in the state: then the base's motion limits the step,
  /// so that the load on them is sampled.
  [[nodiscard]] T longest_step() const {
    const T rest(how_.t_end);
    if (M != BaseMotion::prescribed || system_.work().stuck == 0) return rest;
    using std::abs, std::sqrt;
    const BaseTerms<T>& base = system_.wing().base;
    constexpr double turn = 0.1; // rad
    const T rate = abs(base.rate + base.angular_acceleration * step_.t);
    const T spin = larger(rate, T(sqrt(T(turn) * abs(base.angular_acceleration))));
    return spin > T(0) ? smaller(rest, T(T(turn) / spin)) : rest;
  }

  void finish_step(bool reaches_end, const std::optional<Due>& due) {
    ++steps_;
    find_peaks();
    steppers_.with(choice_.active(), [&](auto& stepper) { stepper.accepted(verdict_); });
    step_.t = reaches_end ? T(how_.t_end) : T(step_.t + step_.h);
    if (T(how_.t_end) - step_.t <= T(8 * epsilon_of<T>) * step_.t) step_.t = T(how_.t_end);
    std::swap(step_.x, step_.x1);
    std::swap(step_.dxdt, step_.dxdt1);
    if (goal_.audit && latches_.empty()) watch_energy();
    if (system_.work().stuck > 0) {
      system_(step_.x, dscratch_, step_.t);
      holding_.observe(system_, step_.x);
    }
    notify();
    if (happens(due)) return;
    if (choice_.after_step(static_cast<double>(step_.h), system_.work().evaluations))
      change_method();
    if (choice_.wants_radius()) choice_.set_radius(radius_.estimate(system_, step_.x, step_.t));
  }

  // ---- peaks

  void find_peaks() {
    probed_ = false;
    const auto probe = [this](const T& s) { return step_inside(s); };
    const auto hold = [this](const T& s) -> const State<T>& {
      step_.interpolate(at_, s, scratch_);
      system_(scratch_, dscratch_, step_.t + s * step_.h);
      return scratch_;
    };
    if (goal_.peak_force) forces_.over_step(system_, step_, scratch_, dscratch_, probe);
    for (int i = 1; goal_.peak_moment && i <= at_.bodies; ++i) {
      if (system_.sticks(i))
        raise_held_moment(moments_[i], system_, step_, i, hold);
      else
        raise_moment(moments_[i], system_, step_, i, probe);
    }
    if (probed_ && choice_.active() == Method::adams_bashforth_moulton)
      (void)step_inside(T(1)); // what it will keep must be the step accepted
  }

  struct Inside {
    const State<T>&x, &dxdt;
  };

  /// The state at t + s·h by a step of the method; the last evaluation is there.
  Inside step_inside(const T& s) {
    probed_ = true;
    steppers_.with(choice_.active(), [&](auto& stepper) {
      return stepper.attempt(system_, Start<T>{step_.t, step_.x, step_.dxdt}, T(s * step_.h),
                             scratch_, dscratch_);
    });
    return {scratch_, dscratch_};
  }

  void observe_moments() {
    using std::abs;
    for (int i = 1; i <= at_.bodies; ++i)
      moments_[i].raise(T(abs(system_.moment(step_.x, i))), step_.t);
  }

  // ---- events

  enum class Event { latch, rest, release };

  /// An event inside the step.
  struct Due {
    Event event;
    int hinge;
    T s;     ///< fraction of the step
    T slope; ///< of a release's indicator, N·m/s
  };

  /// Signed distance past the latched angle; engagement is where it reaches 0 from below.
  [[nodiscard]] T gap(const State<T>& x, int i) const {
    const HingeTerms<T>& hinge = system_.wing().hinges[i];
    return hinge.sense * (x[at_.angle(i)] - hinge.latched);
  }
  [[nodiscard]] T gap_rate(const State<T>& x, int i) const {
    return system_.wing().hinges[i].sense * x[at_.rate(i)];
  }
  [[nodiscard]] bool waits(int i) const {
    return system_.wing().hinges[i].has_latch && !system_.work().engaged[i];
  }

  /// The earliest one, by the interpolant, whose word on whether it happens is final.
  [[nodiscard]] std::optional<Due> first_event() {
    std::optional<Due> first;
    const auto offer = [&](Event event, int i, const std::optional<T>& s, const T& slope) {
      if (s && (!first || *s < first->s)) first = Due{event, i, *s, slope};
    };
    for (int i = 1; i <= at_.bodies; ++i) {
      if (waits(i) && !system_.sticks(i)) offer(Event::latch, i, first_engagement(i), T(0));
      if (sliding_sense(system_, i) != 0)
        offer(Event::rest, i, first_rest(system_, step_, i), T(0));
    }
    if (system_.work().stuck > 0) {
      const auto release = holding_.first_release(system_, step_, scratch_, dscratch_);
      if (release) offer(Event::release, release->hinge, release->s, release->slope);
    }
    return first;
  }

  [[nodiscard]] std::optional<T> first_engagement(int i) const {
    const HingeTerms<T>& hinge = system_.wing().hinges[i];
    Quintic<T> angle = step_.coordinate(at_.angle(i), at_.freedoms());
    for (T& c : angle) c = hinge.sense * (c - hinge.latched);
    return first_nonnegative(angle);
  }

  /// What reaches 0 from below at the event, and its rate, at the end of the step just tried.
  struct Indicator {
    T value, slope;
  };
  [[nodiscard]] Indicator indicator(const Due& due) const {
    const int i = due.hinge;
    switch (due.event) {
    case Event::latch:
      return {gap(step_.x1, i), gap_rate(step_.x1, i)};
    case Event::rest: {
      const T against(-sliding_sense(system_, i));
      return {against * step_.x1[at_.rate(i)], against * step_.dxdt1[at_.rate(i)]};
    }
    case Event::release:
      break;
    }
    return {Holding<T>::excess(system_, step_.x1, i), due.slope};
  }

  /// Replaces the step by one that ends at the event, so that its state has the method's accuracy
  /// and not the interpolant's, then corrects the instant by Newton's method with real steps. A
  /// hinge that only grazes its latched angle has no useful Newton step: there the interpolant's
  /// instant stands.
  [[nodiscard]] bool step_to_event(const Due& due) {
    const T longest = step_.h, shortest = T(8 * epsilon_of<T>) * larger(step_.t, longest);
    T h = due.s * longest;
    for (int correction = 0;; ++correction) {
      h = smaller(larger(h, shortest), longest);
      const Verdict verdict = attempt(h);
      if (!verdict.accepted()) {
        (void)refuse(verdict);
        return false;
      }
      verdict_ = verdict;
      const Indicator at = indicator(due);
      const T late = at.value / at.slope, size = larger(late, T(-late));
      if (!(at.slope > T(0)) || !(size < T(1e-2) * h) || correction == 3) break;
      if (!(size > T(1e-7) * h)) { // the rest is linear: its square is below round-off
        shift(-late);
        h = h - late;
        break;
      }
      h = h - late;
    }
    step_.h = smaller(h, longest);
    return true;
  }

  /// Moves the step's end by dt, to first order in x.
  void shift(const T& dt) {
    for (std::size_t k = 0; k < step_.x1.size(); ++k)
      step_.x1[k] = fused(dt, step_.dxdt1[k], step_.x1[k]);
  }

  /// Whether two instants this far apart are one.
  [[nodiscard]] T one_instant() const { return T(4096 * epsilon_of<T>) * step_.t; }

  /// At a step's end: what the event that was due, and others at the same instant, bring about.
  /// @return whether anything happened
  [[nodiscard]] bool happens(const std::optional<Due>& due) {
    const int latching = due && due->event == Event::latch ? due->hinge : 0;
    const int resting = due && due->event == Event::rest ? due->hinge : 0;
    const bool engaged = engage_those_there(latching), rested = rest_those_there(resting);
    if (!due && !engaged && !rested) return false;
    restart(due && due->event == Event::release ? due->hinge : 0);
    return true;
  }

  /// Engages the hinge that was due (0: none), and with it every waiting one that stands at its
  /// latched angle, all at this one instant.
  bool engage_those_there(int due) {
    const T instant = one_instant();
    bool any = false;
    for (int i = 1; i <= at_.bodies; ++i) {
      if (!waits(i) || system_.sticks(i)) continue;
      const T soon = gap(step_.x, i) + instant * larger(gap_rate(step_.x, i), T(0));
      if (i != due && !(soon >= T(0))) continue;
      system_.engage(i);
      --latches_left_;
      latches_.push_back(latch_event(system_.wing(), at_, step_.x, step_.t, i));
      any = true;
    }
    return any;
  }

  /// The same for hinges that slide, and come to rest.
  bool rest_those_there(int due) {
    const T instant = one_instant();
    bool any = false;
    for (int i = 1; i <= at_.bodies; ++i) {
      const T against(-sliding_sense(system_, i));
      if (against == T(0)) continue;
      const T rate = against * step_.x[at_.rate(i)], slope = against * step_.dxdt[at_.rate(i)];
      const bool there = rate > T(0) || (slope > T(0) && rate + instant * slope >= T(0));
      if (i != due && !there) continue;
      step_.x[at_.rate(i)] = T(0);
      any = true;
    }
    return any;
  }

  /// The right-hand side has changed, or is new: evaluates it, at t⁺.
  void restart(int let_go) {
    if (system_.wing().can_stick)
      settle_contacts(system_, step_.x, step_.dxdt, step_.t, let_go);
    else
      system_(step_.x, step_.dxdt, step_.t);
    observe_moments();
    if (goal_.peak_force) forces_.observe(system_, step_.t);
    if (system_.work().stuck > 0) holding_.observe(system_, step_.x);
    notify();
    choice_.restart(choice_.automatic() ? radius_.estimate(system_, step_.x, step_.t) : 0);
    begin_phase();
    choose_first_step();
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
    steppers_.with(choice_.active(), [&](auto& stepper) { stepper.restart(tolerance()); });
  }

  void close_phase() {
    if (phases_.empty()) return;
    phases_.back().to = static_cast<double>(step_.t);
    phases_.back().steps += steps_;
  }

  void choose_first_step() {
    const T rest = T(how_.t_end) - step_.t;
    if (!(rest > T(0))) return;
    h_ = steppers_.with(choice_.active(), [&](auto& stepper) {
      using Stepper = std::decay_t<decltype(stepper)>;
      if (Stepper::fixed_step) return T(2 * how_.step); // it takes two at a time
      return first_step(system_, step_.x, step_.dxdt, step_.t, Stepper::order, tolerance().rtol,
                        tolerance().atol, smaller(rest, a_radian()), scratch_, dscratch_);
    });
  }

  /// A time in which no hinge turns by much more than a radian: where a motion is a parabola no
  /// error would keep the first step from leaping over it.
  [[nodiscard]] T a_radian() const {
    using std::abs, std::sqrt;
    T longest(how_.t_end);
    for (int i = 1; i <= at_.bodies; ++i) {
      const T rate = abs(step_.dxdt[at_.angle(i)]), acceleration = abs(step_.dxdt[at_.rate(i)]);
      if (rate > T(0)) longest = smaller(longest, T(T(1) / rate));
      if (acceleration > T(0)) longest = smaller(longest, T(sqrt(T(2) / acceleration)));
    }
    return longest;
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
    if (rests_for_ever() && (latches_left_ > 0 || any_latch())) return true;
    constexpr int interval = 16; // steps between two looks at the proofs: they cost an evaluation
    const bool look = ++since_last_look_ % interval == 0;
    if (latches_left_ > 0) return look && lacks_energy() && !goal_.peak_moment && !goal_.peak_force;
    if (!any_latch()) return false;
    if (!goal_.peak_moment && !goal_.peak_force) return true;
    return look && no_peak_can_rise();
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
    if (latches_left_ == 0) return any_latch() ? Status::deployed : Status::timed_out;
    return rests_for_ever() || lacks_energy() ? Status::stalled : Status::timed_out;
  }

  [[nodiscard]] bool no_peak_can_rise() {
    const std::optional<T> energy = energy_above_rest(system_, step_.x, step_.t);
    if (!energy) return false;
    bound_peaks(system_, *energy, bounds_);
    for (int i = 1; i <= at_.bodies; ++i) {
      if (goal_.peak_moment && bounds_.moment[i] > moments_[i].value) return false;
      if (goal_.peak_force && bounds_.force[i] > forces_.peaks[i].value) return false;
    }
    return true;
  }

  [[nodiscard]] Outcome fail(const std::string& why) {
    return report(Status::failed,
                  why + ", at t = " + std::to_string(static_cast<double>(step_.t)) + " s");
  }

  // ---- what is told of it

  void watch_energy() {
    largest_drift_ = std::max(largest_drift_,
                              std::abs(total_energy(system_, step_.x, step_.t) - initial_energy_));
  }

  void notify() {
    if (observer_) observer_(sample_at(system_, step_.x, step_.t));
  }

  [[nodiscard]] Outcome report(Status status, std::string reason) {
    close_phase();
    Outcome out;
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
    return out;
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
  MethodChoice choice_;
  SpectralRadius<T> radius_;
  Steppers<T> steppers_;
  Verdict verdict_{0, 1}; ///< of the step last accepted
  Step<T> step_;
  State<T> scratch_, dscratch_;
  T h_ = T(0);
  std::vector<PeakOf<T>> moments_;
  ForcePeaks<T, AnySystem> forces_;
  bool probed_ = false; ///< the method has made steps inside the one accepted
  Holding<T> holding_;
  Bounds<T> bounds_;
  Conserved<T> kept_{};
  std::vector<LatchEvent> latches_;
  std::vector<Phase> phases_;
  int latches_left_ = 0;
  bool stalled_ = false; ///< no hinge can reach its latch any more
  std::string why_stalled_, why_no_step_;
  long tried_ = 0, steps_ = 0, rejected_ = 0, since_last_look_ = 0;
  double initial_energy_ = 0, largest_drift_ = 0;
};

} // namespace wingspread
