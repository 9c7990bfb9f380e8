/// Many runs of one structure through the lanes of an engine of packs: a lane whose run has ended
/// takes the next at once.
///
/// A run is asked only when a step ends it, or may hold an event or a peak; until then its state
/// lives in the engine, which goes from step to step by the expressions with which the run would.
/// What a run does is the same as alone, bit for bit.
#pragma once

#include "core/packs/instruction_set.hpp"
#include "core/packs/pack_engine.hpp"
#include "core/run/integrator.hpp"

#include <array>
#include <memory>
#include <optional>

namespace wingspread {

template <class Topology, BaseMotion M> class Lanes {
  using AnySystem = System<double, Topology, M>;

  struct Lane {
    Lane(const Wing<double>& structure, const Topology& topology, const Integration& how,
         const Goal& goal)
        : wing(structure), system(wing, topology, how.smoothing, work),
          run(system, how, goal, nobody) {}

    Observer nobody;
    Wing<double> wing;
    Workspace<double> work;
    AnySystem system;
    Integrator<double, Topology, M> run;
    long name = 0;
    bool busy = false;
  };

public:
  /// @param method of the engine
  Lanes(const Wing<double>& structure, const Topology& topology, PackEngine& engine, Method method,
        const Integration& how, const Goal& goal)
      : engine_(engine), method_(method), how_(how), goal_(goal) {
    for (int l = 0; l < engine.width(); ++l)
      lanes_[l] = std::make_unique<Lane>(structure, topology, how, goal);
  }

  /// @param next next(wing) sets a wing's numbers to those of the run that comes next and returns
  ///             its name; none when there are no more
  /// @param done done(name, outcome), in the order in which the runs end
  template <class Next, class Done> Occupancy run(Next&& next, Done&& done) {
    count_ = {};
    for (int l = 0; l < engine_.width(); ++l) refill(l, next, done);
    const long before = engine_.rounds();
    while (busy_ > 0) {
      const LaneSet asking = engine_.advance();
      for (int l = 0; l < engine_.width(); ++l)
        if (has(asking, l)) answer(l, next, done);
    }
    count_.tries = (engine_.rounds() - before) * engine_.width();
    return count_;
  }

private:
  /// The engine has come to a step of the lane that its run must know.
  template <class Next, class Done> void answer(int l, Next&& next, Done&& done) {
    Lane& lane = *lanes_[l];
    const Progress progress = engine_.progress(l);
    ++count_.looks;
    count_.busy += progress.tries + 1;
    lane.run.catch_up(progress, engine_.evaluations_per_try());
    if (progress.steps > 0) engine_.get_start(l, lane.run.step(), lane.run.forces().before());
    const auto& asked = lane.run.asked();
    engine_.get_end(l, *asked.x1, *asked.dxdt1, lane.work.forces);
    lane.run.take(lane.run.verdict_of(engine_.error(l)));
    carry_on(l, next, done);
  }

  /// Makes the steps that the engine cannot; then the lane is ready for it, with this run or the
  /// next.
  template <class Next, class Done> void carry_on(int l, Next&& next, Done&& done) {
    Lane& lane = *lanes_[l];
    for (; !lane.run.ended() && !lane.run.fits_pack(method_); ++count_.scalar)
      lane.run.take(lane.run.make_try());
    if (!lane.run.ended()) return show(l);
    done(lane.name, lane.run.outcome());
    refill(l, next, done);
  }

  template <class Next, class Done> void refill(int l, Next&& next, Done&& done) {
    Lane& lane = *lanes_[l];
    for (;;) {
      const std::optional<long> name = next(lane.wing);
      busy_ += (name ? 1 : 0) - (lane.busy ? 1 : 0);
      lane.busy = name.has_value();
      if (!name) return engine_.set_idle(l);
      lane.name = *name;
      lane.run.begin();
      for (; !lane.run.ended() && !lane.run.fits_pack(method_); ++count_.scalar)
        lane.run.take(lane.run.make_try());
      if (!lane.run.ended()) break;
      done(lane.name, lane.run.outcome());
    }
    engine_.set_wing(l, lane.wing);
    show(l);
  }

  /// Gives the engine what it needs for the run's next steps.
  void show(int l) {
    Lane& lane = *lanes_[l];
    const Tolerance tolerance = lane.run.tolerance();
    Watch watch;
    if (goal_.peak_moment) watch.moments = &lane.run.moments();
    if (goal_.peak_force)
      watch.forces = &lane.run.forces().peaks, watch.force_before = &lane.run.forces().before();
    watch.rtol = tolerance.rtol, watch.atol = tolerance.atol;
    watch.atol_of_interpolant = how_.atol;
    engine_.set_run(l, lane.work, lane.run.step(), watch, lane.run.stretch());
  }

  PackEngine& engine_;
  Method method_;
  const Integration& how_;
  const Goal& goal_;
  std::array<std::unique_ptr<Lane>, most_lanes> lanes_;
  Occupancy count_;
  int busy_ = 0; ///< lanes with a run
};

} // namespace wingspread
