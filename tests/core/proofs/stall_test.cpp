// Wings that never deploy: when a stall is proven, and when not.
#include "core/deployment.hpp"
#include "core/proofs/stall.hpp"
#include "tests/core/events/rubbed_wings.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("a wing that sticks from the start is stalled at once") {
  Scene fixed = rubbed_seed(2.5, 2, 1);
  Scene with_static_levels = rubbed_seed(0, 0, 0);
  for (Hinge& hinge : with_static_levels.hinges) hinge.friction.static_level = 2.5;
  Scene tumbling = two_wing_free_spacecraft();
  for (Hinge& hinge : tumbling.hinges) rub(hinge, 2.5);
  Scene turning = carried_panel(0.3, 0.8); // steadily: its load, 2·0.6² N·m, is constant
  turning.hinges[0].parent_point = {0.4, 0};
  turning.base.rate = 0.6;
  for (const Scene& scene : {fixed, with_static_levels, tumbling, turning})
    for (const Goal& goal : {Goal{}, latches_only, to_the_end}) {
      CAPTURE(scene.name, scene.hinges[0].friction.coulomb);
      with_every_method(scene, within(1e-8, 10), goal, MayGiveUp::fixed_step,
                        [&](const Outcome& out) {
                          CHECK(out.status == Status::stalled);
                          CHECK_THAT(out.reason, Catch::Contains("sticks"));
                          CHECK(out.t_end == (goal.to_t_end ? 10 : 0));
                          CHECK(out.latches.empty());
                          for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
                            CHECK(out.final.angles[i] == scene.hinges[i].stowed);
                            CHECK(out.final.rates[i] == 0);
                          }
                        });
    }
}

TEST_CASE("a wing with a hinge that moves, or may move, is not stalled") {
  SECTION("the root is not held: it latches first") {
    Scene scene = rubbed_seed(2.5, 2, 1);
    scene.hinges[0].friction = {};
    const Outcome out = Deployment().run(scene, within(1e-9, 60), {});
    REQUIRE(out.latches.size() >= 1);
    CHECK(out.latches[0].hinge == 0);
  }
  SECTION("a base that turns, and is pushed, brings its load to bear from another side") {
    Scene scene = carried_panel(0.4, 0.5); // at rest it bears at most 0.6 N·m, and at first nothing
    Hinge& hinge = scene.hinges[0];
    const Eigen::Vector2d arm = -hinge.child_point;
    const double turned = hinge.stowed + std::atan2(arm.y(), arm.x());
    const double push = 0.6 / (scene.bodies[0].mass * arm.norm());
    scene.base.acceleration = push * Eigen::Vector2d(std::cos(turned), std::sin(turned));
    scene.base.rate = 0.2;
    const Outcome out = Deployment().run(scene, within(1e-9, 10), {});
    CAPTURE(out.reason);
    CHECK(out.status != Status::stalled);
    CHECK(out.final.rates[0] != 0); // from asin(0.5/0.6)/0.2 s on, 4.9 s
    scene.base.rate = 0;
    CHECK(Deployment().run(scene, within(1e-9, 10), {}).status == Status::stalled);
  }
  SECTION("regularized friction creeps where exact friction sticks") {
    Scene scene = rubbed_seed(2.5, 2, 1);
    scene.hinges[0].friction.model = FrictionModel::regularized;
    const Outcome out = Deployment().run(scene, within(1e-9, 20), {});
    REQUIRE(out.status == Status::timed_out);
    CHECK(out.final.rates[0] < 0);
    CHECK(out.final.rates[1] == 0);
  }
}

