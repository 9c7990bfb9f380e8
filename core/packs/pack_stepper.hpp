/// PackStepper, the engine of W lanes: the templates with which a run alone makes its steps, over
/// Pack<W>. Each instruction set compiles it in a translation unit of its own.
#pragma once

#include "core/dense/friction_layer.hpp"
#include "core/dense/roughness.hpp"
#include "core/events/leaps.hpp"
#include "core/events/turning.hpp"
#include "core/mechanics/structure.hpp"
#include "core/mechanics/system.hpp"
#include "core/methods/dop853.hpp"
#include "core/methods/runge_kutta.hpp"
#include "core/methods/taylor.hpp"
#include "core/methods/time_scales.hpp"
#include "core/packs/fields.hpp"
#include "core/packs/free_bases.hpp"
#include "core/packs/lane_events.hpp"
#include "core/packs/lane_peaks.hpp"
#include "core/packs/pack_engine.hpp"
#include "core/peaks/motor_energy.hpp"
#include "core/peaks/overtravel.hpp"

#include <memory>
#include <optional>

namespace wingspread {

template <int W, class Topology, BaseMotion M, class Formula>
class PackStepper : public PackEngine {
  using P = Pack<W>;
  using Mask = typename P::Mask;
  using AnySystem = System<P, Topology, M>;

public:
  PackStepper(const Wing<double>& wing, const PackShape& shape)
      : shape_(shape), system_(set_harmless(wing_, wing), std::nullopt, work_),
        at_(system_.layout()), peaks_(shape) {
    const P none(0.0);
    for (State<P>* x : {&step_.x, &step_.dxdt, &step_.x1, &step_.dxdt1, &error_})
      x->assign(at_.size(), none);
    for (std::vector<P>* v : {&overtravel_, &motor_energy_, &motor_work_})
      v->assign(at_.bodies + 1, none);
    holds_.resize(at_);
    events_.resize(at_, wing_.real.size());
    rtol_ = atol_ = dense_tolerance_ = P(1.0);
    step_.t = step_.h = scaled_error_ = judged_ = factor_ = busy_ = end_of_stretch_ = none;
    first_round_ = last_round_ = last_step_ = evaluations_before_ = none;
    history_ = {none, {}, {none, none, {none, none, none}}};
    system_.want_forces(shape.forces);
    peaks_.resize(at_);
  }

  [[nodiscard]] int width() const override { return W; }
  [[nodiscard]] long rounds() const override { return round_; }

  void set_wing(int lane, const Wing<double>& wing) override {
    set_lane(lane, wing_, wing);
    for (TablePiece<P>& piece : work_.pieces) set_lane(lane, piece, no_table_piece<double>());
    if (!shape_.forces) return;
    set_levers(wing, system_.topology(), levers_of_wing_);
    set_lane(lane, peaks_.levers(), levers_of_wing_);
  }

  void load(int lane, const LaneTask& task) override {
    const double now = static_cast<double>(round_);
    step_.t.v[lane] = task.step.t, step_.h.v[lane] = task.h;
    set_lane(lane, step_.x, task.step.x), set_lane(lane, step_.dxdt, task.step.dxdt);
    set_lane(lane, history_, task.history);
    set_lane(lane, work_.laws, task.work.laws);
    if constexpr (M == BaseMotion::free) {
      set_lane(lane, work_.conserved, task.work.conserved);
      work_.keeps_momenta = task.work.keeps_momenta;
    }
    work_.least_motion.v[lane] = task.work.least_motion;
    if (!wing_.real.empty()) set_lane(lane, work_.modes, task.work.modes);
    if (!wing_.motors.empty()) set_lane(lane, work_.motors, task.work.motors);
    if (wing_.base.table) set_lane(lane, work_.driven, task.work.driven);
    for (int i = 1; i <= at_.bodies; ++i) overtravel_[i].v[lane] = task.overtravel[i];
    for (int i = 1; task.motor_energy && i <= at_.bodies; ++i)
      motor_energy_[i].v[lane] = task.motor_energy[i];
    events_.load(lane, task.work);
    peaks_.load(lane, task);
    if constexpr (M == BaseMotion::free) free_.load(lane, task);
    rtol_.v[lane] = task.tolerance.rtol, atol_.v[lane] = task.tolerance.atol;
    dense_tolerance_.v[lane] = task.dense_tolerance;
    end_of_stretch_.v[lane] = task.end_of_stretch;
    first_round_.v[lane] = now;
    last_round_.v[lane] = now + static_cast<double>(task.most_trial_steps);
    last_step_.v[lane] = task.history.steps + static_cast<double>(task.most_steps);
    evaluations_before_.v[lane] =
        static_cast<double>(task.evaluations) - now * evaluations_of_trial();
    busy_.v[lane] = 1;
    holds_.load(lane, &task, work_);
  }

