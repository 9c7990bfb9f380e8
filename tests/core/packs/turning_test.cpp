// Hinges that nearly come to rest under exact friction, or have just begun to move. A run in a lane must find every
// turning point that the run alone finds, without a search in every step.
#include "core/events/contact.hpp"
#include "tests/core/events/rubbed_wings.hpp"
#include "tests/core/packs/same_bits.hpp"
#include "tests/support/random_cases.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A panel that moves over the crest of an unstable equilibrium. It starts with `share` times the rate that
/// just reaches the crest, and turns back if share < 1.
Scene over_a_crest(double friction, double share) {
  Scene scene = latching_panel();
  Hinge& hinge = scene.hinges[0];
  hinge.stowed = -1, hinge.latched = 1;
  pull_towards(hinge, 0, -panel_inertia); // φ̈ = φ − friction
  rub(hinge, friction * panel_inertia);
  hinge.initial_rate = share * (1 + friction);
  return scene;
}

/// Two discs that swing as one until the friction of the second releases it, with hardly any acceleration:
/// the load on that friction, 2 φ̈, is at most √5 [grazing_release_test.cpp].
Scene let_go_at_the_limit(double limit, double kinetic) {
  Scene scene = coaxial_discs(3, 2);
  scene.hinges[0].stowed = 1, scene.hinges[0].latched = -50, scene.hinges[0].initial_rate = 0.5;
  pull_towards(scene.hinges[0], 0, 5);
  rub(scene.hinges[1], kinetic, limit);
  return scene;
}

/// A panel that does not move until its base turns away from it, at 1e9 s, and back. An instant is then
/// 0.9 ms [instant.hpp], so that some steps end within an instant before the panel comes to rest.
Scene left_behind_late(double turning, double friction) {
  Scene scene = carried_panel(friction, friction);
  BaseTable::Columns columns;
  columns.time = {0, 1e9, 1e9 + 1, 1e9 + 2, 1e9 + 3, 1e9 + 4};
  columns.angular_acceleration = {0, 0, -turning, 0, turning, 0};
  scene.base.table = std::make_shared<const BaseTable>(std::move(columns), Interpolation::linear);
  return scene;
}

/// Seed wings whose hinges turn back some forty times a run.
std::vector<Scene> rubbed_units(int count) {
  std::vector<Scene> scenes;
  for (int k = 0; k < count; ++k) {
    Draws draws(7000 + k);
    scenes.push_back(rubbed_seed(draws.uniform(0.05, 0.15), draws.uniform(0.02, 0.06),
                                 draws.uniform(0.01, 0.03)));
  }
  return scenes;
}

/// A step of one hinge, no two like: some begin at rest, some of these without acceleration, and
/// some stand at angles beside which the way that they go is nothing.
Step<double> any_step(Draws& draws) {
  Step<double> step{0, draws.log_uniform(1e-6, 1), {}, {}, {}, {}};
  const bool rests = draws.uniform(0, 1) < 0.3, still = draws.uniform(0, 1) < 0.3;
  const double rate = rests ? 0 : draws.uniform(-0.2, 1);
  const double slope = rests && still ? 0 : draws.uniform(-1, 1) / step.h;
  const double angle = draws.uniform(0, 1) < 0.1 ? 1e9 : draws.uniform(-2, 2);
  step.x = {angle, rate}, step.dxdt = {rate, slope};
  const double end = draws.uniform(-0.2, 1.5);
  const double way = step.h * (0.5 * (rate + end) + draws.uniform(-0.1, 0.1));
  step.x1 = {angle + way, end}, step.dxdt1 = {end, draws.uniform(-1, 1) / step.h};
  return step;
}

} // namespace

TEST_CASE("where the way to rest is negative no hinge turns inside the step") {
  const Layout at{0, 1, false};
  Draws draws(1);
  int stay = 0, set_out = 0;
  for (int k = 0; k < 20000; ++k) {
    const Step<double> step = any_step(draws);
    if (!all_negative(way_to_rest(at, step, 1, -1.0))) continue;
    const Quintic<double> rate = step.rate(at.angle(1), at.freedoms());
    ++(step.x[1] == 0 ? set_out : stay);
    CAPTURE(k, step.h, step.x[0]);
    for (int s = 1; s <= 256; ++s)
      REQUIRE(value(rate, s / 256.0) > -1e-12 * bound(rate)); // both are rounded
  }
  CHECK((stay > 2000 && set_out > 500));
}

TEST_CASE("a run in a lane has the bits of the run alone: hinges that nearly come to rest",
          "[long]") {
  const int wings = random_cases(120, 30);
  std::vector<Scene> scenes;
  for (int k = 0; k < wings; ++k) {
    Draws draws(5000 + k);
    const double off = draws.log_uniform(1e-12, 1e-1);
    scenes.push_back(over_a_crest(draws.uniform(0.01, 0.5), k % 2 ? 1 + off : 1 - off));
  }
  for (const double rtol : {1e-3, 1e-6, 1e-9}) {
    const Integration how = within(rtol, 40);
    CAPTURE(rtol);
    long latched = 0;
    for (const Scene& scene : scenes)
      latched += !Deployment().run(scene, how, every_peak).latches.empty();
    // half of them turn back, up to the error of a loose tolerance
    CHECK((latched > wings / 3 && latched < wings * 2 / 3));
    require_equal_bits(scenes, how, every_peak);
  }
}

TEST_CASE(
    "a run in a lane has the bits of the run alone: hinges that set out with no acceleration") {
  std::vector<Scene> scenes;
  for (int k = 0; k < 80; ++k) {
    Draws draws(6000 + k);
    const double limit = std::sqrt(5) * (1 - draws.log_uniform(1e-8, 0.2));
    scenes.push_back(let_go_at_the_limit(limit, k % 2 ? limit : limit * draws.uniform(0.2, 1)));
  }
  for (const double rtol : {1e-3, 1e-6, 1e-9}) {
    CAPTURE(rtol);
    require_equal_bits(scenes, within(rtol, 6), every_peak);
  }
}

TEST_CASE(
    "a run in a lane has the bits of the run alone: a rest within an instant of a step's end") {
  std::vector<Scene> scenes;
  for (int k = 0; k < 2000; ++k) {
    Draws draws(8000 + k);
    scenes.push_back(left_behind_late(draws.uniform(0.5, 4), draws.uniform(0.2, 1)));
  }
  for (const double rtol : {1e-3, 1e-5}) { // one of them each, when this was written
    CAPTURE(rtol);
    require_equal_bits(scenes, within(rtol, 1e9 + 20), every_peak);
  }
}

TEST_CASE("runs are asked where a hinge turns, and not at every step that begins at rest") {
  const std::vector<Scene> scenes = rubbed_units(100);
  require_equal_bits(scenes, {}, every_peak);
  for (const InstructionSet set : instruction_sets()) {
    if (set == InstructionSet::scalar) continue;
    const Occupancy lanes = run_in_lanes(set, scenes, {}, every_peak, [](long, Outcome&&) {});
    CAPTURE(to_string(set));
    CHECK(lanes.returns <
          150 * std::ssize(scenes)); // 171 a run where every step that begins at rest asks
  }
}
