/// The engine of packs, for an instruction set's own translation unit: the templates of the scalar
/// path over Pack<W>.
#pragma once

#include "core/dense/friction_layer.hpp"
#include "core/dense/roughness.hpp"
#include "core/events/contact.hpp"
#include "core/events/latches.hpp"
#include "core/events/turning.hpp"
#include "core/mechanics/system.hpp"
#include "core/methods/dop853.hpp"
#include "core/methods/runge_kutta.hpp"
#include "core/methods/taylor.hpp"
#include "core/packs/fields.hpp"
#include "core/packs/free_bases.hpp"
#include "core/packs/lane_peaks.hpp"
#include "core/packs/pack_engine.hpp"
#include "core/packs/structure.hpp"
#include "core/peaks/overtravel.hpp"

#include <array>
#include <optional>

namespace wingspread {

template <int W, class Topology, BaseMotion M, class Formula>
class PackStepper : public PackEngine {
  using P = Pack<W>;
  using Mask = typename P::Mask;
  using AnySystem = System<P, Topology, M>;

public:
  PackStepper(const Wing<double>& wing, const PackShape& shape)
      : shape_(shape), system_(make(wing), std::nullopt, work_), at_(system_.layout()),
        peaks_(shape) {
    const P none(0.0);
    for (State<P>* x : {&step_.x, &step_.dxdt, &step_.x1, &step_.dxdt1, &error_})
      x->assign(at_.size(), none);
    for (std::vector<P>* v : {&waits_, &overtravel_, &slides_}) v->assign(at_.bodies + 1, none);
    for (std::vector<P>& ways : ways_) ways.assign(wing_.real.size(), none);
    rtol_ = atol_ = tolerance_of_dense_ = P(1.0);
    step_.t = step_.h = error_size_ = judged_ = factor_ = busy_ = t_end_ = none;
    begun_ = look_ = last_step_ = evaluations_before_ = none;
    pace_ = {none, {}, {none, none, {none, none, none}}};
    system_.want_forces(shape.forces);
    peaks_.resize(at_);
  }

  [[nodiscard]] int width() const override { return W; }
  [[nodiscard]] long rounds() const override { return round_; }

  void set_wing(int lane, const Wing<double>& wing) override {
    set_lane(lane, wing_, wing);
    if (!shape_.forces) return;
    set_levers(wing, system_.topology(), levers_of_wing_);
    set_lane(lane, peaks_.levers(), levers_of_wing_);
  }

  void carry(int lane, const Handover& run) override {
    const double now = static_cast<double>(round_);
    step_.t.v[lane] = run.step.t, step_.h.v[lane] = run.h;
    set_lane(lane, step_.x, run.step.x), set_lane(lane, step_.dxdt, run.step.dxdt);
    set_lane(lane, pace_, run.pace);
    set_lane(lane, work_.laws, run.work.laws);
    if (!wing_.real.empty()) take_modes(lane, run.work);
    if (wing_.base.table) set_lane(lane, work_.driven, run.work.driven);
    for (int i = 1; i <= at_.bodies; ++i) {
      overtravel_[i].v[lane] = run.overtravel[i];
      slides_[i].v[lane] = static_cast<double>(run.work.contact[i]);
      waits_[i].v[lane] = run.work.engaged[i] ? 0 : 1;
    }
    peaks_.carry(lane, run);
    if constexpr (M == BaseMotion::free) free_.carry(lane, run);
    rtol_.v[lane] = run.tolerance.rtol, atol_.v[lane] = run.tolerance.atol;
    tolerance_of_dense_.v[lane] = run.tolerance_of_dense;
    t_end_.v[lane] = run.t_end;
    begun_.v[lane] = now, look_.v[lane] = now + static_cast<double>(run.tries);
    last_step_.v[lane] = run.pace.steps + static_cast<double>(run.steps);
    evaluations_before_.v[lane] = static_cast<double>(run.evaluations) - now * Formula::evaluations;
    busy_.v[lane] = 1;
  }

  void set_idle(int lane) override { busy_.v[lane] = step_.h.v[lane] = 0; }