  void set_idle(int lane) override {
    busy_.v[lane] = step_.h.v[lane] = 0;
    holds_.load(lane, nullptr, work_);
  }

  void unload(int lane, LaneResult& result) const override {
    result.trial_steps = round_ - 1 - static_cast<long>(first_round_.v[lane]);
    const bool moved = result.trial_steps > 0;
    if (moved) {
      result.step.t = step_.t.v[lane];
      get_lane(lane, step_.x, result.step.x), get_lane(lane, step_.dxdt, result.step.dxdt);
      for (int i = 1; i <= at_.bodies; ++i) result.overtravel[i] = overtravel_[i].v[lane];
      for (std::size_t i = 1; i < result.motor_energy.size(); ++i)
        result.motor_energy[i] = motor_energy_[i].v[lane];
    }
    get_lane(lane, step_.x1, result.x1), get_lane(lane, step_.dxdt1, result.dxdt1);
    peaks_.unload(lane, result, moved);
    holds_.unload(lane, result, moved);
    result.searched = peaks_.evaluations(lane);
    result.evaluations = (result.trial_steps + 1) * evaluations_of_trial() + result.searched;
    events_.unload(lane, result);
    result.none = {asks_after_[3].bits[lane] == 0, kinks_.bits[lane] == 0,
                   releases_.bits[lane] == 0};
    result.peaks_searched = result.moments_rise && accepted_.bits[lane] != 0;
    if (result.peaks_searched) peaks_.unload_search(lane, result);
    if constexpr (M == BaseMotion::free) free_.unload(lane, result);
    result.h = step_.h.v[lane];
    result.error = scaled_error_.v[lane];
    result.judged = {judged_.v[lane], factor_.v[lane]};
    get_lane(lane, history_, result.history);
  }

  [[nodiscard]] Cause cause(int lane) const override {
    int tests = 0; // that did not make the lane ask
    for (const Mask& asks : asks_after_) tests += asks.bits[lane] == 0 ? 1 : 0;
    if (tests == static_cast<int>(asks_after_.size())) return Cause::limit;
    if (tests == 4) return peaks_.asks_for_moment(lane) ? Cause::moment : Cause::force;
    return static_cast<Cause>(static_cast<int>(Cause::limit) + tests);
  }

  LaneSet advance() override {
    for (;;) {
      const Start<P> from{step_.t, step_.x, step_.dxdt};
      estimate(formula_, system_, from, step_.h, step_.x1, step_.dxdt1, error_, rtol_, atol_);
      ++round_;
      const Judgement judgement = judge_step();
      const Mask asks = find_lanes_that_ask(judgement);
      accept_or_reject(judgement, !asks);
      if (const LaneSet asking = set_of(asks); asking != 0) return asking;
    }
  }

private:
  // In two statements: GCC 12's sanitizers take `lane` for uninitialized if one expression both reads
  // a vector's element by it and shifts by it.
  [[nodiscard]] static LaneSet set_of(const Mask& mask) {
    LaneSet set = 0;
    for (int lane = 0; lane < W; ++lane) {
      const std::int64_t there = mask.bits[lane];
      if (there != 0) set |= LaneSet{1} << lane;
    }
    return set;
  }

  /// As a run alone counts them: a formula whose last stage is at the step's end makes another one there if the step
  /// keeps momenta.
  [[nodiscard]] int evaluations_of_trial() const {
    return Formula::evaluations + (Formula::ends_with_stage && work_.keeps_momenta ? 1 : 0);
  }

  struct Judgement {
    Mask accepted;
    P next; ///< trial step, s
  };

  /// Judges the trial step as Stepping::judged does for a run alone.
  [[nodiscard]] Judgement judge_step() {
    scaled_error_ = scaled_error_of(formula_, step_.x, step_.x1, step_.dxdt1, error_, rtol_, atol_);
    Mask accepted = scaled_error_ <= P(1.0);
    P factor = factor_of<Formula>(scaled_error_, step_.h, history_.memory);
    if (wing_.has_regularized_friction) {
      const LayerLimits<P> layers = layer_limits(wing_, at_, step_, rtol_, atol_);
      const Mask leaps = layers.cut < P(1.0);
      factor = select(accepted, select(leaps, layers.cut, smaller(factor, layers.next)), factor);
      accepted = accepted && !leaps;
    }
    if constexpr (Formula::order > 5) {
      const P rough = roughness(at_, step_, dense_tolerance_);
      const Mask too_rough = rough > P(1.0);
      const P most = factor_by_roughness(rough);
      factor = select(accepted, select(too_rough, most, smaller(factor, most)), factor);
      accepted = accepted && !too_rough;
    }
    const P refused = select(scaled_error_ <= P(1.0), P(2.0), scaled_error_);
    judged_ = select(accepted, scaled_error_, refused), factor_ = factor;
    return {accepted, limit_by_base(accepted, step_.h * factor)};
  }

