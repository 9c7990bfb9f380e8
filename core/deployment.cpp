#include "core/deployment.hpp"

#include "core/methods/dop853.hpp"
#include "core/methods/method_choice.hpp"
#include "core/packs/runs.hpp"
#include "core/proofs/natural_modes.hpp"
#include "core/scene/segments.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace wingspread {

const std::vector<MethodInfo>& methods() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  static const std::string quintic = "quintic Hermite on angle, rate and acceleration, order 5; "
                                     "events and peaks are then corrected by a step of the method";
  static const std::string quintic_of_long_steps =
      quintic + "; steps limited to about a quarter of what oscillates";
  static const std::vector<MethodInfo> list{
      {"auto", "chooses by itself", 0, 0, 0, "that of the method active",
       "the default: dop853, or dopri5 above rtol 5e-3 (5e-4 with smoothed latches), or taylor "
       "below "
       "5e-5 where the motion has series; seulex where stability holds their steps back and seulex "
       "gets further; the outcome's phases say which method was used when"},
      {"runge_kutta4", "explicit Runge-Kutta, fixed step", 4, RungeKutta4<double>::stable_real,
       RungeKutta4<double>::stable_imaginary, quintic,
       "takes the given step; fails if the step misses the tolerance, by comparison with one of "
       "twice the size"},
      {"cash_karp54", "explicit Runge-Kutta, adaptive", 5, CashKarp54<double>::stable_real,
       CashKarp54<double>::stable_imaginary, quintic,
       "Cash and Karp 5(4); grows on the imaginary axis at any step, by 1.4e-4 |hλ|⁶"},
      {"dopri5", "explicit Runge-Kutta, adaptive", 5, DormandPrince5<double>::stable_real,
       DormandPrince5<double>::stable_imaginary, quintic,
       "Dormand and Prince 5(4), first same as last"},
      {"fehlberg78", "explicit Runge-Kutta, adaptive", 8, Fehlberg78<double>::stable_real,
       Fehlberg78<double>::stable_imaginary, quintic_of_long_steps,
       "Fehlberg 8(7); its error estimate uses only the ends of a step and may miss friction that "
       "changes sign inside: prefer dop853"},
      {"dop853", "explicit Runge-Kutta, adaptive", 8, DormandPrince853<double>::stable_real,
       DormandPrince853<double>::stable_imaginary, quintic_of_long_steps,
       "Dormand and Prince 8(5,3), for tight tolerances"},
      {"bulirsch_stoer", "explicit extrapolation, adaptive order and step", 0, 0, 0,
       quintic_of_long_steps,
       "modified midpoint rule, orders 4 to 16; stable on the real axis up to 4.457 at order 4, "
       "5.995 at order 10"},
      {"adams_bashforth_moulton", "explicit multistep, adaptive order and step", 0, 0, 0,
       quintic_of_long_steps,
       "orders 1 to 8, predict-evaluate-correct-evaluate; at equal steps stable up to 1.4 on the "
       "real axis, 0.5 on the imaginary"},
      {"rosenbrock_w", "linearly implicit Rosenbrock-W, adaptive", 3, infinity, infinity, quintic,
       "ROS34PW2 3(2), L-stable; its linear solve is the recursion with inertia added at each "
       "hinge"},
      {"seulex", "linearly implicit extrapolation, adaptive order and step", 0, infinity, 0,
       quintic_of_long_steps,
       "linearly implicit Euler with n = 2, 3, 4, … substeps, orders 3 to 12, the same linear "
       "solve; "
       "L-stable, except that it grows by up to 2 % a step within 0.2° of the imaginary axis"},
      {"taylor", "power series, adaptive", TaylorSeries<double>::order,
       TaylorSeries<double>::stable_real, TaylorSeries<double>::stable_imaginary,
       quintic_of_long_steps,
       "only for up to four panels in a row on a fixed base, with event latches, without gravity, "
       "air, friction and real hinges; other wings get dop853 in its place"},
  };
  return list;
}

