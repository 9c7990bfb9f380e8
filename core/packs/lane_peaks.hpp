/// Peaks of moments and forces of the runs in the lanes.
///
/// A moment that only rises or only falls over a step is largest at one of the step's ends, and so is
/// a force whose samples rise steeply to an end. The lanes raise such peaks themselves, by the run's
/// own expressions (core/peaks). When a maximum may lie inside a step, the lane needs its run.
#pragma once

#include "core/packs/fields.hpp"
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
    for (std::vector<Mask>* v : {&may_rise_, &may_rise_inside_, &hold_may_rise_inside_})
      v->assign(at.bodies + 1, Mask{});
    forces_ = holds_ = raised_moments_ = raised_forces_ = raised_holds_ = moments_;
    before_.assign(at.bodies + 1, none), at_end_.assign(at.bodies + 1, {none, none});
    levers_.assign(at.bodies + 1, {none, none, {none, none}, none});
    samples_.resize(at.bodies);
    locked_.reserve(2UL * static_cast<std::size_t>(at.bodies));
    for (State<P>* x : {&x_, &dxdt_}) x->assign(at.size(), none);
    sampled_ = evaluations_ = none;
  }

  /// Constants of the bodies for bounds of the forces (reaction_bound.hpp). The caller sets them for each new run, if
  /// forces are asked for.
  [[nodiscard]] std::vector<Lever<P>>& levers() { return levers_; }

  void load(int lane, const LaneTask& task) {
    const PeakOf<double> none;
    for (std::size_t i = 1; i < moments_.size(); ++i) {
      set_lane(lane, moments_[i], task.moments ? task.moments[i] : none);
      set_lane(lane, forces_[i], task.forces ? task.forces[i] : none);
      set_lane(lane, holds_[i], task.holds ? task.holds[i] : none);
      before_[i].v[lane] = task.force_before ? task.force_before[i] : 0;
    }
    evaluations_.v[lane] = 0;
  }

  /// @param moved whether the lane's state is no longer that of the task
  void unload(int lane, LaneResult& result, bool moved) const {
    for (std::size_t i = 1; i < moments_.size(); ++i) {
      if (shape_.moments && moved) get_lane(lane, moments_[i], result.moments[i]);
      if (shape_.holds && moved) get_lane(lane, holds_[i], result.holds[i]);
      if (!shape_.forces) continue;
      get_lane(lane, at_end_[i], result.forces_at_end[i]);
      if (!moved) continue;
      get_lane(lane, forces_[i], result.forces[i]);
      result.force_before[i] = before_[i].v[lane];
    }
  }

  /// Evaluations made in a lane since `load`, beside those of its steps.
  [[nodiscard]] long evaluations(int lane) const { return static_cast<long>(evaluations_.v[lane]); }

  /// Keeps the forces at the end of a trial step. @pre the system's last evaluation was there
  void keep_forces_at_end(const AnySystem& system) {
    if (!shape_.forces) return;
    at_end_ = system.work().forces;
    samples_.keep(system, samples_.last);
    for (std::size_t i = 1; i < before_.size(); ++i)
      samples_.of(static_cast<int>(i))[0] = before_[i];
  }

  /// Raises the peaks of the accepted lanes to the loads at the step's ends; `accept` keeps the raised peaks.
  /// @return lanes in which a peak may lie inside the step
  /// @param asks lanes that need their runs in any case: their loads and forces are not sampled
  /// @param held_before moments on stuck hinges at the step's start; those at its end are the system's last
  [[nodiscard]] Mask search_step(AnySystem& system, const Step<P>& step, const Mask& accepted,
                                 const Mask& asks, const std::vector<P>& held_before) {
    rises_ = samples_made_ = held_is_bounded_ = false;
    locked_.clear();
    Mask in_doubt{};
    if (shape_.moments) in_doubt = search_moments(system, step, accepted, held_before);
    if (shape_.holds && system.work().locked > 0) search_holds(system, step, accepted, held_before);
    if (!locked_.empty())
      in_doubt = in_doubt || search_locked(system, step, accepted && !(asks || in_doubt));
    asks_for_moments_ = in_doubt;
    force_may_rise_ = accepted;
    if (shape_.forces && system.wing().plates.empty())
      in_doubt = in_doubt || search_forces(system, step, accepted, asks || in_doubt);
    return in_doubt;
  }

  /// Copies how peaks may rise over the last step out of a lane in which search_step searched it.
  void unload_search(int lane, LaneResult& result) const {
    for (std::size_t i = 1; shape_.moments && i < may_rise_.size(); ++i) {
      const Rise at_most = may_rise_inside_[i].bits[lane] != 0 ? Rise::inside : Rise::to_ends;
      (*result.moments_rise)[i] = may_rise_[i].bits[lane] != 0 ? at_most : Rise::none;
    }
    for (std::size_t i = 1; shape_.holds && i < result.holds_rise->size(); ++i)
      (*result.holds_rise)[i] =
          hold_may_rise_inside_[i].bits[lane] != 0 ? Rise::inside : Rise::to_ends;
    result.forces_may_rise = force_may_rise_.bits[lane] != 0;
  }

  /// Whether a moment's peak may lie inside the last step of a lane.
  [[nodiscard]] bool asks_for_moment(int lane) const { return asks_for_moments_.bits[lane] != 0; }

  /// Keeps the raised peaks in these lanes.
  void accept(const Mask& these) {
    if (shape_.forces)
      for (std::size_t i = 1; i < before_.size(); ++i)
        before_[i] = select(these, samples_.of(static_cast<int>(i))[samples_.last], before_[i]);
    if (rises_)
      for (std::size_t i = 1; i < moments_.size(); ++i) {
        assign_where(these, moments_[i], raised_moments_[i]);
        assign_where(these, forces_[i], raised_forces_[i]);
        assign_where(these, holds_[i], raised_holds_[i]);
      }
    if (samples_made_) evaluations_ = evaluations_ + select(these, sampled_, P(0.0));
  }