TEST_CASE(
    "a hinge that just can pay for its friction deploys, and one that just cannot is stalled") {
  // It swings against a spring about φ = 0 from −1 rad on, and sticks beyond: its latch at 0.6 rad is
  // reached if ½ I ω² + ½ κ (1 − 0.36) pays for τ_c · 1.6 rad. Steps are short, so that the proof is
  // tried (after each 64th) long before.
  const double stiffness = 0.8, rate = 1.1, travel = 1.6;
  const double energy = 0.5 * panel_inertia * rate * rate + 0.5 * stiffness * (1 - 0.36);
  const double critical = energy / travel;
  for (const char* method : {"cash_karp54", "dopri5"})
    for (const double part : {0.8, 0.99, 0.999, 1.001, 1.01}) {
      Scene scene = latching_panel();
      Hinge& hinge = scene.hinges[0];
      hinge.stowed = -1, hinge.latched = 0.6, hinge.initial_rate = rate;
      pull_towards(hinge, 0, stiffness);
      rub(hinge, part * critical, 2 * critical);
      Integration how = within(1e-12, 60);
      how.method = method;
      const Outcome out = Deployment().run(scene, how, latches_only);
      CAPTURE(method, part, out.reason);
      CHECK(out.work.steps >= 63); // the proof has been tried
      CHECK(out.status == (part < 1 ? Status::deployed : Status::stalled));
      if (part > 1) continue;
      CHECK(out.work.steps > 64);
      REQUIRE(out.latches.size() == 1);
      const double left = std::sqrt(2 * (1 - part) * energy / panel_inertia);
      CHECK(out.latches[0].rates[0] == Approx(left).epsilon(1e-8));
    }
}

TEST_CASE("a wing that lacks a little energy is stalled before it stops") {
  // the same panel with a weaker spring and more speed: half its way is enough to know
  Scene scene = latching_panel();
  Hinge& hinge = scene.hinges[0];
  hinge.stowed = -1, hinge.latched = 0.6, hinge.initial_rate = 1.1;
  pull_towards(hinge, 0, 0.8);
  rub(hinge, 3, 3);
  Integration how = within(1e-12, 60);
  how.method = "cash_karp54";
  const Outcome out = Deployment().run(scene, how, latches_only);
  CHECK(out.status == Status::stalled);
  CHECK_THAT(out.reason, Catch::Contains("energy: no hinge can reach its latch"));
  CHECK(out.final.rates[0] > 0.01); // it still moves: stalled means that no hinge will latch
}

TEST_CASE("a spring gives energy as far as its rest, also beyond the latched angle") {
  // φ from −1; the spring is at rest at 0.5, beyond the latched angle 0
  Scene scene = latching_panel();
  Hinge& hinge = scene.hinges[0];
  hinge.stowed = -1, hinge.latched = 0;
  pull_towards(hinge, 0.5, 0.8);
  for (const double coulomb : {0.0, 0.1}) {
    rub(hinge, coulomb);
    for (const bool latch : {false, true}) {
      hinge.latch = latch ? std::optional(Latch{1e4, 100}) : std::nullopt;
      Wing<double> wing = make_wing<double>(scene, outward_order(scene));
      set_parameters(wing, scene);
      CAPTURE(coulomb, latch);
      // to where the spring has come down to friction; with a latch, which pulls back from 0 on, the same
      // to 0, and what is left of the push there against 1e4
      const double end = 0.5 - coulomb / 0.8, push = 0.8 * 0.5 - coulomb;
      const double beyond = latch ? 0.5 * push * push / (0.8 + 1e4) : 0.5 * 0.8 * end * end;
      const double before = 0.5 * 0.8 * (1.5 * 1.5 - 0.5 * 0.5) - coulomb;
      CHECK(detail::most_given(wing.hinges[1], false, -1.0) ==
            Approx(before + beyond).epsilon(1e-12));
    }
  }
}

namespace {

/// (3) of stall.hpp, by trying every angle on a fine grid.
double most_given_on_grid(const HingeTerms<double>& hinge, bool engaged, double angle) {
  const auto at = [&](double phi) {
    const bool latched = engaged || (hinge.has_latch && hinge.sense * (phi - hinge.latched) > 0);
    return potential(linear_law(hinge, latched), phi) +
           hinge.kinetic_friction * std::abs(phi - angle);
  };
  double least = at(angle);
  for (int k = -40'000; k <= 40'000; ++k) least = std::min(least, at(angle + 2.5e-4 * k));
  return potential(linear_law(hinge, engaged), angle) - least;
}

} // namespace

