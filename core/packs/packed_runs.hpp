/// Runs many runs of one structure in the lanes of an engine. A lane whose run has ended starts the
/// next run at once. Drives the protocol of lane_protocol.hpp for all lanes.
#pragma once

#include "core/packs/instruction_set.hpp"
#include "core/packs/pack_engine.hpp"
#include "core/packs/runs.hpp"
#include "core/run/integrator.hpp"

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

namespace wingspread {

template <class Topology, BaseMotion M> class PackedRuns {
  using AnySystem = System<double, Topology, M>;

  struct Lane {
    Lane(const Wing<double>& structure, const Integration& how, const Goal& goal,
         const Runs::Watch& watch)
        : wing(structure), system(wing, how.smoothing, work), run(system, how, goal, observer) {
      if (watch) observer = [this, &watch](const Sample& sample) { watch(name, sample); };
    }
    Lane(const Lane&) = delete; // the observer refers to it
    Lane& operator=(const Lane&) = delete;
    ~Lane() = default;

    Observer observer;
    Wing<double> wing;
    Workspace<double> work;
    AnySystem system;
    Integrator<double, Topology, M> run;
    long name = 0;
    Cause cause = Cause::start; ///< why the run is worked on outside the engine
    bool busy = false;
  };

public:
  /// @param method of the engine
  /// @param watch sees the samples of all runs, if given; outlives this object
  PackedRuns(const Wing<double>& structure, PackEngine& engine, Method method,
             const Integration& how, const Goal& goal, const Runs::Watch& watch)
      : engine_(engine), method_(method) {
    for (int l = 0; l < engine.width(); ++l)
      lanes_[l] = std::make_unique<Lane>(structure, how, goal, watch);
  }

  /// Makes all runs.
  /// @param next next(wing) sets a wing's numbers to those of the next run and returns the run's
  ///             name; nothing when there are no more
  /// @param done done(name, outcome), called in the order in which the runs end
  template <class Next, class Done> Occupancy run(Next&& next, Done&& done) {
    count_ = {};
    mark_ = std::chrono::steady_clock::now();
    for (int l = 0; l < engine_.width(); ++l) start_next(l, next, done);
    const long before = engine_.rounds();
    while (busy_ > 0) {
      const LaneSet asking = engine_.advance();
      count_.in_lanes += since_mark();
      for (int l = 0; l < engine_.width(); ++l)
        if (has(asking, l)) resume(l, next, done);
    }
    count_.trial_steps = (engine_.rounds() - before) * engine_.width();
    return count_;
  }

private:
  /// Lets the lane's run judge the last trial step, and goes on with that run or the next.
  template <class Next, class Done> void resume(int l, Next&& next, Done&& done) {
    Lane& lane = *lanes_[l];
    LaneResult result = lane.run.empty_lane_result();
    engine_.unload(l, result);
    ++count_.returns;
    count_.busy += result.trial_steps + 1;
    if (!lane.run.is_inside_a_step()) lane.cause = engine_.cause(l);
    lane.run.resume(result);
    if (reaches_lane(lane)) return load(l);
    done(lane.name, lane.run.outcome());
    count_time(lane.cause);
    start_next(l, next, done);
  }

  /// Starts the next runs, until one needs the lane's steps or there are no more.
  template <class Next, class Done> void start_next(int l, Next&& next, Done&& done) {
    Lane& lane = *lanes_[l];
    while (draw_next(lane, next)) {
      lane.run.begin();
      lane.cause = Cause::start;
      if (reaches_lane(lane)) {
        engine_.set_wing(l, lane.wing);
        return load(l);
      }
      done(lane.name, lane.run.outcome());
      count_time(lane.cause);
    }
    engine_.set_idle(l);
  }

  void load(int l) {
    engine_.load(l, lanes_[l]->run.lane_task());
    count_time(lanes_[l]->cause);
  }

  /// @return wall-clock time since the last call, s
  [[nodiscard]] double since_mark() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(mark_, now)).count();
  }
  void count_time(Cause cause) { count_.outside[static_cast<std::size_t>(cause)] += since_mark(); }

  /// @return whether there is a next run; the lane then has its wing
  template <class Next> [[nodiscard]] bool draw_next(Lane& lane, Next&& next) {
    const std::optional<long> name = next(lane.wing);
    busy_ += (name ? 1 : 0) - (lane.busy ? 1 : 0);
    lane.busy = name.has_value();
    lane.name = name.value_or(0);
    return lane.busy;
  }

  /// Makes steps outside the engine until the engine can make the next one.
  /// @return false if the run has ended before
  [[nodiscard]] bool reaches_lane(Lane& lane) {
    if (lane.run.ended() || lane.run.fits_lane(method_)) return !lane.run.ended();
    count_time(lane.cause);
    for (; !lane.run.ended() && !lane.run.fits_lane(method_); ++count_.scalar) lane.run.make_step();
    count_time(Cause::method);
    return !lane.run.ended();
  }

  PackEngine& engine_;
  Method method_;
  std::array<std::unique_ptr<Lane>, most_lanes> lanes_;
  Occupancy count_;
  std::chrono::steady_clock::time_point mark_; ///< up to which time is counted
  int busy_ = 0;                               ///< lanes with a run
};

} // namespace wingspread