private:
  /// Copies the peaks before the first of a step rises: most steps raise none.
  void begin_to_raise() {
    if (rises_) return;
    rises_ = true;
    raised_moments_ = moments_, raised_forces_ = forces_, raised_holds_ = holds_;
  }

  [[nodiscard]] Mask search_moments(const AnySystem& system, const Step<P>& step,
                                    const Mask& accepted, const std::vector<P>& held_before) {
    Mask asks{};
    for (int i = 1; i < static_cast<int>(moments_.size()); ++i) {
      may_rise_[i] = may_rise_inside_[i] = Mask{};
      Mask slides = accepted;
      if (system.work().locked > 0) {
        const Mask locked = system.is_locked(i);
        search_held_moment(system, step, i, accepted && locked, held_before[i]);
        slides = accepted && !locked;
      }
      const MomentOverStep<P, AnySystem> moment(system, step, i);
      const Mask rises = slides && !(moment.most() <= moments_[i].value);
      if (!any(rises)) continue;
      const Mask keeps = moment.keeps_direction();
      may_rise_[i] = may_rise_[i] || (rises && keeps);
      Mask to_ends = rises && keeps;
      if (const Mask turns = rises && !keeps; any(turns)) {
        const std::array<P, 9> samples = moment_samples<P>(moment);
        const Mask near = turns && !(most_by_samples(samples) <= moments_[i].value);
        may_rise_[i] = may_rise_[i] || near;
        const Mask to_end = near && rises_to_end(samples, moment, step);
        to_ends = to_ends || to_end;
        may_rise_inside_[i] = may_rise_inside_[i] || (near && !to_end);
        asks = asks || (near && !to_end);
      }
      if (!any(to_ends)) continue;
      begin_to_raise();
      PeakOf<P> peak = moments_[i];
      raise_to_ends(peak, moment, step);
      assign_where(to_ends, raised_moments_[i], peak);
    }
    return asks;
  }

  /// The lanes in which raise_moment finds the peak at the step's end, within rounding of the time too.
  template <class Moment>
  [[nodiscard]] static Mask rises_to_end(const std::array<P, 9>& samples, const Moment& moment,
                                         const Step<P>& step) {
    if (!any(samples.back() > samples.front())) return Mask{};
    const P end = ((step.t + step.h) - step.t) / step.h;
    return end > P(1 - next_to_an_end) &&
           wingspread::rises_to_end(samples, [&](const P& s) { return P(abs(moment(s))); });
  }

  /// As raise_held_moment.
  void search_held_moment(const AnySystem& system, const Step<P>& step, int i, const Mask& these,
                          const P& held_before) {
    if (!any(these)) return;
    const Mask may = these && held_moment_may_rise(moments_[i], system, step, i);
    may_rise_[i] = may;
    if (!any(may)) return;
    if (!held_is_bounded_) held_.over_step(system, step);
    held_is_bounded_ = true;
    const P first = abs(held_before), last = abs(system.work().holding[i]);
    const P close = negligible(moments_[i], held_, i);
    if (any(may && wants_samples(first, last, Bulge<P>{held_.rise(i)}, moments_[i].value, close)))
      held_.narrow(system, step, i);
    begin_to_raise();
    PeakOf<P> peak = moments_[i];
    peak.raise(first, step.t);
    peak.raise(last, step.t + step.h);
    assign_where(may, raised_moments_[i], peak);
    may_rise_inside_[i] =
        add_locked({i, false, first, last, Bulge<P>{held_.rise(i)}, moments_[i].value, close, may});
  }

  /// As PeakSearch::doubtful_hold.
  void search_holds(const AnySystem& system, const Step<P>& step, const Mask& accepted,
                    const std::vector<P>& held_before) {
    for (int i = 1; i < static_cast<int>(holds_.size()); ++i) {
      const Mask held = accepted && system.is_held(i);
      hold_may_rise_inside_[i] = Mask{};
      if (!any(held)) continue;
      if (!held_is_bounded_) held_.over_step(system, step);
      held_is_bounded_ = true;
      const P first = abs(held_before[i] - system.sliding_moment(step.x, i));
      const P last = abs(system.work().holding[i] - system.sliding_moment(step.x1, i));
      const P close = negligible(holds_[i], held_, i);
      const Bulge<P> widest{held_.most_friction(i)};
      if (any(held && wants_samples(first, last, widest, holds_[i].value, close)))
        held_.narrow(system, step, i);
      begin_to_raise();
      PeakOf<P> peak = holds_[i];
      peak.raise(first, step.t);
      peak.raise(last, step.t + step.h);
      assign_where(held, raised_holds_[i], peak);
      hold_may_rise_inside_[i] = add_locked(
          {i, true, first, last, Bulge<P>{held_.most_friction(i)}, holds_[i].value, close, held});
    }
  }

  /// The load of a locked hinge over a step, as raise_locked_load has it.
  struct LockedLoad {
    int hinge;
    bool of_hold; ///< what its hold bears; else the moment across the hinge
    P first, last;
    Bulge<P> rise;
    P peak, close;
    Mask wants; ///< lanes that want samples
    std::array<P, 3> inside{};
  };

  /// Keeps the load if any lane wants samples of it. @return the lanes that do
  Mask add_locked(LockedLoad load) {
    load.wants =
        load.wants && wants_samples(load.first, load.last, load.rise, load.peak, load.close);
    if (any(load.wants)) locked_.push_back(load);
    return load.wants;
  }

  /// Samples the loads of locked hinges that want it. @return lanes in which a load may be larger inside the step
  [[nodiscard]] Mask search_locked(AnySystem& system, const Step<P>& step, const Mask& these) {
    Mask asks{}, wants{};
    for (LockedLoad& load : locked_) {
      load.wants = load.wants && these;
      if (load.of_hold && !system.wing().loops.empty()) asks = asks || load.wants;
      wants = wants || load.wants;
    }
    if (!any(wants && !asks)) return asks;
    constexpr auto& places = StepInterpolant<P>::first_places;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const P s(places[k]);
      interpolate(system, step, s, x_);
      system(x_, dxdt_, step.t + s * step.h);
      for (LockedLoad& load : locked_)
        load.inside[k] = abs(load.of_hold ? system.locking_moment(x_, load.hinge)
                                          : system.work().holding[load.hinge]);
    }
    if (!samples_made_) sampled_ = P(0.0);
    samples_made_ = true;
    for (const LockedLoad& load : locked_) {
      std::array<Sampled<P>, 5> samples{{{P(0.0), load.first}, {}, {}, {}, {P(1.0), load.last}}};
      for (std::size_t k = 0; k < places.size(); ++k)
        samples[k + 1] = {P(places[k]), load.inside[k]};
      asks = asks || (load.wants && may_crest_between(samples, load.rise, load.peak, load.close));
    }
    sampled_ = sampled_ + select(wants, P(static_cast<double>(places.size())), P(0.0));
    return asks;
  }

  /// As ForcePeaks::over_step. @param asks lanes whose forces are not sampled
  [[nodiscard]] Mask search_forces(AnySystem& system, const Step<P>& step, const Mask& accepted,
                                   const Mask& asks) {
    if (!any(accepted)) return Mask{};
    samples_.begin(system, levers_, step);
    force_may_rise_ = accepted && samples_.may_rise(forces_);
    Mask open = force_may_rise_ && !asks;
    if (!any(open)) return Mask{};
    sample(system, step, samples_.middle, open);
    open = open && samples_.may_rise_in_a_half(forces_);
    if (!any(open)) return Mask{};
    for (const int k : {1, 3}) sample(system, step, k, open);
    begin_to_raise();
    Mask in_doubt{};
    for (int i = 1; i < static_cast<int>(forces_.size()); ++i) {
      PeakOf<P> peak = forces_[i];
      samples_.raise_to_ends(i, step, peak);
      for (int k = 0; k <= samples_.last; ++k)
        in_doubt = in_doubt || (open && samples_.wants_search(i, k, peak));
      assign_where(open, raised_forces_[i], peak);
    }
    return in_doubt;
  }

  /// Evaluates the forces at k quarters of the step. @param open lanes whose runs alone would evaluate them: only these
  /// count the evaluation
  void sample(AnySystem& system, const Step<P>& step, int k, const Mask& open) {
    if (!samples_made_) sampled_ = P(0.0);
    samples_made_ = true;
    const P s = P(static_cast<double>(k)) / P(4.0);
    interpolate(system, step, s, x_);
    system(x_, dxdt_, step.t + s * step.h);
    samples_.keep(system, k);
    sampled_ = sampled_ + select(open, P(1.0), P(0.0));
  }

  PackShape shape_;
  std::vector<PeakOf<P>> moments_, forces_, holds_; ///< 1 … n: up to the step's start
  std::vector<PeakOf<P>> raised_moments_, raised_forces_,
      raised_holds_; ///< up to its end, if rises_
  Mask asks_for_moments_{};
  Mask force_may_rise_{}; ///< lanes in which any force may rise over this step
  // 1 … n: lanes in which a peak may rise over this step
  std::vector<Mask> may_rise_;                ///< a moment's
  std::vector<Mask> may_rise_inside_;         ///< a moment's, perhaps inside the step
  std::vector<Mask> hold_may_rise_inside_;    ///< what a hold bears, perhaps inside the step
  bool rises_ = false, samples_made_ = false; ///< in any lane, over this step
  HeldLoadBound<P> held_;
  bool held_is_bounded_ = false;   ///< over this step
  std::vector<LockedLoad> locked_; ///< those that want samples over this step
  std::vector<P> before_;          ///< forces at the step's start
  std::vector<Vec2<P>> at_end_;    ///< and at its end
  std::vector<Lever<P>> levers_;
  ForceSamples<P> samples_;
  P sampled_;     ///< evaluations made by the search of this step
  P evaluations_; ///< by all searches since `load`
  State<P> x_, dxdt_;
};

} // namespace wingspread