  /// As Stepping::wanted_step, for the next trial step.
  [[nodiscard]] P limit_by_base(const Mask& accepted, const P& next) const {
    if constexpr (M != BaseMotion::prescribed) return next;
    if (work_.locked == 0) return next;
    const P from = select(accepted, P(step_.t + step_.h), step_.t);
    const P most = time_of_base(wing_.base, work_.driven, from, P(end_of_stretch_ - from));
    return select(holds_.lanes(), smaller(next, most), next);
  }

  /// @return the lanes that need their runs: see lane_protocol.hpp
  [[nodiscard]] Mask find_lanes_that_ask(const Judgement& judgement) {
    const P& next = judgement.next;
    const Mask busy = busy_ > P(0.0), accepted = accepted_ = busy && judgement.accepted;
    const P end = step_.t + step_.h, now = select(accepted, end, step_.t);
    const Mask tried_enough = last_round_ < P(static_cast<double>(round_));
    // Both margins are far wider than the limits at which a run alone stops a step, 4 and 8 roundings
    // of the time (Stepping::plan, advance): the run decides the cases between.
    const Mask near_limit =
        !(next > P(1e-9) * now) || !(next < P(0.999999) * (end_of_stretch_ - now));
    const Mask may_leave = history_.held_back.may_leave(step_.h, P(history_.steps + P(1.0)));
    const Mask accepted_enough = history_.steps >= last_step_;
    Mask asks = busy && (tried_enough || near_limit || (accepted && may_leave));
    asks_after_[0] = asks;
    asks = asks || (accepted && events_.lie_inside(system_, step_));
    kinks_ = Mask{};
    if (!wing_.motors.empty()) kinks_ = accepted && motors_may_pass_limit();
    if (!wing_.loops.empty()) {
      const P tau = select(accepted, P(P(0.5) * step_.h), step_.h);
      kinks_ = kinks_ || (busy && moments_may_jump(system_, step_, tau, rtol_, atol_));
      kinks_ = kinks_ || (accepted && may_leap_over_gears(system_, step_));
    }
    if (!wing_.real.empty()) {
      const Mask refused = busy && !judgement.accepted;
      kinks_ = kinks_ || (accepted && may_leap_over_tables(system_, step_));
      if (any(refused)) kinks_ = kinks_ || (refused && may_meet_kink(system_, step_));
    }
    asks_after_[1] = asks = asks || kinks_;
    releases_ = Mask{};
    if (work_.locked > 0) releases_ = accepted && holds_.may_release(system_, step_);
    asks_after_[2] = asks = asks || releases_;
    peaks_.keep_forces_at_end(system_);
    asks = asks || (accepted && may_turn_or_end_at_event());
    asks_after_[3] = asks;
    asks = asks || peaks_.search_step(system_, step_, accepted, asks, holds_.before());
    asks_after_[4] = asks;
    return asks || (accepted && accepted_enough);
  }

  /// Moves the accepted ones of these lanes to the step's end, and plans the next trial step of all.
  void accept_or_reject(const Judgement& judgement, const Mask& these) {
    const Mask accepted = these && judgement.accepted;
    for (int k = 0; k < at_.size(); ++k) {
      step_.x[k] = select(accepted, step_.x1[k], step_.x[k]);
      step_.dxdt[k] = select(accepted, step_.dxdt1[k], step_.dxdt[k]);
    }
    for (int i = 1; shape_.overtravel && i <= at_.bodies; ++i) {
      const P beyond = beyond_stowed(wing_.hinges[i], step_.x[at_.angle(i)]);
      overtravel_[i] = select(accepted, larger(overtravel_[i], beyond), overtravel_[i]);
    }
    for (int i = 1; shape_.motor_energy && i <= at_.bodies; ++i)
      motor_energy_[i] = select(accepted && events_.waits(i), P(motor_energy_[i] + motor_work_[i]),
                                motor_energy_[i]);
    peaks_.accept(accepted);
    if (work_.locked > 0) holds_.accept(accepted);
    step_.t = select(accepted, P(step_.t + step_.h), step_.t);
    update_history(accepted, these);
    step_.h = select(these, judgement.next, step_.h);
  }

