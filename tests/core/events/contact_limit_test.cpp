// Exact friction against the limit of regularized friction.
#include "core/deployment.hpp"
#include "tests/core/events/regularized_limit.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("the closed form of dry friction is the limit of regularized friction") {
  struct Case {
    double viscous, u, rate;
  };
  for (const Case& c : {Case{0, 1.05, 0}, Case{0.4, 0.7, 0.5}, Case{0.2, -0.7, 0.5}}) {
    const CoulombOscillator exact({panel_inertia, panel_inertia, c.viscous, 0.3, 0.3},
                                  {c.u, c.rate});
    Scene scene = unit_oscillator(c.u, c.rate);
    rub(scene.hinges[0], 0.3);
    scene.hinges[0].friction.viscous = c.viscous;
    for (const double t : {1., 4., 7., 12.}) {
      const ReferenceOutcome limit = regularized_run(scene, 1e-8, t);
      CAPTURE(c.viscous, c.u, c.rate, t, exact.stop_time());
      CHECK(std::abs(limit.final.angles(0) - exact.at(t).u) < 3e-7); // some 10 s of creep
      CHECK(std::abs(limit.final.rates(0) - exact.at(t).rate) < 3e-7);
    }
  }
}

TEST_CASE("wings with exact friction are the limit of wings with regularized friction", "[long]") {
  SECTION("three panels that all deploy") {
    const Scene scene = rubbed_seed(0.3, 0.2, 0.05);
    const Limit limit(scene, 9);
    with_every_method(scene, within(1e-9, 9, 1e-4), to_the_end, MayGiveUp::fixed_step,
                      [&](const Outcome& out) {
                        CHECK(out.status == Status::deployed);
                        limit.check(out);
                      });
  }
  SECTION("three panels, of which one gets stuck on its way") {
    const Scene scene = rubbed_seed(0.3, 1.2, 0.6);
    const Limit limit(scene, 9);
    with_every_method(scene, within(1e-9, 9, 1e-4), to_the_end, MayGiveUp::fixed_step,
                      [&](const Outcome& out) { limit.check(out); });
  }
  SECTION("one hinge exact, its neighbours regularized") {
    Scene scene = rubbed_seed(0.3, 0.2, 0.05);
    for (int i : {0, 2}) {
      scene.hinges[i].friction.model = FrictionModel::regularized;
      scene.hinges[i].friction.regularization_rate = 0.1;
    }
    const Limit limit(scene, 9);
    with_every_method(scene, within(1e-9, 9, 1e-4), to_the_end, MayGiveUp::fixed_step,
                      [&](const Outcome& out) { limit.check(out); });
  }
  SECTION("a free spacecraft, whose momenta friction keeps") {
    Scene scene = symmetric_tree();
    for (Hinge& hinge : scene.hinges) rub(hinge, 0.2);
    const Limit limit(scene, 7);
    const DenseWing<long double> wing(regularized(scene, 1));
    with_every_method(
        scene, within(1e-9, 7, 1e-4), to_the_end, MayGiveUp::implicit, [&](const Outcome& out) {
          limit.check(out);
          // one instant, but for the round-off that extrapolation magnifies
          const bool extrapolated = methods_used(out) == "seulex";
          CHECK(out.latches[1].time - out.latches[0].time <= (extrapolated ? 1e-9 : 0));
          const auto after = wing.balance(state_of(out, wing));
          // parts of up to √(2·240 kg·2.3 J) kg·m/s of which zero is the sum
          CHECK(after.linear_momentum.norm() < 1e-12L * 33);
          CHECK(std::abs(after.angular_momentum) < 1e-12L * 33);
        });
  }
}

TEST_CASE("random wings that stick and slide are the limit of regularized ones", "[long]") {
  int at_rest = 0, latches = 0;
  for (std::uint64_t seed = 1; seed <= 36; ++seed) {
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed) % 4;
    options.motion = static_cast<BaseMotion>(seed % 3);
    options.mass_lower = 1, options.mass_upper = 20, options.friction = false;
    Scene scene = random_scene(seed, options);
    Draws draws(seed + 500);
    for (Hinge& hinge : scene.hinges) {
      rub(hinge, draws.uniform(0, 6)); // springs give 1 to 5 N·m
      hinge.latch = Latch{1e3, 30};
      if (draws.chance(0.5)) hinge.initial_rate = 0; // starts at rest: does it move, and which way?
      if (draws.chance(0.3)) hinge.friction.viscous = draws.uniform(0, 1);
    }
    const Limit limit(scene, 3);
    Integration how = within(1e-9, 3);
    const Outcome out = Deployment().run(scene, how, to_the_end);
    CAPTURE(seed, options.bodies, out.reason);
    REQUIRE(out.status != Status::failed);
    REQUIRE(out.status != Status::invalid);
    limit.check(out);
    latches += static_cast<int>(out.latches.size());
    at_rest += static_cast<int>(std::count(out.final.rates.begin(), out.final.rates.end(), 0.));
  }
  CHECK(latches >= 10);
  CHECK(at_rest >= 20); // exactly
}