struct Deployment::Kept {
  std::vector<std::pair<int, int>> tree; ///< (parent, child) of every hinge of the last scene
  Wing<double> wing;
  Workspace<double> scratch;
};

Deployment::Deployment() : kept_(std::make_unique<Kept>()) {}
Deployment::~Deployment() = default;
Deployment::Deployment(Deployment&&) noexcept = default;
Deployment& Deployment::operator=(Deployment&&) noexcept = default;

namespace {

/// The fastest version that this processor can execute.
const Runs& runs() {
#ifdef WINGSPREAD_FMA_RUNS
  static const Runs& best = has_avx2() ? fma_runs() : plain_runs();
  return best;
#else
  return plain_runs();
#endif
}

[[nodiscard]] Outcome invalid(const std::vector<Fault>& faults) {
  Outcome out;
  out.status = Status::invalid;
  for (const Fault& fault : faults) {
    if (!out.reason.empty()) out.reason += "; ";
    out.reason += fault.path + " is " + fault.found + ", expected " + fault.expected;
  }
  return out;
}

template <class Value> void keep_first(std::vector<Value>& all, std::size_t count) {
  if (all.size() > count) all.resize(count);
}

/// The hinges at the ends of flexible body b, on its first and last segment: their moments are the panel's own there.
[[nodiscard]] std::vector<int> end_hinges(const SegmentedScene& made, std::size_t b) {
  const int first = made.segments[b].front(), last = made.segments[b].back();
  std::vector<int> found;
  for (int hinge = 0; hinge < std::ssize(made.joints); ++hinge) // a tree has as many as bodies
    for (const int on : {made.scene.hinges[hinge].parent, made.scene.hinges[hinge].child})
      if (on == first || on == last) found.push_back(hinge);
  return found;
}

/// Converts the outcome of a segmented scene to the given scene: drops the joints, but keeps the largest moment in the
/// joints and at the ends of each flexible body. The innermost joint alone is half an element away from a clamped end,
/// where the moment is largest: its error would be about 1/joints.
[[nodiscard]] Outcome without_joints(const SegmentedScene& made, Outcome&& out) {
  const std::size_t bodies = made.joints.size(), hinges = bodies; // a tree has as many
  if (!out.peak_moment.empty()) {
    out.bending_moment.resize(bodies);
    for (std::size_t b = 0; b < bodies; ++b) {
      if (made.joints[b].empty()) continue;
      for (const std::vector<int>& places : {made.joints[b], end_hinges(made, b)})
        for (const int place : places)
          if (const Peak& peak = out.peak_moment[place]; peak.value > out.bending_moment[b].value)
            out.bending_moment[b] = peak;
    }
  }
  for (LatchEvent& latch : out.latches) keep_first(latch.rates, hinges);
  keep_first(out.peak_moment, hinges), keep_first(out.peak_force, hinges);
  keep_first(out.hold_moment, hinges), keep_first(out.overtravel, hinges);
  keep_first(out.final_angle, hinges), keep_first(out.motor_energy, hinges);
  keep_first(out.final.angles, hinges), keep_first(out.final.rates, hinges);
  return std::move(out);
}

/// An observer of the segmented scene that passes samples without joints to `observer`.
[[nodiscard]] Observer without_joints(std::size_t hinges, const Observer& observer) {
  if (!observer) return {};
  return [hinges, &observer](Sample sample) {
    for (std::vector<double>* all : {&sample.angles, &sample.rates, &sample.moments})
      keep_first(*all, hinges);
    observer(sample);
  };
}

} // namespace