  /// Counts the step as the run alone would.
  void update_history(const Mask& accepted, const Mask& these) {
    history_.steps = select(accepted, P(history_.steps + P(1.0)), history_.steps);
    const P evaluations(static_cast<double>(round_ * evaluations_of_trial()));
    if constexpr (M == BaseMotion::free) free_.accept(accepted);
    history_.held_back.accepted(accepted, step_.h,
                                {step_.t, evaluations_before_ + evaluations, history_.steps});
    StepMemory<P> after = history_.memory, cut = history_.memory;
    after.accepted(scaled_error_, step_.h);
    cut.rejected();
    assign_where(these, history_.memory, cut);
    assign_where(accepted, history_.memory, after);
  }

  /// Finds the work of every motor over the step. @return lanes in which a motor may reach or leave its limit: a kink,
  /// at which the run's step may end
  [[nodiscard]] Mask motors_may_pass_limit() {
    Mask found{};
    for (int i = 1; i <= at_.bodies; ++i) {
      const Mask runs = work_.motors[i].runs > P(0.0);
      if (shape_.motor_energy) motor_work_[i] = P(0.0);
      if (!any(runs)) continue;
      const MotorOverStep<P> motor(system_, step_, i);
      found = found || (runs && motor.may_pass_limit());
      if (shape_.motor_energy)
        motor_work_[i] = select(runs && events_.waits(i), motor.work(), P(0.0));
    }
    return found;
  }

  // The tests for events and peaks are the first tests of the run alone: they may exclude one, and never find one.

  /// @return lanes in which the base may turn further inside the step than at its ends, or a hinge may
  ///         turn back beyond its stowed angle, leaves the angles that are known, or an event lies within an instant of
  ///         the step's end
  [[nodiscard]] Mask may_turn_or_end_at_event() {
    Mask found{};
    if constexpr (M == BaseMotion::free) found = free_.may_swing_further(at_, step_);
    if (shape_.forces && !wing_.plates.empty()) return !Mask{}; // peak forces in air: the run's
    for (int i = 1; i <= at_.bodies; ++i) {
      found = found || !(abs(step_.x1[at_.angle(i)]) < P(largest_known_angle));
      if constexpr (Formula::order > 8)
        found = found || turns_near_an_end(wing_, at_, step_, i, events_.waits(i));
      if (shape_.overtravel) found = found || may_turn_back(wing_, at_, step_, i, overtravel_[i]);
      found = found || events_.lie_at_end(system_, step_, i);
    }
    return found;
  }

  PackShape shape_;
  Wing<P> wing_;
  Workspace<P> work_;
  AnySystem system_;
  Layout at_;
  Formula formula_;
  Step<P> step_;
  State<P> error_;
  P rtol_, atol_, dense_tolerance_, end_of_stretch_;
  P scaled_error_, judged_, factor_; ///< of the last trial step: as in LaneResult
  std::vector<P> overtravel_;
  std::vector<P> motor_energy_, motor_work_; ///< up to the step's start; over the step, J
  LaneEvents<W> events_;
  LaneLocks<W> holds_;
  Mask accepted_{};           ///< lanes whose last trial step is accepted
  Mask kinks_{}, releases_{}; ///< lanes in whose last trial step there may be one
  /// Lanes that ask, after the tests of limits, events, releases, turns and peaks.
  std::array<Mask, 5> asks_after_{};
  std::vector<Lever<double>> levers_of_wing_; ///< scratch
  LanePeaks<P, AnySystem> peaks_;
  FreeBases<W> free_; ///< used if M is free
  StepHistory<P> history_;
  P busy_;               ///< 1 where a lane has a run, else 0
  P first_round_;        ///< value of round_ at `load`
  P last_round_;         ///< the lane needs its run when round_ exceeds it
  P last_step_;          ///< or when so many steps of the phase have been accepted
  P evaluations_before_; ///< of the run at `load`, less those of all rounds before
  long round_ = 0;       ///< trial steps made in every lane
};

/// Makes the engine of W lanes for a wing's structure and a method.
template <int W>
[[nodiscard]] std::unique_ptr<PackEngine> make_pack_stepper(const Wing<double>& wing,
                                                            const PackShape& shape) {
  using P = Pack<W>;
  using Engine = std::unique_ptr<PackEngine>;
  return with_structure(wing, [&]<class Topology, BaseMotion M>(Structure<Topology, M>) -> Engine {
    if constexpr (is_static<Topology>) // a chain on a fixed base: has_series requires one
      if (shape.method == Method::taylor)
        return std::make_unique<PackStepper<W, Topology, M, TaylorSeries<P>>>(wing, shape);
    if (shape.method == Method::dop853)
      return std::make_unique<PackStepper<W, Topology, M, DormandPrince853<P>>>(wing, shape);
    return std::make_unique<PackStepper<W, Topology, M, DormandPrince5<P>>>(wing, shape);
  });
}

} // namespace wingspread
