// Steps end at the knots of all tables of a wing: its base's and its motors'.
#include "tests/core/deployment/real_runs.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

std::vector<double> random_times(Draws& draws, int count, double t_end) {
  std::vector<double> times{draws.uniform(-1, 0.5)};
  while (static_cast<int>(times.size()) < count)
    times.push_back(times.back() + draws.uniform(0.05, 2 * t_end / count));
  return times;
}

} // namespace

TEST_CASE(
    "a base that a table holds still is a fixed one, whichever knots the motors' tables have") {
  for (int seed = 1; seed <= 12; ++seed) {
    Draws draws(seed);
    Scene fixed = seed_scene();
    for (Hinge& hinge : fixed.hinges) {
      if (!draws.chance(0.7)) continue;
      Motor motor{.time = random_times(draws, 6, 4), .interpolation = Interpolation::linear};
      for (std::size_t k = 0; k < motor.time.size(); ++k)
        motor.rates.push_back(draws.uniform(-1, 1));
      motor.table = std::make_shared<Curve>(motor.time, motor.rates, motor.interpolation);
      motor.gain = draws.uniform(0.5, 5), motor.torque_limit = 1e3;
      hinge.motor = motor;
    }
    Scene held = fixed;
    BaseTable::Columns still{random_times(draws, 4, 4), {}, {}, {}};
    still.rate.assign(4, 0.0);
    held.base.motion = BaseMotion::prescribed;
    held.base.table = std::make_shared<const BaseTable>(still, Interpolation::linear);
    for (const char* method : {"auto", "dop853", "bulirsch_stoer", "seulex"}) {
      Integration how = within(1e-10, 4);
      how.method = method;
      const Outcome expected = Deployment().run(fixed, how, to_the_end);
      const Outcome out = Deployment().run(held, how, to_the_end);
      CAPTURE(seed, method, out.reason);
      REQUIRE(out.latches.size() == expected.latches.size());
      for (int i = 0; i < 3; ++i)
        CHECK(std::abs(out.final.angles[i] - expected.final.angles[i]) < 1e-8);
    }
  }
}

// The step between the two is short, and says nothing of how long the next may be.
TEST_CASE("two knots close together cost two steps: the next one is as long as those before") {
  for (const double gap : {1e-2, 1e-4, 1e-6})
    for (const char* method : {"dopri5", "dop853", "cash_karp54"}) {
      Scene scene = unit_oscillator(1);
      Integration how = within(1e-8, 6);
      how.method = method;
      const Outcome without = Deployment().run(scene, how, to_the_end);
      constexpr int pairs = 10;
      BaseTable::Columns still{{0}, {}, {}, {}};
      for (int k = 1; k <= pairs; ++k)
        still.time.push_back(0.5 * k), still.time.push_back(0.5 * k + gap);
      still.rate.assign(still.time.size(), 0.0);
      scene.base.motion = BaseMotion::prescribed;
      scene.base.table = std::make_shared<const BaseTable>(still, Interpolation::linear);
      const Outcome out = Deployment().run(scene, how, to_the_end);
      CAPTURE(gap, method, out.reason);
      CHECK(out.work.steps <= without.work.steps + 2 * pairs);
      CHECK(std::abs(out.final.angles[0] - without.final.angles[0]) < 1e-7);
    }
}

namespace {

enum class Instant { base_knot, motor_knot, release, other_release, end };

/// Lets something happen at t: the base or the root's motor passes a knot, a hold lets go, the run ends.
void let_happen(Instant what, double t, Scene& scene, Integration& how) {
  if (what == Instant::base_knot) {
    BaseTable::Columns columns{{0, t, 5}, {}, {}, {}};
    columns.rate = {0, 0.02, 0.02};
    scene.base.motion = BaseMotion::prescribed;
    scene.base.table = std::make_shared<const BaseTable>(columns, Interpolation::linear);
  } else if (what == Instant::motor_knot) {
    Motor motor{.time = {0, t, 5}, .rates = {0, 0.3, 0.3}, .interpolation = Interpolation::linear};
    motor.table = std::make_shared<Curve>(motor.time, motor.rates, motor.interpolation);
    motor.gain = 2, motor.torque_limit = 1e3;
    scene.hinges[0].motor = motor;
  } else if (what == Instant::end) {
    how.t_end = t;
  } else {
    scene.hinges[what == Instant::release ? 1 : 2].release =
        Release{.time = t / 3, .delay = t - t / 3};
  }
}

} // namespace

TEST_CASE("instants a rounding apart come at once, whatever happens at them") {
  const std::vector<Instant> all{Instant::base_knot, Instant::motor_knot, Instant::release,
                                 Instant::other_release, Instant::end};
  for (const double at : {0.3, 1e-3, 700.0})
    for (const Instant first : all)
      for (const Instant second : all) {
        if (first == second) continue;
        const auto outcome = [&](double then) {
          Scene scene = seed_scene();
          Integration how = within(1e-9, at + 2);
          let_happen(first, at, scene, how);
          let_happen(second, then, scene, how);
          return Deployment().run(scene, how, to_the_end);
        };
        const Outcome expected = outcome(at);
        const double one_on = std::nextafter(at, 1e3);
        for (const double then : {one_on, std::nextafter(one_on, 1e3), at * (1 + 0x5p-52)}) {
          const Outcome out = outcome(then);
          CAPTURE(at, then - at, static_cast<int>(first), static_cast<int>(second), out.reason);
          REQUIRE(out.status != Status::failed);
          CHECK(out.releases.size() == expected.releases.size());
          for (std::size_t k = 0; k < out.final.angles.size(); ++k)
            CHECK(std::abs(out.final.angles[k] - expected.final.angles[k]) < 1e-6);
        }
      }
}
