/// The engine of packs, for an instruction set's own translation unit: the templates of the scalar
/// path over Pack<W>.
#pragma once

#include "core/dense/roughness.hpp"
#include "core/mechanics/system.hpp"
#include "core/methods/dop853.hpp"
#include "core/methods/runge_kutta.hpp"
#include "core/packs/pack_engine.hpp"
#include "core/peaks/moment_peaks.hpp"

#include <optional>

namespace wingspread {

template <int W, class Topology, BaseMotion M, class Formula>
class PackStepper : public PackEngine {
  using P = Pack<W>;
  using Mask = typename P::Mask;
  using AnySystem = System<P, Topology, M>;

public:
  PackStepper(const Wing<double>& wing, const Topology& topology, const PackShape& shape)
      : shape_(shape), topology_(topology), system_(make(wing), topology_, std::nullopt, work_),
        at_(system_.layout()) {
    for (State<P>* x : {&step_.x, &step_.dxdt, &step_.x1, &step_.dxdt1, &error_})
      x->assign(at_.size(), P(0.0));
    const std::size_t n = at_.bodies + 1;
    for (std::vector<P>* v : {&waits_, &moments_, &forces_, &force_before_, &force_after_})
      v->assign(n, P(0.0));
    step_.t = P(0.0);
    rtol_ = atol_ = rough_atol_ = P(1.0);
    error_size_ = busy_ = due_ = shown_ = steps_ = t_end_ = step_.h = P(0.0);
    held_back_step_ = last_free_ = enough_ = wait_ = tries_to_free_ = free_time_ = P(0.0);
    system_.want_forces(shape.forces);
  }

  [[nodiscard]] int width() const override { return W; }
  [[nodiscard]] int evaluations_per_try() const override { return Formula::evaluations; }
  [[nodiscard]] long rounds() const override { return round_; }

  void set_wing(int lane, const Wing<double>& wing) override {
    const auto set = [lane](P& to, double from) { to.v[lane] = from; };
    const auto set2 = [lane](Vec2<P>& to, const Vec2<double>& from) {
      to.x.v[lane] = from.x, to.y.v[lane] = from.y;
    };
    BaseTerms<P>& base = wing_.base;
    set2(base.acceleration, wing.base.acceleration);
    set(base.angular_acceleration, wing.base.angular_acceleration);
    set(base.angle, wing.base.angle), set(base.rate, wing.base.rate);
    for (int i = 0; i <= at_.bodies; ++i) {
      BodyTerms<P>& body = wing_.bodies[i];
      const BodyTerms<double>& from = wing.bodies[i];
      set(body.mass, from.mass), set(body.inertia, from.inertia);
      set2(body.mass_moment, from.mass_moment), set2(body.arm, from.arm);
      set(body.minus_inverse, from.minus_inverse);
    }
    for (int i = 1; i <= at_.bodies; ++i) {
      HingeTerms<P>& hinge = wing_.hinges[i];
      const HingeTerms<double>& from = wing.hinges[i];
      set(hinge.latched, from.latched), set(hinge.sense, from.sense);
      set(hinge.regularized_friction, from.regularized_friction),
          set(hinge.slip_rate, from.slip_rate);
      hinge.has_latch = hinge.has_latch || from.has_latch;
    }
    wing_.has_regularized_friction =
        wing_.has_regularized_friction || wing.has_regularized_friction;
  }

