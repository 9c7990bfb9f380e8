// What a run claims when it ends early, held against the run to t_end, on random wings.
#include "core/deployment.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/real_scenes.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <memory>
#include <string>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

const Goal families[] = {{},
                         {.peak_moment = false, .peak_force = false, .overtravel = false},
                         {.peak_force = false},
                         {.peak_moment = false, .end_state = false},
                         to_the_end};

/// Random wings none of whose hinges can move, on bases of every motion.
Scene immovable(std::uint64_t seed) {
  RandomScene options;
  options.bodies = 1 + static_cast<int>(seed % 4);
  options.motion = static_cast<BaseMotion>(seed % 3);
  options.friction = false;
  RealFeatures features;
  features.measured = features.stops = features.backlash = false;
  Scene scene = random_scene(seed, options);
  if (seed % 2 == 0) scene = with_real_hinges(scene, seed, features);
  scene.base.angular_acceleration = 0;
  if (seed % 5 < 3) scene.base.acceleration = {0, 0}, scene.environment.gravity = {0, 0};
  for (Hinge& hinge : scene.hinges) rub(hinge, 1e6), hinge.initial_rate = 0;
  return scene;
}

/// Random wings of which some deploy, some stall, and some stop half-way with a few hinges latched.
Scene reluctant(std::uint64_t seed) {
  Draws draws(seed);
  RandomScene options;
  options.bodies = 1 + static_cast<int>(seed % 3);
  options.mass_lower = 1, options.mass_upper = 20;
  options.motion = static_cast<BaseMotion>(seed / 3 % 3);
  options.harness = options.friction = false;
  Scene scene = random_scene(seed, options);
  scene.base.angular_acceleration = 0;
  if (seed % 2 == 0) scene.base.acceleration = {0, 0};
  for (Hinge& hinge : scene.hinges) {
    hinge.spring.torque_stowed *= 3, hinge.spring.torque_latched *= 3;
    hinge.friction.viscous = draws.log_uniform(0.01, 3);
    if (draws.chance(0.9)) {
      const double level = draws.log_uniform(0.2, 2) * std::abs(hinge.spring.torque_stowed);
      rub(hinge, level, draws.chance(0.5) ? level : 1.2 * level);
    }
    hinge.latch = Latch{draws.log_uniform(1e2, 1e4), draws.log_uniform(1, 1e2)};
    if (draws.chance(0.1)) hinge.latch.reset();
  }
  return scene;
}

/// The time that the reason of a stall names, s.
double time_of(const std::string& reason) {
  const std::string before = "from t = ";
  return std::stod(reason.substr(reason.find(before) + before.size()));
}

/// Checks that the hinges of a run to t_end move up to this time and not after.
void check_standstill(const Scene& scene, const Integration& how, double from) {
  double moved = 0;
  const auto see = [&](const Sample& sample) {
    for (const double rate : sample.rates)
      if (rate != 0) moved = sample.t;
  };
  (void)Deployment().run(scene, how, to_the_end, see);
  CHECK(moved <= from * 1.001);
  if (from > 0) CHECK(moved > 0);
}

} // namespace

TEST_CASE("a wing that never moves costs next to nothing, whatever carries it") {
  int stalled = 0;
  for (int seed = 1; seed <= random_cases(3000, 60); ++seed) {
    const Scene scene = immovable(seed);
    for (const Goal& goal : families) {
      const Outcome out = Deployment().run(scene, within(1e-8, 30), goal);
      CAPTURE(seed, goal.to_t_end, out.reason, out.work.steps, out.work.rhs_evaluations);
      CHECK((out.status == Status::stalled || out.status == Status::timed_out));
      CHECK(out.work.rhs_evaluations < 100 * (out.work.steps + out.work.rejected + 1));
      if (out.status != Status::stalled) continue;
      ++stalled;
      CHECK(time_of(out.reason) == 0);
      CHECK(out.t_end == (goal.to_t_end ? 30 : 0));
    }
  }
  CHECK(stalled > 150);
}

TEST_CASE("the reason of a stall says since when no load changes: after a hold, a motor, a base") {
  Scene scene = latching_panel();
  rub(scene.hinges[0], 1e3);
  const auto since = [](const Scene& stuck, const Goal& goal) {
    const Outcome out = Deployment().run(stuck, within(1e-8, 20), goal);
    CAPTURE(out.reason, goal.to_t_end);
    REQUIRE(out.status == Status::stalled);
    return time_of(out.reason);
  };
  for (const Goal& goal : families) {
    CHECK(since(scene, goal) == 0);
    Scene held = scene;
    held.hinges[0].release = Release{.time = 3};
    CHECK(since(held, goal) == 3);
    Scene driven = scene;
    Motor motor{.time = {0, 4}, .rates = {0.5, 0.1}, .interpolation = Interpolation::linear};
    motor.table = std::make_shared<Curve>(motor.time, motor.rates, motor.interpolation);
    motor.gain = 1, motor.torque_limit = 10;
    driven.hinges[0].motor = motor;
    CHECK(since(driven, goal) == 4);
    Scene pushed = scene;
    pushed.base.motion = BaseMotion::prescribed;
    const BaseTable::Columns columns{{0, 5}, {}, {0.1, 0}, {}};
    pushed.base.table = std::make_shared<const BaseTable>(columns, Interpolation::linear);
    CHECK(since(pushed, goal) == 5);
  }
}