  [[nodiscard]] Carried hand_back(int lane, const Place& place) const override {
    const long tries = round_ - 1 - static_cast<long>(begun_.v[lane]);
    if (tries > 0) {
      place.step.t = step_.t.v[lane];
      get_lane(lane, step_.x, place.step.x), get_lane(lane, step_.dxdt, place.step.dxdt);
      for (int i = 1; i <= at_.bodies; ++i) place.overtravel[i] = overtravel_[i].v[lane];
    }
    get_lane(lane, step_.x1, place.x1), get_lane(lane, step_.dxdt1, place.dxdt1);
    peaks_.hand_back(lane, place, tries > 0);
    long evaluations = (tries + 1) * Formula::evaluations + peaks_.evaluations(lane);
    if constexpr (M == BaseMotion::free) {
      free_.hand_back(lane, place, shape_.forces);
      evaluations += static_cast<long>(free_.projections().v[lane]);
    }
    Carried carried{tries,
                    step_.h.v[lane],
                    evaluations,
                    error_size_.v[lane],
                    {judged_.v[lane], factor_.v[lane]},
                    {}};
    get_lane(lane, pace_, carried.pace);
    return carried;
  }

  LaneSet advance() override {
    for (;;) {
      const Start<P> from{step_.t, step_.x, step_.dxdt};
      estimate(formula_, system_, from, step_.h, step_.x1, step_.dxdt1, error_, rtol_, atol_);
      ++round_;
      const Judgement judgement = judge();
      const Mask asks = must_ask(judgement);
      go_on(judgement, !asks);
      if (const LaneSet asking = set_of(asks); asking != 0) return asking;
    }
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
  const Wing<P>& make(const Wing<double>& structure) {
    Wing<double> harmless = structure;
    harmless.base = {};
    for (BodyTerms<double>& body : harmless.bodies) {
      body = {};
      body.mass = body.inertia = body.central_inertia = 1, body.minus_inverse = -1;
    }
    for (HingeTerms<double>& hinge : harmless.hinges) hinge = {}, hinge.sense = hinge.slip_rate = 1;
    for (RealHingeTerms<double>& real : harmless.real) {
      real = {}, real.stop.sense = real.friction.slip_rate = 1;
      real.damper.rate = 1;
    }
    for (PlateTerms<double>& plate : harmless.plates) plate = {};
    wing_.real.resize(structure.real.size());
    wing_.loops.resize(structure.loops.size());
    wing_.plates.resize(structure.plates.size());
    wing_.base.motion = structure.base.motion;
    wing_.tree = structure.tree;
    wing_.bodies.resize(structure.bodies.size());
    wing_.hinges.resize(structure.hinges.size());
    wing_.initial_rates.resize(structure.initial_rates.size());
    for (int lane = 0; lane < W; ++lane) set_lane(lane, wing_, harmless);
    return wing_;
  }

  /// The modes of the run's real hinges, and the edges at which they change.
  void take_modes(int lane, const Workspace<double>& work) {
    set_lane(lane, work_.modes, work.modes);
    for (int i = 1; i <= at_.bodies; ++i)
      for (int e = 0; e < edges_of_hinge; ++e) ways_[e][i].v[lane] = work.above[i][e] != 0 ? -1 : 1;
  }

  struct Judgement {
    Mask accepted;
    P next; ///< step, or try
  };

  /// As Adaptive::verdict, layer_limits and limit_roughness.
  [[nodiscard]] Judgement judge() {
    error_size_ = scaled_error_of(formula_, step_.x, step_.x1, step_.dxdt1, error_, rtol_, atol_);
    Mask accepted = error_size_ <= P(1.0);
    P factor = factor_of<Formula>(error_size_, step_.h, pace_.memory);
    if (wing_.has_regularized_friction) {
      const LayerLimits<P> layers = layer_limits(wing_, at_, step_, rtol_, atol_);
      const Mask leaps = layers.cut < P(1.0);
      factor = select(accepted, select(leaps, layers.cut, smaller(factor, layers.next)), factor);
      accepted = accepted && !leaps;
    }
    if constexpr (Formula::order > 5) {
      const P rough = roughness(at_, step_, tolerance_of_dense_);
      const Mask too_rough = rough > P(1.0);
      const P most = factor_by_roughness(rough);
      factor = select(accepted, select(too_rough, most, smaller(factor, most)), factor);
      accepted = accepted && !too_rough;
    }
    const P refused = select(error_size_ <= P(1.0), P(2.0), error_size_);
    judged_ = select(accepted, error_size_, refused), factor_ = factor;
    return {accepted, step_.h * factor};
  }

  /// Which lanes' runs must be told of the step: what follows from it is not a plain step.
  [[nodiscard]] Mask must_ask(const Judgement& judgement) {
    const P& next = judgement.next;
    const Mask busy = busy_ > P(0.0), accepted = busy && judgement.accepted;
    const P end = step_.t + step_.h, now = select(accepted, end, step_.t);
    const Mask late = look_ < P(static_cast<double>(round_));
    const Mask at_an_end = !(next > P(1e-9) * now) || !(next < P(0.999999) * (t_end_ - now));
    const Mask may_leave = pace_.held_back.may_leave(step_.h, P(pace_.steps + P(1.0)));
    const Mask due = pace_.steps >= last_step_;
    Mask asks = busy && (late || at_an_end);
    asks = asks || (accepted && (due || may_leave || an_event_may_be_near()));
    if constexpr (M == BaseMotion::free) free_.restore_momenta(system_, step_);
    peaks_.end_step(system_);
    asks = asks || (accepted && may_turn_further());
    return asks || peaks_.over_step(system_, step_, accepted && !asks);
  }

  /// Accepts, or tries again, in these lanes.
  void go_on(const Judgement& judgement, const Mask& these) {
    const Mask accepted = these && judgement.accepted;
    for (int k = 0; k < at_.size(); ++k) {
      step_.x[k] = select(accepted, step_.x1[k], step_.x[k]);
      step_.dxdt[k] = select(accepted, step_.dxdt1[k], step_.dxdt[k]);
    }
    for (int i = 1; shape_.overtravel && i <= at_.bodies; ++i) {
      const P beyond = beyond_stowed(wing_.hinges[i], step_.x[at_.angle(i)]);
      overtravel_[i] = select(accepted, larger(overtravel_[i], beyond), overtravel_[i]);
    }
    evaluations_before_ = evaluations_before_ + peaks_.go_on(accepted);
    step_.t = select(accepted, P(step_.t + step_.h), step_.t);
    keep_pace(accepted, these);
    step_.h = select(these, judgement.next, step_.h);
  }

  /// As the run itself would count the step.
  void keep_pace(const Mask& accepted, const Mask& these) {
    pace_.steps = select(accepted, P(pace_.steps + P(1.0)), pace_.steps);
    P evaluations(static_cast<double>(round_ * Formula::evaluations));
    if constexpr (M == BaseMotion::free) {
      free_.accept(accepted, wing_.plates.empty());
      evaluations = evaluations + free_.projections();
    }
    pace_.held_back.accepted(accepted, step_.h,
                             {step_.t, evaluations_before_ + evaluations, pace_.steps});
    StepMemory<P> after = pace_.memory, cut = pace_.memory;
    after.accepted(error_size_, step_.h);
    cut.rejected();
    assign_where(these, pace_.memory, cut);
    assign_where(accepted, pace_.memory, after);
  }

  /// Lanes in which an event may lie inside the step: all tests, these and those for peaks, are those
  /// that the run itself begins with.
  [[nodiscard]] Mask an_event_may_be_near() {
    Mask look{};
    for (int i = 1; i <= at_.bodies; ++i) {
      const HingeTerms<P>& hinge = wing_.hinges[i];
      if (hinge.has_latch) look = look || (waits_[i] > P(0.0) && may_engage(i));
      if (!wing_.real.empty()) look = look || may_pass_edge(i);
      if (wing_.can_stick) look = look || (slides(i) && may_come_to_rest(i));
    }
    return look;
  }

  /// A base that turns further inside the step than at its ends, a hinge that turns back beyond its
  /// stowed angle, or past bounds, or that latches or comes to rest within an instant of the step's
  /// end, by the accelerations that a free base has there. In air, forces are the run's.
  [[nodiscard]] Mask may_turn_further() {
    Mask look{};
    if constexpr (M == BaseMotion::free) look = free_.may_swing_further(at_, step_);
    if (shape_.forces && !wing_.plates.empty()) return !Mask{};
    for (int i = 1; i <= at_.bodies; ++i) {
      look = look || !(abs(step_.x1[at_.angle(i)]) < P(1e8));
      if constexpr (Formula::order > 8)
        look = look || turns_where_it_counts(wing_, at_, step_, i, waits_[i] > P(0.0));
      if (shape_.overtravel) look = look || may_turn_back(wing_, at_, step_, i, overtravel_[i]);
      if (wing_.hinges[i].has_latch) look = look || (waits_[i] > P(0.0) && engages_at_end(i));
      if (wing_.can_stick) look = look || (slides(i) && rests_at_end(i));
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

  [[nodiscard]] Mask may_pass_edge(int i) const {
    Mask any{};
    const Quintic<P> angle = step_.coordinate(at_.angle(i), at_.freedoms());
    for (int e = 0; e < edges_of_hinge; ++e) {
      const Edge edge = static_cast<Edge>(e);
      if (!has_edge(wing_, i, edge, wing_.hinges[i].has_latch)) continue;
      const P there = edge_angle(wing_, i, edge);
      const bool of_latch = edge == Edge::backlash_low || edge == Edge::backlash_high;
      for (const P& c : angle) {
        const Mask stays = ways_[e][i] * (c - there) < P(0.0);
        any = any || (of_latch ? !stays && !(waits_[i] > P(0.0)) : !stays);
      }
    }
    return any;
  }

  /// Where hinge i slides against exact friction.
  [[nodiscard]] Mask slides(int i) const { return !(slides_[i] == P(0.0)); }

  /// A hinge that slides may turn back: as first_rest begins.
  [[nodiscard]] Mask may_come_to_rest(int i) const {
    Mask any{};
    for (const P& c : way_to_rest(at_, step_, i, -slides_[i])) any = any || !(c < P(0.0));
    return any;
  }

  /// As Latches::engage_those_there.
  [[nodiscard]] Mask engages_at_end(int i) const {
    const HingeTerms<P>& hinge = wing_.hinges[i];
    const P gap = hinge.sense * (step_.x1[at_.angle(i)] - hinge.latched);
    return engages_at(P(step_.t + step_.h), gap, P(hinge.sense * step_.x1[at_.rate(i)]));
  }

  /// As rest_those_there.
  [[nodiscard]] Mask rests_at_end(int i) const {
    const P rate = -(slides_[i] * step_.x1[at_.rate(i)]);
    return rests_at(P(step_.t + step_.h), rate, P(-(slides_[i] * step_.dxdt1[at_.rate(i)])));
  }

  PackShape shape_;
  Wing<P> wing_;
  Workspace<P> work_;
  AnySystem system_;
  Layout at_;
  Formula formula_;
  Step<P> step_;
  State<P> error_;
  P rtol_, atol_, tolerance_of_dense_, t_end_;
  P error_size_, judged_, factor_; ///< of the step last tried: as in Carried
  std::vector<P> waits_, overtravel_;
  std::vector<P> slides_; ///< sense in which a hinge slides against exact friction; 0: it does not
  std::array<std::vector<P>, edges_of_hinge> ways_; ///< 1 to be passed upwards, −1 downwards
  std::vector<Lever<double>> levers_of_wing_;       ///< scratch
  LanePeaks<P, AnySystem> peaks_;
  FreeBases<W> free_; ///< where bases are free
  Pace<P> pace_;
  P busy_; ///< 1 where a lane has a run, else 0
  /// Rounds, counted as numbers: when the run was taken, and after which it must know.
  P begun_, look_;
  P last_step_;          ///< of the phase, after which the run must know
  P evaluations_before_; ///< of the run, less those of all rounds before it was taken
  long round_ = 0;
};

/// The stepper of a structure, in packs of W.
template <int W>
[[nodiscard]] std::unique_ptr<PackEngine> make_pack_stepper(const Wing<double>& wing,
                                                            const PackShape& shape) {
  return with_structure(wing, [&]<class Topology, BaseMotion M>() {
    const auto make = [&]<class Formula>() -> std::unique_ptr<PackEngine> {
      return std::make_unique<PackStepper<W, Topology, M, Formula>>(wing, shape);
    };
    if constexpr (M == BaseMotion::fixed && is_static<Topology>)
      if (shape.method == Method::taylor) return make.template operator()<TaylorSeries<Pack<W>>>();
    return shape.method == Method::dop853 ? make.template operator()<DormandPrince853<Pack<W>>>()
                                          : make.template operator()<DormandPrince5<Pack<W>>>();
  });
}

} // namespace wingspread
