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

template <class Topology, BaseMotion M> class PackedRuns {
  using AnySystem = System<double, Topology, M>;

  struct Lane {
    Lane(const Wing<double>& structure, const Integration& how, const Goal& goal)
        : wing(structure), system(wing, how.smoothing, work), run(system, how, goal, nobody) {}

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
  PackedRuns(const Wing<double>& structure, PackEngine& engine, Method method,
             const Integration& how, const Goal& goal)
      : engine_(engine), method_(method) {
    for (int l = 0; l < engine.width(); ++l)
      lanes_[l] = std::make_unique<Lane>(structure, how, goal);
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
    const Carried carried = engine_.hand_back(l, lane.run.place());
    ++count_.looks;
    count_.busy += carried.tries + 1;
    lane.run.take_back(carried);
    if (can_be_carried(lane)) return engine_.carry(l, lane.run.hand_over());
    done(lane.name, lane.run.outcome());
    refill(l, next, done);
  }

  /// Begins the runs that come next, until one can be carried or there are no more.
  template <class Next, class Done> void refill(int l, Next&& next, Done&& done) {
    Lane& lane = *lanes_[l];
    while (takes_next(lane, next)) {
      lane.run.begin();
      if (can_be_carried(lane)) {
        engine_.set_wing(l, lane.wing);
        return engine_.carry(l, lane.run.hand_over());
      }
      done(lane.name, lane.run.outcome());
    }
    engine_.set_idle(l);
  }

  template <class Next> [[nodiscard]] bool takes_next(Lane& lane, Next&& next) {
    const std::optional<long> name = next(lane.wing);
    busy_ += (name ? 1 : 0) - (lane.busy ? 1 : 0);
    lane.busy = name.has_value();
    lane.name = name.value_or(0);
    return lane.busy;
  }

  /// Makes the steps that the engine cannot. @return false if the run has ended with them
  [[nodiscard]] bool can_be_carried(Lane& lane) {
    for (; !lane.run.ended() && !lane.run.can_be_carried(method_); ++count_.scalar) lane.run.go();
    return !lane.run.ended();
  }

  PackEngine& engine_;
  Method method_;
  std::array<std::unique_ptr<Lane>, most_lanes> lanes_;
  Occupancy count_;
  int busy_ = 0; ///< lanes with a run
};

} // namespace wingspread