TEST_CASE("every claim on a run's end holds in the run to t_end") {
  int stalled = 0, stuck = 0, partly = 0, final = 0, open = 0, alone = 0;
  for (int seed = 1; seed <= random_cases(3000, 80); ++seed) {
    const Scene scene = reluctant(seed);
    const Integration how = within(1e-8, Draws(seed).log_uniform(0.5, 20));
    Integration further = how;
    further.t_end = how.t_end + 20;
    const Outcome late = Deployment().run(scene, further, to_the_end);
    const Outcome whole = Deployment().run(scene, how, to_the_end);
    if (late.status == Status::failed || whole.status == Status::failed) continue;
    for (const Goal& goal : families) {
      const Outcome out = Deployment().run(scene, how, goal);
      CAPTURE(seed, how.t_end, goal.to_t_end, goal.peak_moment, goal.peak_force, out.t_end);
      CAPTURE(out.reason, whole.reason, to_string(out.status), to_string(whole.status));
      CHECK(out.status == whole.status);
      if (whole.reason.find("sticks") == std::string::npos) CHECK(out.reason == whole.reason);
      CHECK(out.latches.size() == whole.latches.size());
      if (out.status == Status::stalled) CHECK(late.latches.size() == out.latches.size());
      for (std::size_t i = 0; out.moments_final && i < out.peak_moment.size(); ++i)
        CHECK(late.peak_moment[i].value <= out.peak_moment[i].value * (1 + 1e-9));
      for (std::size_t i = 0; out.forces_final && i < out.peak_force.size(); ++i)
        CHECK(late.peak_force[i].value <= out.peak_force[i].value * (1 + 1e-9));
      alone += out.moments_final != out.forces_final && goal.peak_moment && goal.peak_force;
      if (!out.peaks_final) continue;
      ++final;
      open += out.status == Status::timed_out;
    }
    if (whole.status != Status::stalled) continue;
    ++stalled;
    partly += !whole.latches.empty();
    if (whole.reason.find("sticks") == std::string::npos) continue;
    ++stuck;
    CAPTURE(seed, whole.reason);
    check_standstill(scene, how, time_of(whole.reason));
  }
  CAPTURE(stalled, stuck, partly, final, open, alone);
  CHECK(stalled > 20);
  CHECK(stuck > 8);
  CHECK(partly > 3);
  CHECK(final > 60);
}

// Each latch that engages changes the wing that a proof is about: a proof begun before is begun anew.
TEST_CASE("holding moments that no load reaches leave a run's end as it is") {
  for (int seed = 1; seed <= random_cases(500, 80); ++seed) {
    Draws draws(seed);
    Scene scene = seed_scene();
    for (Hinge& hinge : scene.hinges) {
      rub(hinge, draws.uniform(0.001, 0.25));
      hinge.friction.viscous = draws.uniform(0.01, 0.6);
      hinge.latch = Latch{3000, 20};
    }
    const Outcome plain = Deployment().run(scene, within(1e-6, 40), {});
    for (Hinge& hinge : scene.hinges) hinge.latch->holding_moment = 1e6;
    const Outcome held = Deployment().run(scene, within(1e-6, 40), {});
    CAPTURE(seed, plain.t_end, held.t_end);
    CHECK(held.status == plain.status);
    CHECK(held.latches.size() == plain.latches.size());
    CHECK(held.let_go.empty());
    CHECK(held.peaks_final == plain.peaks_final);
  }
}

// The push turns as seen from the base, at the frequency of the latched panel: the swing grows until damping balances it.
TEST_CASE("on a base that turns and is pushed, loads that grow after a quiet end are not final") {
  Scene scene = free_panel(-1.5, -0.15);
  scene.base.motion = BaseMotion::prescribed;
  scene.base.rate = 2, scene.base.acceleration = {0.1, 0};
  scene.bodies[0].mass = 10, scene.bodies[0].inertia = 30;
  Hinge& hinge = scene.hinges[0];
  hinge.parent_point = {0, 0}, hinge.child_point = {-0.5, 0};
  hinge.latched = 0, hinge.spring.torque_stowed = 4;
  hinge.stop = Stop{.stiffness = 2000, .dissipation = 20, .gap = 0};
  hinge.latch = Latch{130, 0.01};
  const Outcome late = Deployment().run(scene, within(1e-8, 400), {});
  CHECK(late.peak_moment[0].value == Approx(66.032).epsilon(1e-4));
  for (const double t_end : {8., 12., 40.}) {
    const Outcome early = Deployment().run(scene, within(1e-8, t_end), {});
    CAPTURE(t_end);
    CHECK(early.peak_moment[0].value == Approx(47.761).epsilon(1e-4));
    CHECK_FALSE(early.peaks_final);
  }
  hinge.latch->holding_moment = 55;
  CHECK_FALSE(Deployment().run(scene, within(1e-8, 40), {}).latches_final); // it may let go
  CHECK_FALSE(Deployment().run(scene, within(1e-8, 400), {}).let_go.empty());
}

TEST_CASE("a run that is to end at its first latch stalls as any other if no hinge can latch") {
  Goal goal = latches_only;
  goal.first_latch_only = true;
  Scene held = latching_panel();
  held.hinges[0].release = Release{.fails = 1};
  const Outcome out = Deployment().run(held, within(1e-8, 30), goal);
  CHECK(out.status == Status::stalled);
  CHECK(out.never_released == std::vector<int>{0});
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Outcome stuck = Deployment().run(immovable(seed), within(1e-8, 5), goal);
    CAPTURE(seed, stuck.reason);
    CHECK(stuck.status == Deployment().run(immovable(seed), within(1e-8, 5), latches_only).status);
  }
}