TEST_CASE(
    "a hinge gives as much energy as it finds on either side, before its latch, in it and beyond") {
  Draws draws(31);
  int backwards = 0, beyond = 0;
  for (int k = 0; k < 60; ++k) {
    Scene scene = latching_panel();
    Hinge& hinge = scene.hinges[0];
    hinge.stowed = k % 2 == 0 ? -1 : 1, hinge.latched = 0;
    const double rest = draws.uniform(-2, 1);
    pull_towards(hinge, rest, draws.uniform(0.3, 2));
    rub(hinge, k % 3 == 0 ? 0 : draws.uniform(0.02, 0.5));
    if (k % 5 != 0)
      hinge.latch = Latch{draws.log_uniform(1, 1e3), 1};
    else
      hinge.latch.reset();
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    const double angle = draws.uniform(-1.5, 1.5);
    const bool engaged = hinge.latch && draws.chance(0.5);
    const double sense = hinge.stowed < 0 ? 1 : -1, y = sense * angle;
    if (!engaged && hinge.latch && y > 0) continue; // an open hinge is before its latch
    CAPTURE(k, rest, angle, engaged);
    const double expected = most_given_on_grid(wing.hinges[1], engaged, angle);
    CHECK(detail::most_given(wing.hinges[1], engaged, angle) == Approx(expected).margin(2e-5));
    backwards += expected > 1e-3 && sense * (rest - angle) < 0;
    beyond += expected > 1e-3 && sense * (rest - angle) > 0;
  }
  CHECK((backwards > 8 && beyond > 8)); // the spring's rest lies on either side
}

TEST_CASE("energy that an open hinge lacks is proven beside hinges that are latched or held") {
  Draws draws(37);
  for (int k = 0; k < 40; ++k) {
    Scene scene = seed_scene();
    const int open = k % 3;
    for (Hinge& hinge : scene.hinges) hinge.friction = {}, hinge.harness = {}, hinge.spring = {};
    Hinge& resting = scene.hinges[open]; // where its spring takes it, before its latch
    const double gone = draws.uniform(0, 0.9), stiffness = draws.log_uniform(0.1, 10);
    const double rest = resting.stowed + gone * (resting.latched - resting.stowed);
    const double way = resting.latched - rest;
    pull_towards(resting, rest, stiffness);
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    State<double> x, dxdt;
    system.start(x);
    dxdt = x;
    for (int i = 1; i <= 3; ++i) {
      const Hinge& here = scene.hinges[wing.hinge_of[i]];
      double& angle = x[system.layout().angle(i)];
      x[system.layout().rate(i)] = 0;
      if (wing.hinge_of[i] == open) {
        angle = rest;
      } else if (draws.chance(0.5)) {
        angle = here.latched;
        system.engage(i);
      } else {
        system.set_contact(i, Contact::held);
      }
    }
    system(x, dxdt, 0);
    const std::optional<double> missing = energy_missing(system, x, 0.0);
    CAPTURE(k, open, stiffness, way);
    REQUIRE(missing);
    CHECK(*missing == Approx(0.5 * stiffness * way * way).epsilon(1e-9));
  }
}

// A panel without a spring, at rest half-way: friction takes all that the way to its latch would need.
TEST_CASE("no energy is called missing while an elastic hold, a motor or a law may bring some in") {
  const auto missing = [](const Scene& scene, bool held) {
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    State<double> x;
    system.start(x);
    x[0] = 0.5 * (wing.hinges[1].stowed + wing.hinges[1].latched);
    if (held) system.restrain(1, true);
    return energy_missing(system, x, 0.0);
  };
  Scene scene = latching_panel();
  scene.hinges[0].spring = {0, 0};
  rub(scene.hinges[0], 0.5);
  const double way = 0.5 * std::abs(scene.hinges[0].latched - scene.hinges[0].stowed);
  REQUIRE(missing(scene, false));
  CHECK(*missing(scene, false) == Approx(0.5 * way));
  Scene held = scene; // its hold is deflected by half the travel
  held.hinges[0].release = Release{.time = 1}, held.hinges[0].hold = Hold{1e3, 0};
  CHECK_FALSE(missing(held, true));
  CHECK(missing(held, false)); // once it has let go
  Scene driven = scene, damped = scene;
  driven.hinges[0].motor = Motor{.rate = 1, .gain = 5, .torque_limit = 3};
  CHECK_FALSE(missing(driven, false));
  damped.hinges[0].damper = Damper{};
  CHECK_FALSE(missing(damped, false));
}