  void set_run(int lane, const Workspace<double>& work, const Step<double>& step,
               const Watch& watch, const Stretch& stretch) override {
    for (int i = 1; i <= at_.bodies; ++i) {
      LinearLaw<P>& law = work_.laws[i];
      const LinearLaw<double>& from = work.laws[i];
      law.latched.v[lane] = from.latched, law.drive.v[lane] = from.drive;
      law.stiffness.v[lane] = from.stiffness, law.damping.v[lane] = from.damping;
      waits_[i].v[lane] = work.engaged[i] ? 0 : 1;
      moments_[i].v[lane] = watch.moments ? (*watch.moments)[i].value : 0;
      forces_[i].v[lane] = watch.forces ? (*watch.forces)[i].value : 0;
      force_before_[i].v[lane] = watch.force_before ? (*watch.force_before)[i] : 0;
    }
    step_.t.v[lane] = step.t;
    for (int k = 0; k < at_.size(); ++k)
      step_.x[k].v[lane] = step.x[k], step_.dxdt[k].v[lane] = step.dxdt[k];
    rtol_.v[lane] = watch.rtol, atol_.v[lane] = watch.atol;
    rough_atol_.v[lane] = watch.atol_of_interpolant;
    step_.h.v[lane] = stretch.h;
    memory_.log_error.v[lane] = stretch.memory.log_error;
    memory_.most.v[lane] = stretch.memory.most;
    memory_.h.v[lane] = stretch.memory.h;
    busy_.v[lane] = 1;
    shown_.v[lane] = static_cast<double>(round_);
    due_.v[lane] = static_cast<double>(round_) + static_cast<double>(stretch.tries);
    steps_.v[lane] = 0;
    t_end_.v[lane] = stretch.t_end;
    held_back_step_.v[lane] = stretch.held_back_step;
    last_free_.v[lane] = stretch.last_free;
    enough_.v[lane] = stretch.enough, wait_.v[lane] = stretch.wait;
  }

  void set_idle(int lane) override { busy_.v[lane] = step_.h.v[lane] = 0; }

  void get_start(int lane, Step<double>& step, std::vector<double>& forces) const override {
    for (int k = 0; k < at_.size(); ++k)
      step.x[k] = step_.x[k].v[lane], step.dxdt[k] = step_.dxdt[k].v[lane];
    if (!shape_.forces) return;
    for (int i = 1; i <= at_.bodies; ++i) forces[i] = force_before_[i].v[lane];
  }

  void get_end(int lane, State<double>& x1, State<double>& dxdt1,
               std::vector<Vec2<double>>& forces) const override {
    for (int k = 0; k < at_.size(); ++k)
      x1[k] = step_.x1[k].v[lane], dxdt1[k] = step_.dxdt1[k].v[lane];
    if (!shape_.forces) return;
    for (int i = 1; i <= at_.bodies; ++i)
      forces[i] = {work_.forces[i].x.v[lane], work_.forces[i].y.v[lane]};
  }

  LaneSet advance() override {
    for (;;) {
      const Start<P> from{step_.t, step_.x, step_.dxdt};
      formula_.estimate(system_, from, step_.h, step_.x1, step_.dxdt1, error_);
      ++round_;
      const Judgement judgement = judge();
      const Mask asks = busy_ > P(0.0) && must_ask(judgement);
      go_on(judgement, !asks);
      if (const LaneSet asking = set_of(asks); asking != 0) return asking;
    }
  }

  [[nodiscard]] double error(int lane) const override { return error_size_.v[lane]; }

  [[nodiscard]] Progress progress(int lane) const override {
    const auto at = [lane](const P& p) { return p.v[lane]; };
    const auto count = [lane](const P& p) { return static_cast<long>(p.v[lane]); };
    return {round_ - 1 - count(shown_),
            count(steps_),
            at(step_.t),
            at(step_.h),
            {at(memory_.log_error), at(memory_.most), at(memory_.h)},
            count(last_free_),
            count(tries_to_free_),
            at(free_time_)};
  }

private:
  /// In two statements: GCC 12's sanitizers take `lane` for uninitialized where one expression both
  /// reads a vector's element by it and shifts by it.
  [[nodiscard]] static LaneSet set_of(const Mask& mask) {
    LaneSet set = 0;
    for (int lane = 0; lane < W; ++lane) {
      const std::int64_t there = mask.bits[lane];
      if (there != 0) set |= LaneSet{1} << lane;
    }
    return set;
  }

