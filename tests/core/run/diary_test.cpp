// The record of a run: its energy, and samples at multiples of an interval.
#include "core/deployment.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("energy dissipated by friction counts as drift") {
  Scene scene = unit_oscillator(1);
  scene.hinges[0].friction.viscous = 0.2 * panel_inertia; // damping ratio 0.1
  const Outcome out = Deployment().run(scene, within(1e-9, 5), to_the_end);
  CHECK(out.energy.final < out.energy.initial);
  CHECK(out.energy.drift_before_first_latch ==
        Approx(out.energy.initial - out.energy.final).epsilon(1e-6)); // it never grows
}

TEST_CASE(
    "samples stand at the multiples of their interval, each once, with the accuracy of steps") {
  Goal goal = to_the_end;
  goal.sample_interval = 0.1;
  std::vector<Sample> samples;
  const auto keep = [&](const Sample& sample) { samples.push_back(sample); };
  const Outcome out = Deployment().run(unit_oscillator(1), within(1e-10, 6), goal, keep);
  REQUIRE(samples.size() == 61); // 0 and the end among them
  for (int k = 0; k <= 60; ++k) {
    const Sample& sample = samples[k];
    CHECK(sample.t == k * 0.1);
    CHECK(sample.angles[0] == Approx(std::cos(sample.t)).margin(1e-7)); // dense output's error
    CHECK(sample.rates[0] == Approx(-std::sin(sample.t)).margin(1e-6));
    // loads and energies are those of the sample's own state
    CHECK(sample.moments[0] == Approx(-panel_inertia * sample.angles[0]).margin(1e-12));
    CHECK(sample.kinetic ==
          Approx(0.5 * panel_inertia * sample.rates[0] * sample.rates[0]).margin(1e-12));
  }
  CHECK(samples.back().angles == out.final.angles);
}

TEST_CASE("samples change nothing of the run, also where a hinge latches or sticks") {
  Scene scene = unit_oscillator(1);
  rub(scene.hinges[0], 0.05 * panel_inertia, 0.3 * panel_inertia);
  const Outcome alone = Deployment().run(scene, within(1e-9, 40), to_the_end);
  Goal goal = to_the_end;
  goal.sample_interval = 0.37;
  std::vector<double> times;
  double last = 0;
  const auto keep = [&](const Sample& sample) {
    times.push_back(sample.t);
    last = sample.angles[0];
  };
  const Outcome watched = Deployment().run(scene, within(1e-9, 40), goal, keep);
  CHECK(watched.final.angles == alone.final.angles);
  CHECK(watched.peak_moment[0].value == alone.peak_moment[0].value);
  CHECK(watched.work.steps == alone.work.steps);
  CHECK(times.size() == 109); // ⌊40/0.37⌋ + 1
  CHECK(std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end());
  CHECK(last == alone.final.angles[0]); // it sticks
}

TEST_CASE("samples change no bit of a run and none of its work: random wings whose hinges stick") {
  int at_rest = 0;
  for (int seed = 1; seed <= random_cases(600, 30); ++seed) {
    Draws draws(seed);
    RandomScene options;
    options.bodies = 2 + seed % 3;
    options.branching = seed % 2 == 0;
    options.motion = static_cast<BaseMotion>(seed % 3);
    Scene scene = random_scene(seed, options);
    for (Hinge& hinge : scene.hinges) {
      const double level = draws.log_uniform(0.02, 0.7) * std::abs(hinge.spring.torque_stowed);
      rub(hinge, level, 1.2 * level);
      hinge.latch = Latch{draws.log_uniform(1e3, 1e6),
                          draws.log_uniform(1, 1e3)}; // `auto` changes the method
    }
    const Integration how = within(1e-7, 8);
    const Outcome alone = Deployment().run(scene, how, to_the_end);
    Goal goal = to_the_end;
    goal.sample_interval = 2e-3;
    bool rests = false;
    const auto see = [&](const Sample& sample) {
      rests = rests || (sample.t > 0 && std::ranges::find(sample.rates, 0.0) != sample.rates.end());
    };
    const Outcome watched = Deployment().run(scene, how, goal, see);
    at_rest += rests;
    CAPTURE(seed, alone.reason, watched.reason);
    CHECK(watched.final.angles == alone.final.angles);
    CHECK(watched.final.rates == alone.final.rates);
    CHECK(watched.phases.size() == alone.phases.size());
    CHECK(watched.work.steps == alone.work.steps);
    CHECK(watched.work.rejected == alone.work.rejected);
    CHECK(watched.work.rhs_evaluations == alone.work.rhs_evaluations);
    REQUIRE(watched.latches.size() == alone.latches.size());
    for (std::size_t k = 0; k < alone.latches.size(); ++k)
      CHECK(watched.latches[k].time == alone.latches[k].time);
  }
  CHECK(at_rest > 10);
}

