/// One run from release to its end: steps, engagements, peaks, and the reasons to stop.
#pragma once

#include "core/deployment.hpp"
#include "core/methods.hpp"
#include "core/peaks.hpp"
#include "core/settled.hpp"
#include "core/step_control.hpp"

#include <string>
#include <utility>

namespace wingspread {

/// Integrates one wing with one method. Storage is made before the first step; a step allocates
/// nothing.
template <class T, class Topology, BaseMotion M, class Method> class Integrator {
public:
  using AnySystem = System<T, Topology, M>;

  Integrator(AnySystem& system, const Integration& how, const Goal& goal, const Observer& observer)
      : system_(system), at_(system.layout()), how_(how), goal_(goal), observer_(observer),
        control_(Method::error_order) {
    for (State<T>* x :
         {&step_.x, &step_.dxdt, &step_.x1, &step_.dxdt1, &error_, &scratch_, &dscratch_})
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
      if (!advance())
        return fail(
            "the step size fell below round-off: the equations are too stiff or not finite here");
    }
    return report(latches_left_ == 0 && any_latch() ? Status::deployed : Status::timed_out, "");
  }

private:
  // ---- the run, step by step

  void start() {
    step_.t = T(0);
    system_.want_forces(goal_.peak_force);
    system_.start(step_.x);
    system_(step_.x, step_.dxdt, step_.t);
    if (goal_.peak_force) forces_.start(system_, step_.t);
    observe_moments();
    if constexpr (M == BaseMotion::free) kept_ = conserved(system_, step_.x, step_.t);
    initial_energy_ = energy(step_.x, step_.t);
    notify();
    choose_first_step();
  }

  /// Accepts one step, with what happens in it. @return false if no step can be accepted
  [[nodiscard]] bool advance() {
    const T limit = T(how_.t_end) - step_.t;
    const bool last = h_ >= limit * T(1 - 1e-12);
    step_.h = last ? limit : h_;
    if (!(step_.h > T(4 * epsilon_of<T>) * step_.t)) return false;
    const double error = attempt(step_.h);
    if (!(error <= 1)) {
      ++rejected_;
      h_ = step_.h * T(control_.rejected(error));
      return true;
    }
    const double factor = control_.accepted(error);
    if (!last || factor < 1) h_ = step_.h * T(factor);
    const std::optional<Due> due = first_engagement();
    if (due && !step_to_engagement(*due)) return true; // refused on the way: h_ has been cut
    if constexpr (M == BaseMotion::free) restore_momentum();
    finish_step(last && !due, due ? due->hinge : 0);
    return true;
  }

  /// One try of the method from step_.x over h; its error in units of the tolerance.
  [[nodiscard]] double attempt(const T& h) {
    ++tried_;
    method_.step(system_, step_.x, step_.dxdt, step_.t, h, step_.x1, step_.dxdt1, error_);
    return strictness() *
           scaled_error(step_.x, step_.x1, step_.dxdt1, error_, how_.rtol, how_.atol);
  }

  /// Up to the first latch the tolerance is this much tighter than asked: the phase takes a few per
  /// cent of a run's steps, and what is lost in it shifts all that follows.
  [[nodiscard]] double strictness() const { return latches_.empty() ? 32 : 1; }

  void finish_step(bool reaches_end, int due) {
    ++steps_;
    if (goal_.peak_moment)
      for (int i = 1; i <= at_.bodies; ++i) raise_moment(moments_[i], system_, step_, i);
    if (goal_.peak_force) forces_.over_step(system_, step_, scratch_, dscratch_);
    step_.t = reaches_end ? T(how_.t_end) : T(step_.t + step_.h);
    if (T(how_.t_end) - step_.t <= T(8 * epsilon_of<T>) * step_.t) step_.t = T(how_.t_end);
    std::swap(step_.x, step_.x1);
    std::swap(step_.dxdt, step_.dxdt1);
    if (goal_.audit && latches_.empty()) watch_energy();
    notify();
    engage_those_there(due);
  }

