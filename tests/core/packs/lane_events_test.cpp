// What lanes say of events in a step, against what the run alone finds there.
#include "core/events/events.hpp"
#include "core/packs/lane_events.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

using FourLanes = Pack<4>;
using RunAlone = System<double, Tree, BaseMotion::fixed>;
using RunsInLanes = System<FourLanes, Tree, BaseMotion::fixed>;

/// Three hinges with all that has events; the hold of one may wait for another's angle.
Scene eventful_scene(std::uint64_t seed) {
  Draws draws(seed);
  RandomScene options;
  options.bodies = 3, options.motion = BaseMotion::fixed;
  Scene scene = with_real_hinges(random_scene(seed, options), seed);
  for (Hinge& hinge : scene.hinges) {
    if (draws.chance(0.7)) rub(hinge, 0.1);
    if (draws.chance(0.2)) hinge.latch.reset();
    if (!hinge.latch) continue;
    if (draws.chance(0.3)) hinge.latch->capture_rate = 0.5;
    if (draws.chance(0.3)) hinge.latch->holding_moment = draws.log_uniform(1, 100);
  }
  if (draws.chance(0.5)) {
    const double way = std::abs(scene.hinges[1].latched - scene.hinges[1].stowed);
    scene.hinges[0].release = Release{
        .event = Release::Event::passed, .after = 1, .angle = way * draws.uniform(0.2, 0.8)};
  }
  return scene;
}

/// A run alone in the middle of a step, with latches engaged or not.
struct InStep {
  InStep(const Wing<double>& wing_of_run, Draws& draws, double swing)
      : wing(wing_of_run), system(wing, std::nullopt, work), events(system) {
    const Layout& at = system.layout();
    step.t = 2, step.h = draws.log_uniform(1e-3, 0.1);
    system.reset(), system.start(step.x);
    for (State<double>* x : {&step.dxdt, &step.x1, &step.dxdt1}) x->assign(at.size(), 0);
    std::vector<char> engages(at.bodies + 1);
    for (int i = 1; i <= at.bodies; ++i) {
      const int a = at.angle(i), r = at.rate(i);
      const double whole = wing.hinges[i].latched - wing.hinges[i].stowed;
      step.x[a] = wing.hinges[i].stowed + whole * draws.uniform(-0.2, 1.2);
      engages[i] = wing.hinges[i].has_latch && draws.chance(0.3);
      if (engages[i] && has_capture(wing, i) && wing.real[i].capture.may_let_go()) {
        const CaptureTerms<double>& latch = wing.real[i].capture; // further off it has let go
        const double furthest = std::min(0.1, latch.holding / latch.stiffness);
        step.x[a] = latch.start + latch.sense * furthest * draws.uniform(-0.9, 1);
      }
      step.x[r] = draws.uniform(-1, 1) * swing / step.h;
      step.x1[r] = step.x[r] + draws.uniform(-0.5, 0.5) * swing / step.h;
      step.dxdt[r] = draws.uniform(-1, 1) * swing / (step.h * step.h);
      step.dxdt1[r] = draws.uniform(-1, 1) * swing / (step.h * step.h);
      step.x1[a] = step.x[a] + 0.5 * step.h * (step.x[r] + step.x1[r]);
      step.dxdt[a] = step.x[r], step.dxdt1[a] = step.x1[r];
    }
    system.find_sides(step.x);
    events.start();
    for (int i = 1; i <= at.bodies; ++i) {
      if (engages[i] && !system.is_held(i)) system.engage(i);
      if (!wing.hinges[i].can_stick() || system.is_held(i)) continue;
      const double rate = step.x[at.rate(i)];
      system.set_contact(i, rate > 0 ? Contact::forward : Contact::backward);
    }
  }

  Wing<double> wing;
  Workspace<double> work;
  RunAlone system;
  Events<double, RunAlone> events;
  Step<double> step;
};

/// The same steps in lanes.
struct InLanes {
  explicit InLanes(const std::vector<std::unique_ptr<InStep>>& runs)
      : system(set_harmless(wing, runs[0]->wing), std::nullopt, work) {
    const Layout& at = system.layout();
    events.resize(at, wing.real.size());
    for (State<FourLanes>* x : {&step.x, &step.dxdt, &step.x1, &step.dxdt1})
      x->assign(at.size(), FourLanes(0.0));
    for (int lane = 0; lane < 4; ++lane) {
      const InStep& run = *runs[lane];
      set_lane(lane, wing, run.wing);
      events.load(lane, run.work);
      step.t.v[lane] = run.step.t, step.h.v[lane] = run.step.h;
      set_lane(lane, step.x, run.step.x), set_lane(lane, step.dxdt, run.step.dxdt);
      set_lane(lane, step.x1, run.step.x1), set_lane(lane, step.dxdt1, run.step.dxdt1);
      for (int i = 1; i <= at.bodies; ++i)
        work.locks[i].v[lane] = run.system.is_held(i) ? 2 : run.system.is_locked(i) ? 1 : 0;
    }
  }

  Wing<FourLanes> wing;
  Workspace<FourLanes> work;
  RunsInLanes system;
  LaneEvents<4> events;
  Step<FourLanes> step;
};

/// visit(runs, lanes) for many scenes. @param prepare prepare(run, draws) changes a run's step
template <class Prepare, class Visit>
void for_steps_in_lanes(double least_swing, double most_swing, Prepare&& prepare, Visit&& visit) {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    Draws draws(9100 + seed);
    const Scene scene = eventful_scene(seed);
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    std::vector<std::unique_ptr<InStep>> runs;
    for (int lane = 0; lane < 4; ++lane) {
      runs.push_back(
          std::make_unique<InStep>(wing, draws, draws.log_uniform(least_swing, most_swing)));
      prepare(*runs.back(), draws);
    }
    InLanes lanes(runs);
    CAPTURE(seed);
    visit(runs, lanes);
  }
}

