/// The largest moments and forces of the runs in the lanes, for as long as the ends of steps tell them.
///
/// A moment that only rises or only falls over a step is largest at one of its ends, and so is a force
/// whose samples rise to an end steeply: such peaks the lanes keep themselves, by the expressions with
/// which the run would (core/peaks). Where a maximum inside a step must be sought, the run is asked.
#pragma once

#include "core/packs/pack_engine.hpp"
#include "core/peaks/force_samples.hpp"
#include "core/peaks/moment_peaks.hpp"

#include <vector>

namespace wingspread {

template <class P, class AnySystem> class LanePeaks {
  using Mask = typename P::Mask;

public:
  explicit LanePeaks(const PackShape& shape) : shape_(shape) {}

  void resize(const Layout& at) {
    const P none(0.0);
    moments_.assign(at.bodies + 1, {none, none});
    forces_ = raised_moments_ = raised_forces_ = moments_;
    before_.assign(at.bodies + 1, none), at_end_.assign(at.bodies + 1, {none, none});
    levers_.assign(at.bodies + 1, {none, none, {none, none}, none});
    samples_.resize(at.bodies);
    for (State<P>* x : {&x_, &dxdt_}) x->assign(at.size(), none);
    sampled_ = kept_ = none;
  }

  /// A new run takes the lane. @param levers of its wing, where forces are asked for
  [[nodiscard]] std::vector<Lever<P>>& levers() { return levers_; }

  /// Takes the lane's run from where it stands.
  void carry(int lane, const Handover& run) {
    const auto take = [lane](PeakOf<P>& to, const PeakOf<double>* from, int i) {
      to.value.v[lane] = from ? from[i].value : 0, to.time.v[lane] = from ? from[i].time : 0;
    };
    for (std::size_t i = 1; i < moments_.size(); ++i) {
      take(moments_[i], run.moments, static_cast<int>(i));
      take(forces_[i], run.forces, static_cast<int>(i));
      before_[i].v[lane] = run.force_before ? run.force_before[i] : 0;
    }
    kept_.v[lane] = 0;
  }

  /// @param carried whether the run was: if not, it knows where the step starts
  void hand_back(int lane, const Place& place, bool carried) const {
    for (std::size_t i = 1; i < moments_.size(); ++i) {
      if (shape_.moments && carried) give(lane, moments_[i], place.moments[i]);
      if (!shape_.forces) continue;
      place.forces_at_end[i] = {at_end_[i].x.v[lane], at_end_[i].y.v[lane]};
      if (!carried) continue;
      give(lane, forces_[i], place.forces[i]);
      place.force_before[i] = before_[i].v[lane];
    }
  }

  /// Evaluations made in a lane since its run was taken, beside those of its steps.
  [[nodiscard]] long evaluations(int lane) const { return static_cast<long>(kept_.v[lane]); }

  /// A step was tried, and the system's last evaluation was at its end.
  void end_step(const AnySystem& system) {
    if (!shape_.forces) return;
    at_end_ = system.work().forces;
    samples_.take(system, samples_.last);
    for (std::size_t i = 1; i < before_.size(); ++i)
      samples_.of(static_cast<int>(i))[0] = before_[i];
  }

  /// Looks for peaks in the lanes whose step was accepted. @return those in which one must be sought
  [[nodiscard]] Mask over_step(AnySystem& system, const Step<P>& step, const Mask& accepted) {
    rises_ = samples_made_ = false;
    Mask asks{};
    if (shape_.moments) asks = look_at_moments(system, step, accepted);
    if (shape_.forces && system.wing().plates.empty())
      asks = asks || look_at_forces(system, step, accepted && !asks);
    return asks;
  }

  /// These lanes go on from the end of the step. @return evaluations made in each for the look
  [[nodiscard]] P go_on(const Mask& these) {
    if (shape_.forces)
      for (std::size_t i = 1; i < before_.size(); ++i)
        before_[i] = select(these, samples_.of(static_cast<int>(i))[samples_.last], before_[i]);
    if (rises_)
      for (std::size_t i = 1; i < moments_.size(); ++i) {
        put(these, raised_moments_[i], moments_[i]);
        put(these, raised_forces_[i], forces_[i]);
      }
    if (!samples_made_) return P(0.0);
    const P made = select(these, sampled_, P(0.0));
    kept_ = kept_ + made;
    return made;
  }

private:
  static void give(int lane, const PeakOf<P>& from, PeakOf<double>& to) {
    to.value = from.value.v[lane], to.time = from.time.v[lane];
  }
  static void put(const Mask& these, const PeakOf<P>& from, PeakOf<P>& to) {
    to.value = select(these, from.value, to.value), to.time = select(these, from.time, to.time);
  }

  /// The first peaks of a step that rise: the others stay what they are.
  void begin_to_raise() {
    if (rises_) return;
    rises_ = true;
    raised_moments_ = moments_, raised_forces_ = forces_;
  }

  [[nodiscard]] Mask look_at_moments(const AnySystem& system, const Step<P>& step,
                                     const Mask& accepted) {
    Mask asks{};
    for (int i = 1; i < static_cast<int>(moments_.size()); ++i) {
      const MomentOverStep<P, AnySystem> moment(system, step, i);
      const Mask rises = accepted && !(moment.most() <= moments_[i].value);
      if (!any(rises)) continue;
      const Mask keeps = moment.keeps_direction();
      asks = asks || (rises && !keeps);
      if (!any(rises && keeps)) continue;
      begin_to_raise();
      PeakOf<P> peak = moments_[i];
      raise_to_ends(peak, moment, step);
      put(rises && keeps, peak, raised_moments_[i]);
    }
    return asks;
  }

  /// As ForcePeaks::over_step.
  [[nodiscard]] Mask look_at_forces(AnySystem& system, const Step<P>& step, const Mask& accepted) {
    if (!any(accepted)) return Mask{};
    samples_.begin(system, levers_, step);
    Mask open = accepted && samples_.may_rise(forces_);
    if (!any(open)) return Mask{};
    sample(system, step, samples_.middle, open);
    open = open && samples_.may_rise_in_a_half(forces_);
    if (!any(open)) return Mask{};
    for (const int k : {1, 3}) sample(system, step, k, open);
    begin_to_raise();
    Mask asks{};
    for (int i = 1; i < static_cast<int>(forces_.size()); ++i) {
      PeakOf<P> peak = forces_[i];
      samples_.raise_to_ends(i, step, peak);
      for (int k = 0; k <= samples_.last; ++k)
        asks = asks || (open && samples_.wants_search(i, k, peak));
      put(open, peak, raised_forces_[i]);
    }
    return asks;
  }

  /// At k quarters of the step. @param open lanes whose runs would do so
  void sample(AnySystem& system, const Step<P>& step, int k, const Mask& open) {
    if (!samples_made_) sampled_ = P(0.0);
    samples_made_ = true;
    const P s = P(static_cast<double>(k)) / P(4.0);
    step.interpolate(system.layout(), s, x_);
    system(x_, dxdt_, step.t + s * step.h);
    samples_.take(system, k);
    sampled_ = sampled_ + select(open, P(1.0), P(0.0));
  }

  PackShape shape_;
  std::vector<PeakOf<P>> moments_, forces_; ///< 1 … n: so far
  /// The same with the step that is looked at, where `rises_`.
  std::vector<PeakOf<P>> raised_moments_, raised_forces_;
  bool rises_ = false, samples_made_ = false;
  std::vector<P> before_;       ///< forces at the step's start
  std::vector<Vec2<P>> at_end_; ///< and at its end
  std::vector<Lever<P>> levers_;
  ForceSamples<P> samples_;
  P sampled_, kept_; ///< evaluations made for looks: of this step, and since the run was taken
  State<P> x_, dxdt_;
};

} // namespace wingspread