  /// A wing of this structure, with harmless numbers in every lane.
  const Wing<P>& make(const Wing<double>& wing) {
    wing_.tree = wing.tree;
    wing_.base.motion = wing.base.motion;
    const P one(1.0), zero(0.0);
    const Vec2<P> none{zero, zero};
    wing_.base.acceleration = none;
    wing_.base.angular_acceleration = wing_.base.angle = wing_.base.rate = zero;
    wing_.bodies.assign(wing.bodies.size(), {one, one, none, none, none, one, P(-1.0)});
    HingeTerms<P> hinge{};
    hinge.sense = hinge.slip_rate = one;
    hinge.stowed = hinge.latched = hinge.drive = hinge.drive_slope = hinge.regularized_friction =
        zero;
    hinge.viscous = hinge.kinetic_friction = hinge.static_friction = hinge.stiffness =
        hinge.damping = zero;
    wing_.hinges.assign(wing.hinges.size(), hinge);
    return wing_;
  }

  struct Judgement {
    Mask accepted;
    P next; ///< step, or try
  };

  /// As Adaptive::verdict and limit_roughness.
  [[nodiscard]] Judgement judge() {
    error_size_ = scaled_error_of(formula_, step_.x, step_.x1, step_.dxdt1, error_, rtol_, atol_);
    Mask accepted = error_size_ <= P(1.0);
    P factor = step_factor(Formula::error_order, error_size_, step_.h, memory_);
    if constexpr (Formula::order > 5) {
      const P rough = roughness(at_, step_.h, step_.dxdt, step_.dxdt1, rough_atol_);
      const Mask too_rough = rough > P(1.0);
      const P most = factor_by_roughness(rough);
      factor = select(accepted, select(too_rough, most, smaller(factor, most)), factor);
      accepted = accepted && !too_rough;
    }
    return {accepted, step_.h * factor};
  }

  /// Which lanes' runs must be told of the step: what follows from it is not a plain step.
  [[nodiscard]] Mask must_ask(const Judgement& judgement) {
    const Mask& accepted = judgement.accepted;
    const P& next = judgement.next;
    const P end = step_.t + step_.h, now = select(accepted, end, step_.t);
    const Mask late = due_ < P(static_cast<double>(round_));
    const Mask at_an_end = !(next > P(1e-9) * now) || !(next < P(0.999999) * (t_end_ - now));
    if constexpr (M == BaseMotion::free) return late || at_an_end || accepted;
    const P made = steps_ + P(1.0);
    const Mask may_leave =
        step_.h > held_back_step_ && made >= last_free_ + enough_ && made >= wait_;
    return late || at_an_end || (accepted && (may_leave || worth_a_look()));
  }

  /// Accepts, or tries again, in these lanes.
  void go_on(const Judgement& judgement, const Mask& these) {
    const Mask accepted = these && judgement.accepted;
    for (int k = 0; k < at_.size(); ++k) {
      step_.x[k] = select(accepted, step_.x1[k], step_.x[k]);
      step_.dxdt[k] = select(accepted, step_.dxdt1[k], step_.dxdt[k]);
    }
    if (shape_.forces)
      for (int i = 1; i <= at_.bodies; ++i)
        force_before_[i] = select(accepted, force_after_[i], force_before_[i]);
    step_.t = select(accepted, P(step_.t + step_.h), step_.t);
    steps_ = select(accepted, P(steps_ + P(1.0)), steps_);
    const Mask free = accepted && !(step_.h > held_back_step_);
    last_free_ = select(free, steps_, last_free_);
    tries_to_free_ = select(free, P(P(static_cast<double>(round_)) - shown_), tries_to_free_);
    free_time_ = select(free, step_.t, free_time_);
    StepMemory<P> after = memory_;
    after.accepted(error_size_, step_.h);
    memory_.log_error = select(accepted, after.log_error, memory_.log_error);
    memory_.h = select(accepted, after.h, memory_.h);
    memory_.most = select(accepted, after.most, select(these, P(1.0), memory_.most));
    step_.h = select(these, judgement.next, step_.h);
  }

