// A Deployment keeps storage from run to run, and nothing else.
#include "core/deployment.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

TEST_CASE("a run does not know that the one before it ended with every hinge stuck") {
  Scene held = oracle::seed_scene(), loose = oracle::seed_scene();
  for (Hinge& hinge : held.hinges) oracle::rub(hinge, 1e3);
  for (Hinge& hinge : loose.hinges) oracle::rub(hinge, 0.01);
  Deployment kept;
  REQUIRE(kept.run(held, {}, {}).status == Status::stalled);
  const Outcome after = kept.run(loose, {}, {}), alone = Deployment().run(loose, {}, {});
  CHECK(after.status == Status::deployed);
  CHECK(after.t_end == alone.t_end);
  CHECK(after.work.rhs_evaluations == alone.work.rhs_evaluations);
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(after.peak_moment[i].value == alone.peak_moment[i].value);
}