template <class Mask> bool is_in(const Mask& mask, int lane) {
  const std::int64_t bits = mask.bits[lane];
  return bits != 0;
}

} // namespace

TEST_CASE("lanes exclude no event that the run alone finds in a step, and most steps without one") {
  std::array<int, 8> found{}; // by Event
  const EventSearch search{std::nullopt, false, nullptr};
  State<double> x, dxdt;
  for_steps_in_lanes(
      1e-3, 1, [](InStep&, Draws&) {},
      [&](const auto& runs, InLanes& lanes) {
        const auto may = lanes.events.lie_inside(lanes.system, lanes.step);
        for (int lane = 0; lane < 4; ++lane) {
          const auto due = runs[lane]->events.first(runs[lane]->step, x, dxdt, search);
          if (!due) continue;
          ++found[static_cast<int>(due->event)];
          CAPTURE(lane, static_cast<int>(due->event), due->hinge);
          CHECK(is_in(may, lane));
        }
      });
  for (const Event event : {Event::latch, Event::rest, Event::edge, Event::let_go, Event::seen}) {
    CAPTURE(static_cast<int>(event));
    CHECK(found[static_cast<int>(event)] >= 15);
  }
  int asked = 0, quiet = 0; // steps of 1e-9 rad, whose hulls are as short
  for_steps_in_lanes(
      1e-9, 1e-8,
      [](InStep& run, Draws&) {
        for (int i = 1; i <= run.wing.size(); ++i) // no hinge comes to rest
          for (State<double>* rate : {&run.step.dxdt, &run.step.dxdt1})
            (*rate)[run.system.layout().rate(i)] = 0;
      },
      [&](const auto& runs, InLanes& lanes) {
        const auto may = lanes.events.lie_inside(lanes.system, lanes.step);
        for (int lane = 0; lane < 4; ++lane) {
          if (runs[lane]->events.first(runs[lane]->step, x, dxdt, search)) continue;
          ++quiet, asked += is_in(may, lane);
        }
      });
  CHECK(quiet > 400);
  CHECK(asked < quiet / 50);
}

TEST_CASE("lanes see every event at the very end of a step, and none beside it") {
  int latched = 0, missed = 0, seen = 0, rested = 0, nothing = 0;
  const auto to_the_end = [](InStep& run, Draws& draws) { // at or beside an event
    const Layout& at = run.system.layout();
    for (int i = 1; i <= at.bodies; ++i) {
      const HingeTerms<double>& hinge = run.wing.hinges[i];
      const double off = draws.chance(0.3) ? 0 : draws.sign() * draws.log_uniform(1e-17, 1e-3);
      double there = hinge.latched;
      if (draws.chance(0.4))
        for (const ReleaseTerms<double>& hold : run.wing.releases)
          if (hold.present && hold.after == i) there = hold.angle;
      run.step.x1[at.angle(i)] = there + hinge.sense * off;
      if (draws.chance(0.3))
        run.step.x1[at.rate(i)] = draws.sign() * draws.log_uniform(1e-18, 1e-3);
    }
  };
  for_steps_in_lanes(1e-3, 1e-1, to_the_end, [&](const auto& runs, InLanes& lanes) {
    std::array<std::vector<char>, 4> at_end;
    for (int i = 1; i <= lanes.wing.size(); ++i) {
      const auto mask = lanes.events.lie_at_end(lanes.system, lanes.step, i);
      for (int lane = 0; lane < 4; ++lane) at_end[lane].push_back(is_in(mask, lane));
    }
    for (int lane = 0; lane < 4; ++lane) {
      InStep& run = *runs[lane];
      const Layout& at = run.system.layout();
      std::vector<LatchEvent> latches;
      std::vector<HingeEvent> misses, let_go, releases;
      Step<double> next = run.step;
      next.t = run.step.t + run.step.h, next.x = run.step.x1, next.dxdt = run.step.dxdt1;
      std::vector<char> locked(at.bodies + 1);
      for (int i = 1; i <= at.bodies; ++i) locked[i] = run.system.is_locked(i);
      (void)run.events.apply(std::nullopt, next, {latches, misses, let_go, releases});
      for (int i = 1; i <= at.bodies; ++i) {
        const auto is_of_hinge = [&](const auto& event) {
          return event.hinge == run.wing.hinge_of[i];
        };
        const bool latches_here = std::ranges::any_of(latches, is_of_hinge);
        const bool missed_here = std::ranges::any_of(misses, is_of_hinge);
        const bool seen_here = std::ranges::any_of(releases, is_of_hinge);
        const bool rests = next.x[at.rate(i)] == 0 && run.step.x1[at.rate(i)] != 0;
        const bool any = latches_here || missed_here || seen_here || rests;
        latched += latches_here, missed += missed_here, seen += seen_here, rested += rests;
        nothing += !any;
        CAPTURE(lane, i, latches_here, missed_here, seen_here, rests);
        // an angle is seen too where another event moves the hinge to it
        const bool asks = std::ranges::count(at_end[lane], true) > 0;
        if (any) CHECK((at_end[lane][i - 1] || (seen_here && asks)));
        if (!any && !locked[i]) CHECK_FALSE(at_end[lane][i - 1]);
      }
    }
  });
  CAPTURE(latched, missed, seen, rested, nothing);
  CHECK(std::min({latched, missed, seen, rested, nothing}) >= 15);
}