Outcome Deployment::run(const Scene& scene, const Integration& integration, const Goal& goal,
                        const Observer& observer) {
  if (const std::vector<Fault> faults = unphysical(scene); !faults.empty()) return invalid(faults);
  if (goal.mode_frequencies) {
    Goal others = goal;
    others.mode_frequencies = false;
    Outcome out = run(scene, integration, others, observer);
    out.mode_frequencies = natural_frequencies(scene);
    return out;
  }
  if (has_flexible_bodies(scene)) {
    const SegmentedScene made = with_segments(scene);
    return without_joints(
        made, run(made.scene, integration, goal, without_joints(scene.hinges.size(), observer)));
  }
  if (integration.smoothing && hinge_with_event_latch(scene)) {
    Outcome out; // status failed
    out.reason = needs_event_latches;
    return out;
  }
  std::vector<std::pair<int, int>> tree(scene.hinges.size());
  std::transform(scene.hinges.begin(), scene.hinges.end(), tree.begin(),
                 [](const Hinge& hinge) { return std::pair(hinge.parent, hinge.child); });
  if (tree != kept_->tree || !has_features_of(kept_->wing, scene)) {
    kept_->wing = make_wing<double>(scene, outward_order(scene));
    kept_->tree = std::move(tree);
  }
  runs().set_parameters(kept_->wing, scene);
  Outcome outcome = runs().alone(kept_->wing, kept_->scratch, integration, goal, observer);
  name_held_hinges(scene, outcome);
  return outcome;
}

DeploymentPack::DeploymentPack(InstructionSet set, const Integration& integration, const Goal& goal)
    : set_(set), how_(integration), goal_(goal) {}

namespace {

/// The observer of one run. @pre the watch outlives it
[[nodiscard]] Observer observer_of(long name, const DeploymentPack::Watch& watch) {
  if (!watch) return {};
  return [name, &watch](const Sample& sample) { watch(name, sample); };
}

/// Sorts runs by the method with which they begin: draws may give some wings friction, which excludes power series. An
/// engine has one method, so runs that need another are queued until the engine has made the rest, or the queue is
/// full.
class RunSorter {
public:
  RunSorter(const Integration& how, const Goal& goal, InstructionSet set, Scene& scene,
            const DeploymentPack::Next& next, const DeploymentPack::Done& done,
            const DeploymentPack::Watch& watch)
      : choices_(first_choices(how)), how_(how), goal_(goal), set_(set), scene_(scene),
        structure_(make_wing<double>(scene, outward_order(scene))), next_(next), done_(done),
        watch_(watch) {}

  [[nodiscard]] Occupancy run() {
    Occupancy all{};
    for (;;) {
      if (waiting_.empty()) {
        Wing<double> first = structure_;
        const std::optional<long> name = draw(first);
        if (!name) return all;
        waiting_.emplace_back(*name, first);
      }
      all += run_batch(method_of(waiting_.front().second));
    }
  }

private:
  /// Eight full packs of the widest engine: lanes that run empty at a batch's end cost little. Heuristic; smaller:
  /// engines alternate more often, each time with empty lanes; larger: memory.
  static constexpr std::size_t longest_queue = 64;

  [[nodiscard]] Method method_of(const Wing<double>& wing) const {
    return choices_[has_series(wing) ? 1 : 0].active();
  }

  /// Makes the queued runs, which all have this method, and draws more until the queue of others is full.
  [[nodiscard]] Occupancy run_batch(Method method) {
    std::vector<std::pair<long, Wing<double>>> these = std::exchange(waiting_, {});
    const PackShape shape{method,
                          goal_.peak_force,
                          goal_.peak_moment,
                          goal_.hold_moment && !structure_.releases.empty(),
                          goal_.motor_energy && !structure_.motors.empty(),
                          goal_.overtravel};
    const std::unique_ptr<PackEngine> engine = make_engine(set_, structure_, shape);
    const auto next_wing = [&](Wing<double>& wing) -> std::optional<long> {
      if (!these.empty()) {
        const long name = these.back().first;
        wing = these.back().second;
        these.pop_back();
        return name;
      }
      while (waiting_.size() < longest_queue) {
        const std::optional<long> name = draw(wing);
        if (!name || method_of(wing) == method) return name;
        waiting_.emplace_back(*name, wing);
      }
      return std::nullopt;
    };
    const auto done = [this](long name, Outcome&& outcome) {
      name_held_hinges(scene_, outcome);
      done_(name, std::move(outcome));
    };
    return runs().in_lanes(structure_, *engine, method, how_, goal_, next_wing, done, watch_);
  }

