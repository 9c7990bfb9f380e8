// The record of a run: its energy, and samples at multiples of an interval.
#include "core/deployment.hpp"
#include "tests/support/closed_forms.hpp"

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

TEST_CASE("samples show how a base moves, free or driven") {
  Scene scene = unit_oscillator(1);
  scene.base.motion = BaseMotion::prescribed;
  scene.base.angle = 0.2, scene.base.rate = 0.1, scene.base.angular_acceleration = 0.02;
  std::vector<Sample> samples;
  const auto keep = [&](const Sample& sample) { samples.push_back(sample); };
  (void)Deployment().run(scene, within(1e-8, 3), to_the_end, keep);
  for (const Sample& sample : samples) {
    const double t = sample.t;
    CHECK(sample.base_angle == Approx(0.2 + 0.1 * t + 0.01 * t * t).epsilon(1e-14));
    CHECK(sample.base_rate == Approx(0.1 + 0.02 * t).epsilon(1e-14));
  }
}