  /// Lanes in which an event, a peak or an angle past bounds may lie inside the step: all tests are
  /// those that the run itself begins with.
  [[nodiscard]] Mask worth_a_look() {
    Mask look{};
    for (int i = 1; i <= at_.bodies; ++i) {
      const HingeTerms<P>& hinge = wing_.hinges[i];
      look = look || !(abs(step_.x1[at_.angle(i)]) < P(1e8));
      if (hinge.has_latch) look = look || (waits_[i] > P(0.0) && may_engage(i));
      if (shape_.moments) {
        const MomentOverStep<P, AnySystem> moment(system_, step_, i);
        look = look || !(moment.most() <= moments_[i]);
      }
      if (!shape_.forces) continue;
      const Vec2<P>& force = work_.forces[i];
      force_after_[i] = sqrt(dot(force, force));
      look = look || P(1.25) * larger(force_before_[i], force_after_[i]) > forces_[i];
    }
    return look;
  }

  [[nodiscard]] Mask may_engage(int i) const {
    const HingeTerms<P>& hinge = wing_.hinges[i];
    Mask any{};
    for (const P& c : step_.coordinate(at_.angle(i), at_.freedoms()))
      any = any || !(hinge.sense * (c - hinge.latched) < P(0.0));
    return any;
  }

  PackShape shape_;
  Topology topology_;
  Wing<P> wing_;
  Workspace<P> work_;
  AnySystem system_;
  Layout at_;
  Formula formula_;
  Step<P> step_;
  State<P> error_;
  P rtol_, atol_, rough_atol_, error_size_;
  std::vector<P> waits_, moments_, forces_, force_before_, force_after_;
  StepMemory<P> memory_;
  // as in Stretch and Progress; rounds are counted as doubles
  P busy_, due_, shown_, steps_, t_end_, held_back_step_, last_free_, enough_, wait_,
      tries_to_free_, free_time_;
  long round_ = 0;
};

namespace detail {

template <int W, BaseMotion M, class Topology>
[[nodiscard]] std::unique_ptr<PackEngine>
pack_stepper(const Wing<double>& wing, const Topology& topology, const PackShape& shape) {
  using P = Pack<W>;
  if (shape.eighth_order)
    return std::make_unique<PackStepper<W, Topology, M, DormandPrince853<P>>>(wing, topology,
                                                                              shape);
  return std::make_unique<PackStepper<W, Topology, M, DormandPrince5<P>>>(wing, topology, shape);
}

template <int W, int N = 1>
[[nodiscard]] std::unique_ptr<PackEngine> chain_stepper(const Wing<double>& wing,
                                                        const PackShape& shape) {
  if constexpr (N <= longest_static_chain) {
    if (wing.size() == N) return pack_stepper<W, BaseMotion::fixed>(wing, Chain<N>{}, shape);
    return chain_stepper<W, N + 1>(wing, shape);
  } else {
    return pack_stepper<W, BaseMotion::fixed>(wing, wing.tree, shape);
  }
}

} // namespace detail

/// The stepper of a structure, in packs of W.
template <int W>
[[nodiscard]] std::unique_ptr<PackEngine> make_pack_stepper(const Wing<double>& wing,
                                                            const PackShape& shape) {
  switch (shape.motion) {
  case BaseMotion::prescribed:
    return detail::pack_stepper<W, BaseMotion::prescribed>(wing, wing.tree, shape);
  case BaseMotion::free:
    return detail::pack_stepper<W, BaseMotion::free>(wing, wing.tree, shape);
  case BaseMotion::fixed:
    break;
  }
  if (is_chain(wing.tree)) return detail::chain_stepper<W>(wing, shape);
  return detail::pack_stepper<W, BaseMotion::fixed>(wing, wing.tree, shape);
}

} // namespace wingspread