TEST_CASE("samples show how a base moves, free or driven") {
  Scene scene = unit_oscillator(1);
  scene.base.motion = BaseMotion::prescribed;
  scene.base.angle = 0.2, scene.base.rate = 0.1, scene.base.angular_acceleration = 0.02;
  Goal goal = to_the_end;
  for (const bool motion_only : {false, true}) {
    goal.sample_motion_only = motion_only;
    std::vector<Sample> samples;
    const auto keep = [&](const Sample& sample) { samples.push_back(sample); };
    (void)Deployment().run(scene, within(1e-8, 3), goal, keep);
    CHECK(samples.size() > 5);
    for (const Sample& sample : samples) {
      const double t = sample.t;
      CAPTURE(motion_only, t);
      CHECK(sample.base_angle == Approx(0.2 + 0.1 * t + 0.01 * t * t).epsilon(1e-14));
      CHECK(sample.base_rate == Approx(0.1 + 0.02 * t).epsilon(1e-14));
    }
  }
}

// Base and panel are hinged at both centres of mass: their angular momentum stays 0, and the base's centre at rest drifts.
TEST_CASE("samples of the motion alone have a free base's place, angle and rate too") {
  Scene scene = unit_oscillator(1);
  scene.base.motion = BaseMotion::free, scene.base.mass = 5, scene.base.inertia = 3;
  scene.base.position = {1, -2}, scene.base.velocity = {0.5, 0.25};
  scene.hinges[0].parent_point.setZero(), scene.hinges[0].child_point.setZero();
  Goal goal = to_the_end;
  goal.sample_motion_only = true, goal.sample_interval = 0.25;
  const double share = scene.bodies[0].inertia / (scene.bodies[0].inertia + 3);
  int seen = 0;
  const auto check = [&](const Sample& sample) {
    CHECK(sample.base_position.x() == Approx(1 + 0.5 * sample.t));
    CHECK(sample.base_position.y() == Approx(-2 + 0.25 * sample.t));
    CHECK(sample.base_angle == Approx(-share * (sample.angles[0] - 1)).margin(1e-7));
    CHECK(sample.base_rate == Approx(-share * sample.rates[0]).margin(1e-7));
    ++seen;
  };
  (void)Deployment().run(scene, within(1e-10, 3), goal, check);
  CHECK(seen == 13);
}