  // ---- engagement

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

  /// An engagement inside the step.
  struct Due {
    int hinge;
    T s; ///< fraction of the step
  };

  /// The earliest one, by the interpolant, whose word on whether it happens is final.
  [[nodiscard]] std::optional<Due> first_engagement() const {
    std::optional<Due> first;
    for (int i = 1; i <= at_.bodies; ++i) {
      if (!waits(i)) continue;
      const HingeTerms<T>& hinge = system_.wing().hinges[i];
      Quintic<T> angle = step_.coordinate(at_.angle(i), at_.freedoms());
      for (T& c : angle) c = hinge.sense * (c - hinge.latched);
      const std::optional<T> s = first_nonnegative(angle);
      if (s && (!first || *s < first->s)) first = Due{i, *s};
    }
    return first;
  }

  /// Replaces the step by one that ends at the engagement, so that its state has the method's
  /// accuracy and not the interpolant's, then corrects the instant by Newton's method with real
  /// steps. A hinge that only grazes its latched angle has no useful Newton step: there the
  /// interpolant's instant stands.
  [[nodiscard]] bool step_to_engagement(const Due& due) {
    const T longest = step_.h, shortest = T(8 * epsilon_of<T>) * larger(step_.t, longest);
    T h = due.s * longest;
    for (int correction = 0;; ++correction) {
      h = smaller(larger(h, shortest), longest);
      const double error = attempt(h);
      if (!(error <= 1)) {
        ++rejected_;
        h_ = h * T(control_.rejected(error));
        return false;
      }
      const T rate = gap_rate(step_.x1, due.hinge), late = gap(step_.x1, due.hinge) / rate;
      const T size = larger(late, T(-late));
      if (!(rate > T(0)) || !(size < T(1e-2) * h) || correction == 3) break;
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

  /// Engages the hinge that was due (0: none), and with it every waiting one that stands at its
  /// latched angle, all at this one instant.
  void engage_those_there(int due) {
    const T instant = T(4096 * epsilon_of<T>) * larger(step_.t, T(1e-3)); // not to be told apart
    bool any = false;
    for (int i = 1; i <= at_.bodies; ++i) {
      if (!waits(i)) continue;
      const T soon = gap(step_.x, i) + instant * larger(gap_rate(step_.x, i), T(0));
      if (i != due && !(soon >= T(0))) continue;
      system_.engage(i);
      --latches_left_;
      record_latch(i);
      any = true;
    }
    if (any) restart();
  }

  /// The right-hand side has changed: evaluates it anew, at t⁺.
  void restart() {
    system_(step_.x, step_.dxdt, step_.t);
    observe_moments();
    if (goal_.peak_force) forces_.observe(system_, step_.t);
    notify();
    control_.restart();
    choose_first_step();
  }

  void record_latch(int i) {
    LatchEvent event{system_.wing().hinge_of[i], static_cast<double>(step_.t),
                     std::vector<double>(at_.bodies)};
    for (int j = 1; j <= at_.bodies; ++j)
      event.rates[system_.wing().hinge_of[j]] = static_cast<double>(step_.x[at_.rate(j)]);
    latches_.push_back(std::move(event));
  }

  void choose_first_step() {
    const T rest = T(how_.t_end) - step_.t;
    if (!(rest > T(0))) return;
    h_ = first_step(system_, step_.x, step_.dxdt, step_.t, Method::order, how_.rtol / strictness(),
                    how_.atol / strictness(), rest, scratch_, dscratch_);
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
    if (goal_.to_t_end || latches_left_ > 0 || !any_latch()) return false;
    if (!goal_.peak_moment && !goal_.peak_force) return true;
    constexpr int interval =
        16; // steps between two looks at the bounds: they cost about an evaluation
    return ++since_last_look_ % interval == 0 && no_peak_can_rise();
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

  void observe_moments() {
    using std::abs;
    for (int i = 1; i <= at_.bodies; ++i)
      moments_[i].raise(T(abs(system_.moment(step_.x, i))), step_.t);
  }

  [[nodiscard]] double energy(const State<T>& x, const T& t) {
    return static_cast<double>(T(kinetic_energy(system_, x, t) + potential_energy(system_, x)));
  }

  void watch_energy() {
    largest_drift_ = std::max(largest_drift_, std::abs(energy(step_.x, step_.t) - initial_energy_));
  }

  void notify() {
    if (!observer_) return;
    Sample sample;
    sample.t = static_cast<double>(step_.t);
    sample.angles.resize(at_.bodies), sample.rates.resize(at_.bodies),
        sample.moments.resize(at_.bodies);
    for (int i = 1; i <= at_.bodies; ++i) {
      const int hinge = system_.wing().hinge_of[i];
      sample.angles[hinge] = static_cast<double>(step_.x[at_.angle(i)]);
      sample.rates[hinge] = static_cast<double>(step_.x[at_.rate(i)]);
      sample.moments[hinge] = static_cast<double>(system_.moment(step_.x, i));
    }
    sample.kinetic = static_cast<double>(kinetic_energy(system_, step_.x, step_.t));
    sample.potential = static_cast<double>(potential_energy(system_, step_.x));
    observer_(sample);
  }

  [[nodiscard]] Configuration configuration() {
    Configuration c;
    c.angles.resize(at_.bodies), c.rates.resize(at_.bodies);
    for (int i = 1; i <= at_.bodies; ++i) {
      c.angles[system_.wing().hinge_of[i]] = static_cast<double>(step_.x[at_.angle(i)]);
      c.rates[system_.wing().hinge_of[i]] = static_cast<double>(step_.x[at_.rate(i)]);
    }
    system_.place_all(step_.x, step_.t);
    c.base_angle = static_cast<double>(system_.work().frames[0].angle);
    c.base_rate = static_cast<double>(system_.work().frames[0].rate);
    if constexpr (M == BaseMotion::free) {
      const int v = at_.freedoms();
      c.base_position = {static_cast<double>(step_.x[0]), static_cast<double>(step_.x[1])};
      c.base_velocity = {static_cast<double>(step_.x[v]), static_cast<double>(step_.x[v + 1])};
    }
    return c;
  }

  [[nodiscard]] std::vector<Peak> in_scene_order(const std::vector<PeakOf<T>>& peaks) const {
    std::vector<Peak> out(at_.bodies);
    for (int i = 1; i <= at_.bodies; ++i)
      out[system_.wing().hinge_of[i]] = {static_cast<double>(peaks[i].value),
                                         static_cast<double>(peaks[i].time)};
    return out;
  }

  [[nodiscard]] Outcome report(Status status, std::string reason) {
    Outcome out;
    out.status = status;
    out.reason = std::move(reason);
    out.t_end = static_cast<double>(step_.t);
    out.latches = std::move(latches_);
    if (goal_.peak_moment) out.peak_moment = in_scene_order(moments_);
    if (goal_.peak_force) out.peak_force = in_scene_order(forces_.peaks);
    out.work = {steps_, rejected_, system_.work().evaluations};
    out.final = configuration();
    out.energy = {initial_energy_, energy(step_.x, step_.t), largest_drift_};
    return out;
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
  Method method_;
  StepControl control_;
  Step<T> step_;
  State<T> error_, scratch_, dscratch_;
  T h_ = T(0);
  std::vector<PeakOf<T>> moments_;
  ForcePeaks<T, AnySystem> forces_;
  Bounds<T> bounds_;
  Conserved<T> kept_{};
  std::vector<LatchEvent> latches_;
  int latches_left_ = 0;
  long tried_ = 0, steps_ = 0, rejected_ = 0, since_last_look_ = 0;
  double initial_energy_ = 0, largest_drift_ = 0;
};

} // namespace wingspread
