/// One run, from the wing's release to its end.
///
/// | where is …                           | file                                                        |
/// |--------------------------------------|-------------------------------------------------------------|
/// | the loop                             | `run`, `make_step` below: makes a step, judges it, plans on |
/// | the next step's size and method      | stepping.hpp                                                |
/// | a step that ends at an event         | landing.hpp                                                 |
/// | the instant of an event              | `judge_step` below: cut_at_event; events/events.hpp         |
/// | where a latch engages                | `finish_step` below: apply_events; events/latches.hpp       |
/// | a peak inside a step                 | peak_search.hpp, and the room peaks/                        |
/// | an early end, and its proof          | ending.hpp, and the room proofs/                            |
/// | the record of the run                | diary.hpp                                                   |
#pragma once

#include "core/events/events.hpp"
#include "core/mechanics/energy.hpp"
#include "core/run/diary.hpp"
#include "core/run/ending.hpp"
#include "core/run/landing.hpp"
#include "core/run/lane_protocol.hpp"
#include "core/run/peak_search.hpp"
#include "core/run/stepping.hpp"
#include "core/run/underway.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace wingspread {

/// Integrates one wing. The run asks for a step and takes the verdict on it; `make_step`, or the lane of an
/// engine of packs, makes the step. Storage is made before the first step: a step of the core's own
/// methods allocates nothing.
template <class T, class Topology, BaseMotion M> class Integrator {
public:
  using AnySystem = System<T, Topology, M>;

  Integrator(AnySystem& system, const Integration& how, const Goal& goal, const Observer& observer)
      : run_(system, how, goal), events_(system), diary_(run_, observer), stepping_(run_),
        landing_(run_, events_), peaks_(run_), ending_(run_, events_, diary_, peaks_) {}
  Integrator(const Integrator&) = delete; // its parts refer to each other
  Integrator& operator=(const Integrator&) = delete;

  [[nodiscard]] Outcome run() {
    begin();
    while (!ended_) make_step();
    return outcome();
  }

  /// Begins a run with the present parameters of the system.
  void begin() {
    start();
    if (all_finite(run_.step.dxdt))
      end_or_plan();
    else
      fail("the accelerations are not finite at the start");
  }

  /// Whether the run is over. If not, a step is asked for.
  [[nodiscard]] bool ended() const { return ended_; }
  /// @pre ended()
  [[nodiscard]] Outcome&& outcome() { return diary_.outcome(); }

  /// Makes the step that is asked for, judges it, and asks for the next one.
  void make_step() {
    const StepVerdict verdict = asked_.stage == Stage::doubt
                                    ? stepping_.attempt_inside(asked_.h, *asked_.x1, *asked_.dxdt1)
                                    : stepping_.attempt(asked_.h, *asked_.x1, *asked_.dxdt1);
    if (asked_.stage == Stage::step) stepping_.fit(asked_.h);
    judge(asks_for_whole_step() ? stepping_.judged(verdict) : verdict);
  }

  // ---- the same where a lane of an engine makes the steps: see lane_protocol.hpp

  /// Whether a lane of an engine for this method can go on from here.
  [[nodiscard]] bool fits_lane(Method method) const {
    return stepping_.method() == method && run_.system.work().locked < run_.at.bodies &&
           !peaks_.watches_elastic_hold();
  }

  /// @pre fits_lane(the engine's method)
  [[nodiscard]] LaneTask lane_task() {
    const Goal& goal = run_.goal;
    const bool holds = run_.system.work().locked > 0;
    return {.step = run_.step,
            .h = asked_.h,
            .work = run_.system.work(),
            .tolerance = stepping_.tolerance(),
            .dense_tolerance = run_.how.atol,
            .moments = goal.peak_moment ? peaks_.moments().data() : nullptr,
            .forces = goal.peak_force ? peaks_.forces().data() : nullptr,
            .holds = peaks_.holds().empty() ? nullptr : peaks_.holds().data(),
            .force_before = goal.peak_force ? peaks_.force_before().data() : nullptr,
            .overtravel = peaks_.overtravel().data(),
            .motor_energy = peaks_.motor_energy().empty() ? nullptr : peaks_.motor_energy().data(),
            .held_before = holds ? run_.held_before.data() : nullptr,
            .excess_before = holds ? events_.excess_before().data() : nullptr,
            .base = peaks_.base(),
            .end_of_stretch = static_cast<double>(stepping_.end_of_stretch()),
            .most_trial_steps = asks_for_plain_step() ? stepping_.tries_left() : 0,
            .most_steps = diary_.is_watched() // it takes samples inside every step
                              ? 0
                              : std::min(stepping_.steps_to_radius(), ending_.steps_to_attempt()),
            .evaluations = stepping_.evaluations(),
            .history = stepping_.history()};
  }

  /// For the lane to fill: refers to this run's storage.
  [[nodiscard]] LaneResult empty_lane_result() {
    return {run_.step,
            peaks_.force_before(),
            peaks_.moments(),
            peaks_.forces(),
            peaks_.holds(),
            peaks_.overtravel(),
            peaks_.motor_energy(),
            *asked_.x1,
            *asked_.dxdt1,
            run_.system.writable_workspace().forces,
            run_.held_before,
            events_.excess_before(),
            run_.system.writable_workspace().holding,
            peaks_.base(),
            asks_for_whole_step() ? &peaks_.moments_rise() : nullptr,
            asks_for_whole_step() ? &peaks_.holds_rise() : nullptr,
            may_happen_};
  }

  /// Whether the step asked for is part of one under way: to an event, or to a peak in doubt.
  [[nodiscard]] bool is_inside_a_step() const { return asked_.stage != Stage::step; }

  /// Counts the lane's steps, and takes its last trial step for the one asked for.
  /// @param result empty_lane_result() of this run, filled by its lane
  void resume(const LaneResult& result) {
    run_.system.writable_workspace().evaluations += result.evaluations;
    run_.searched += result.searched;
    run_.system.set_commands(T(run_.step.t + result.h)); // the lane's last evaluation
    if (result.trial_steps > 0) {
      const long steps = stepping_.resume(result);
      ending_.count_lane_steps(steps);
      if (steps > 0) landing_.expect_no_event();
      run_.step.h = asked_.h = result.h;
    } else if (asked_.stage == Stage::step) {
      stepping_.fit(result.h);
    }
    none_ = result.none;
    by_lane_ = {result.peaks_searched, result.forces_may_rise};
    judge(asks_for_whole_step() ? result.judged : StepVerdict{result.error, 1});
    none_.reset(), by_lane_ = {};
  }

private:
  /// The purpose of the step asked for.
  enum class Stage {
    step,    ///< to advance the run
    landing, ///< to end at the event that is due
    doubt,   ///< to confirm a peak inside the accepted step
    repeat   ///< to leave the method's history as the accepted step did
  };

  /// A step from where the run stands over h, into x1 and dxdt1.
  struct TrialStep {
    Stage stage = Stage::step;
    T h = T(0);
    State<T>*x1 = nullptr, *dxdt1 = nullptr;
  };

  void ask_to_end(Stage stage) { asked_ = {stage, run_.step.h, &run_.step.x1, &run_.step.dxdt1}; }
  void ask_inside(Stage stage, const T& s) {
    asked_ = {stage, T(s * run_.step.h), &run_.x, &run_.dxdt};
  }

  /// Takes the step asked for, once it is made. @pre the system's last evaluation was at its end
  /// @param verdict on a whole step by all that it must satisfy, else the method's own
  void judge(const StepVerdict& verdict) {
    switch (asked_.stage) {
    case Stage::step:
      return judge_step(verdict);
    case Stage::landing:
      return judge_landing(verdict);
    case Stage::doubt:
      if (!verdict.accepted() && !stepping_.reach_in_parts(asked_.h, *asked_.x1, *asked_.dxdt1))
        run_.evaluate_at(T(asked_.h / run_.step.h)); // by dense output then
      return confirm_peaks(peaks_.resolve_doubt());
    case Stage::repeat:
      return finish_step();
    }
  }

  // ---- the loop, in order: plan, judge, land, confirm peaks, finish

  void start() {
    AnySystem& system = run_.system;
    ended_ = false;
    may_happen_.assign(run_.at.bodies + 1, true);
    run_.step.t = T(0), run_.searched = 0;
    system.reset();
    system.writable_workspace().least_motion = T(run_.how.atol);
    system.want_forces(run_.goal.peak_force);
    system.start(run_.step.x);
    system.find_sides(run_.step.x);
    if constexpr (M == BaseMotion::free) {
      system.writable_workspace().conserved = conserved(system, run_.step.x, run_.step.t);
      system.writable_workspace().keeps_momenta = system.wing().plates.empty(); // air takes some
    }
    events_.start();
    run_.next_release = events_.releases().next();
    diary_.start();
    stepping_.start();
    peaks_.start();
    ending_.start();
    restart(0);
  }

  /// Evaluates the new right-hand side at t⁺, and begins the method anew.
  /// @param slides the hinge that begins to slide; 0: none
  void restart(int slides) {
    begin_anew(slides);
    diary_.notify();
    stepping_.restart(diary_.any_latch(), landing_.at_friction());
    diary_.begin_phase(stepping_.method(), stepping_.steps());
  }

  void begin_anew(int slides) {
    evaluate_anew(slides);
    if (settle_edges(run_.system, run_.step.x, run_.step.dxdt)) evaluate_anew(0);
    peaks_.include_start();
    begin_step();
  }

  /// Keeps what holds stuck hinges at the start of the next step. @pre the workspace has it
  void begin_step() {
    if (run_.system.work().locked == 0) return;
    run_.held_before = run_.system.work().holding;
    events_.begin_step(run_.step.x);
  }

  void evaluate_anew(int slides) {
    Step<T>& step = run_.step;
    if (run_.system.wing().can_stick)
      sort_contacts(run_.system, step.x, step.dxdt, step.t, slides);
    else
      run_.system(step.x, step.dxdt, step.t);
  }

  /// Ends the run, or asks for the next step.
  void end_or_plan() {
    if (!ending_.ends_here()) return ask_for_step(stepping_.plan());
    end(ending_.describe_end());
  }

  /// @param obstacle why no step could be planned, if so
  void ask_for_step(const std::optional<std::string>& obstacle) {
    if (obstacle) return fail(*obstacle);
    ask_to_end(Stage::step);
  }

  void judge_step(const StepVerdict& verdict) {
    if (!stepping_.count_trial(stepping_.cut_at_turn(verdict, events_))) return refuse_step();
    stepping_.choose_next_size();
    if (none_ && none_->at_all)
      landing_.expect_no_event();
    else if (landing_.cut_at_event(events_to_search(), stepping_.rtol_of_landing()))
      return ask_to_end(Stage::landing);
    accept();
  }

  [[nodiscard]] EventSearch events_to_search() const {
    if (!none_) return {stepping_.kinks()};
    return {none_->kinks ? std::nullopt : stepping_.kinks(), !none_->releases, &may_happen_};
  }

  void refuse_step() {
    if (!stepping_.is_finite()) return ask_for_step(stepping_.plan_again());
    const T h = run_.step.h;
    if (landing_.cut_refused_step(stepping_.kinks(), stepping_.rtol_of_landing())) {
      stepping_.plan_to_jump(h);
      return ask_to_end(Stage::landing);
    }
    const std::optional<T> kink = stepping_.kink_inside();
    ask_for_step(kink ? stepping_.plan_to_kink(*kink) : stepping_.plan_again());
  }

  void judge_landing(const StepVerdict& verdict) {
    if (!stepping_.count_trial(verdict)) return ask_for_step(stepping_.plan_again());
    if (landing_.correct_end()) return ask_to_end(Stage::landing);
    // the search for events before a kink needs a step that ends just beyond it
    if (landing_.at_kink() && landing_.carry_end_to_event()) by_lane_ = {};
    if (landing_.cut_at_earlier_event(stepping_.kinks())) return ask_to_end(Stage::landing);
    accept();
  }

  /// Searches an accepted step for peaks.
  void accept() {
    before_search_ = run_.system.work().evaluations;
    confirm_peaks(peaks_.first_doubt(by_lane_));
  }

  /// Asks for a step to the peak in doubt. @param doubt its fraction of the step; none: all are known
  void confirm_peaks(const std::optional<T>& doubt) {
    if (doubt) return ask_inside(Stage::doubt, *doubt);
    if (peaks_.made_inner_steps() && stepping_.method() == Method::adams_bashforth_moulton)
      return ask_inside(Stage::repeat, T(1)); // its history must be that of the accepted step
    finish_step();
  }

  /// Moves to the step's end, applies its event, and ends the run or asks for the next step.
  void finish_step() {
    if (landing_.carry_end_to_event()) peaks_.include_end();
    peaks_.close_step();
    run_.searched += run_.system.work().evaluations - before_search_;
    diary_.notify_inside([this](const T& s) { return stepping_.evaluate_inside(s); });
    stepping_.advance(landing_.at_event());
    if (landing_.at_jump()) landing_.cross_jump();
    Step<T>& step = run_.step;
    diary_.watch_energy();
    if (run_.system.work().locked > 0) {
      run_.system.writable_workspace().holding = peaks_.held_at_end();
      run_.system.set_commands(step.t);
      begin_step();
    }
    diary_.notify();
    const bool at_knot = run_.system.enter_piece(step.t);
    if (landing_.apply_events(diary_.record())) {
      if (diary_.is_watched() || !ending_.ends_at_latch()) restart(landing_.slides());
    } else {
      if (stepping_.choose_method()) diary_.begin_phase(stepping_.method(), stepping_.steps());
      if (at_knot)
        pass_knot();
      else if (landing_.at_jump())
        pass_jump();
    }
    if (!angles_are_known(run_.at, step.x)) return fail("a hinge has turned past 1e8 rad");
    end_or_plan();
  }

  /// The base's motion, or a motor's command, enters another piece of its table.
  void pass_knot() {
    begin_anew(0);
    stepping_.restart_at_knot();
  }

  /// The moments jump, and the run goes on.
  void pass_jump() {
    begin_anew(0);
    if (stepping_.method() == Method::adams_bashforth_moulton) stepping_.restart_at_knot();
  }

  void fail(const std::string& why) {
    end({Status::failed,
         why + ", at t = " + std::to_string(static_cast<double>(run_.step.t)) + " s"});
  }

  void end(const End& how) {
    diary_.close(how.status, how.reason, stepping_.work(), peaks_, how.final);
    if (how.status == Status::stalled)
      diary_.note_held_hinges(how.never_released, how.may_release_later);
    ended_ = true;
  }

  /// Whether the step asked for ends the step under way. Its verdict is then more than the method's own.
  [[nodiscard]] bool asks_for_whole_step() const {
    return asked_.stage == Stage::step || asked_.stage == Stage::landing;
  }

  /// Whether the lane of an engine can judge the step asked for.
  [[nodiscard]] bool asks_for_plain_step() const {
    return asked_.stage == Stage::step && !stepping_.is_last();
  }

  [[nodiscard]] static bool all_finite(const State<T>& x) {
    return std::all_of(x.begin(), x.end(), [](const T& v) { return is_finite(v); });
  }

  Underway<T, AnySystem> run_;
  Events<T, AnySystem> events_;
  Diary<T, AnySystem> diary_;
  Stepping<T, AnySystem> stepping_;
  Landing<T, AnySystem> landing_;
  PeakSearch<T, AnySystem> peaks_;
  Ending<T, AnySystem> ending_;
  TrialStep asked_;
  bool ended_ = false;
  long before_search_ = 0; ///< evaluations of the run when the search for the step's peaks began
  std::optional<NoEvents>
      none_; ///< if a lane has made the step to be judged: what it has found in it
  std::vector<char>
      may_happen_; ///< 1 … n: if so, the hinges that may have events; for the lane to write to
  typename PeakSearch<T, AnySystem>::LaneSearch by_lane_; ///< of the peaks of that step
};

} // namespace wingspread