  /// Sets the wing's numbers to those of the next run and returns the run's name; nothing when there are no more. Runs
  /// that no engine can make are made or refused here.
  [[nodiscard]] std::optional<long> draw(Wing<double>& wing) {
    while (!exhausted_) {
      const std::optional<long> name = next_(scene_);
      exhausted_ = !name;
      if (!name) break;
      const std::vector<Fault> faults = unphysical(scene_);
      if (faults.empty() && has_features_of(structure_, scene_)) {
        runs().set_parameters(wing, scene_);
        return name;
      }
      done_(*name, faults.empty() ? alone_.run(scene_, how_, goal_, observer_of(*name, watch_))
                                  : invalid(faults));
    }
    return std::nullopt;
  }

  const FirstChoices choices_;
  const Integration& how_;
  const Goal& goal_;
  const InstructionSet set_;
  Scene& scene_;
  const Wing<double> structure_;
  const DeploymentPack::Next& next_;
  const DeploymentPack::Done& done_;
  const DeploymentPack::Watch& watch_;
  Deployment alone_;
  std::vector<std::pair<long, Wing<double>>> waiting_; ///< the queue, all of one method
  bool exhausted_ = false;
};

} // namespace

Occupancy DeploymentPack::run(Scene scene, const Next& next, const Done& done, const Watch& watch) {
  if (goal_.mode_frequencies) return run_with_modes(scene, next, done, watch);
  if (has_flexible_bodies(scene)) return run_segmented(scene, next, done, watch);
  const bool in_packs = set_ != InstructionSet::scalar && !how_.smoothing && !goal_.audit &&
                        has_lanes(MethodChoice(how_, false).active());
  if (in_packs) return RunSorter(how_, goal_, set_, scene, next, done, watch).run();
  Deployment alone;
  while (const std::optional<long> name = next(scene))
    done(*name, alone.run(scene, how_, goal_, observer_of(*name, watch)));
  return {};
}

Occupancy DeploymentPack::run_with_modes(const Scene& scene, const Next& next, const Done& done,
                                         const Watch& watch) {
  Goal others = goal_;
  others.mode_frequencies = false;
  std::map<long, std::vector<double>> frequencies; // of the runs in the lanes
  const Next next_with_modes = [&](Scene& drawn) {
    const std::optional<long> name = next(drawn);
    if (name) frequencies[*name] = natural_frequencies(drawn);
    return name;
  };
  return DeploymentPack(set_, how_, others)
      .run(
          scene, next_with_modes,
          [&](long name, Outcome&& outcome) {
            outcome.mode_frequencies = std::move(frequencies.extract(name).mapped());
            done(name, std::move(outcome));
          },
          watch);
}

Occupancy DeploymentPack::run_segmented(Scene scene, const Next& next, const Done& done,
                                        const Watch& watch) {
  const SegmentedScene first = with_segments(scene);
  Deployment alone;
  const Next next_segmented = [&](Scene& segmented) -> std::optional<long> {
    while (const std::optional<long> name = next(scene)) {
      if (unphysical(scene).empty()) {
        SegmentedScene made = with_segments(scene);
        if (have_same_tree(made.scene, first.scene)) {
          segmented = std::move(made.scene);
          return name;
        }
      }
      // The scene is unphysical, or a draw has moved a hinge to another segment, which gives another tree.
      done(*name, alone.run(scene, how_, goal_, observer_of(*name, watch)));
    }
    return std::nullopt;
  };
  const Done done_segmented = [&](long name, Outcome&& outcome) {
    done(name, without_joints(first, std::move(outcome)));
  };
  const std::size_t hinges = scene.hinges.size();
  Watch watch_segmented;
  if (watch)
    watch_segmented = [&watch, hinges](long name, const Sample& sample) {
      without_joints(hinges, observer_of(name, watch))(sample);
    };
  return run(first.scene, next_segmented, done_segmented, watch_segmented);
}

} // namespace wingspread