// Two panels about one fixed axis, the second carried by the first: without torques both turn uniformly.
TEST_CASE("a final angle is the way beyond the latched angle, of each hinge in the scene's order") {
  Scene scene = latching_panel();
  scene.hinges[0].latch.reset(), scene.hinges[0].spring = {};
  scene.bodies.push_back({"carried", 4, 0.3});
  Hinge carried = scene.hinges[0];
  carried.name = "carried", carried.parent = 0, carried.child = 1;
  carried.parent_point = scene.hinges[0].child_point; // the same axis
  carried.stowed = -0.4, carried.latched = 0.6, carried.initial_rate = 0.3;
  scene.hinges[0].stowed = 1.5, scene.hinges[0].latched = 0.25, scene.hinges[0].initial_rate = -0.5;
  scene.hinges.insert(scene.hinges.begin(), carried); // the outer hinge first
  const Outcome out = Deployment().run(scene, within(1e-10, 2), to_the_end);
  REQUIRE(out.t_end == 2);
  REQUIRE(out.final_angle.size() == 2);
  CHECK(out.final_angle[0] == Approx(-0.4 + 0.3 * 2 - 0.6).margin(1e-9));
  CHECK(out.final_angle[1] == Approx(1.5 - 0.5 * 2 - 0.25).margin(1e-9));
  CHECK(out.final.angles[0] == Approx(0.2).margin(1e-9));
  CHECK(out.final.rates[1] == Approx(-0.5).margin(1e-9));
}

TEST_CASE("the phases of a run follow each other without a gap, and their steps are the run's") {
  Scene scene = seed_scene();
  for (Hinge& hinge : scene.hinges) hinge.latch = Latch{1e6, 1e3}; // `auto` changes the method
  const Outcome out = Deployment().run(scene, within(1e-6, 12), to_the_end);
  REQUIRE(out.phases.size() > 1);
  long steps = 0;
  double from = 0;
  for (const Phase& phase : out.phases) {
    CHECK(phase.from == from);
    CHECK(phase.to > phase.from);
    CHECK(phase.steps > 0);
    steps += phase.steps, from = phase.to;
  }
  CHECK(from == out.t_end);
  CHECK(steps == out.work.steps);
}

// A panel carries another one that is held: both turn as one body about a fixed point, so that the load of the hold
// follows from the first hinge's moment and rate, in any sample.
TEST_CASE("a sample's moment on a held hinge is that of the sample's own state, at events too") {
  int latched = 0;
  for (int k = 0; k < 12; ++k) {
    Draws draws(4400 + k);
    Scene scene = latching_panel();
    scene.bodies.push_back({"carried", 4, 0.3});
    Hinge carried = scene.hinges[0];
    carried.name = "carried", carried.parent = 0, carried.child = 1;
    carried.parent_point = {draws.uniform(0.2, 1), draws.uniform(-0.3, 0.3)};
    carried.child_point = {draws.uniform(-1, -0.2), draws.uniform(-0.3, 0.3)};
    carried.stowed = draws.uniform(-2, 2), carried.latched = carried.stowed + 1;
    carried.release = Release{.time = 100};
    scene.hinges[0].spring = {20.0 + k, 1}, scene.hinges[0].friction.viscous = 2;
    scene.hinges.push_back(carried);
    const Eigen::Vector2d hinge = carried.parent_point - scene.hinges[0].child_point;
    const double c = std::cos(carried.stowed), s = std::sin(carried.stowed);
    const Eigen::Vector2d from = -carried.child_point,
                          lever{c * from.x() - s * from.y(), s * from.x() + c * from.y()};
    const Eigen::Vector2d center = hinge + lever;
    const double m = scene.bodies[1].mass, J = scene.bodies[1].inertia;
    const double whole = panel_inertia + J + m * center.squaredNorm();
    const double turning = J + m * lever.dot(center);
    const double spinning = m * (lever.x() * center.y() - lever.y() * center.x());
    const auto check = [&](const Sample& sample) {
      const double expected =
          turning / whole * sample.moments[0] - spinning * sample.rates[0] * sample.rates[0];
      CAPTURE(k, sample.t, sample.moments[0], sample.rates[0]);
      CHECK(sample.moments[1] == Approx(expected).margin(1e-10 * std::abs(sample.moments[0])));
    };
    const Outcome out = Deployment().run(scene, within(1e-2, 8), to_the_end, check);
    REQUIRE(out.status != Status::failed);
    latched += static_cast<int>(out.latches.size());
  }
  CHECK(latched == 12);
}
