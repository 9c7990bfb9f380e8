// Wings that never deploy: what is proven of them, and of which nothing is.
#include "core/deployment.hpp"
#include "tests/core/events/rubbed_wings.hpp"

#include <catch2/catch.hpp>

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

TEST_CASE("a hinge that still moves, or may, is not stalled") {
  SECTION("the root is not held: it latches first") {
    Scene scene = rubbed_seed(2.5, 2, 1);
    scene.hinges[0].friction = {};
    const Outcome out = Deployment().run(scene, within(1e-9, 60), {});
    REQUIRE(out.latches.size() >= 1);
    CHECK(out.latches[0].hinge == 0);
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
