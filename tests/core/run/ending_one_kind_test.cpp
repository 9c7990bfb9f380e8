// Where a run ends that is asked for peaks of one kind, moments or forces: not before the last of them.
#include "core/deployment.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <vector>

using namespace wingspread;

TEST_CASE("a run for peaks of one kind loses none of them, and ends by a proof") {
  Integration how;
  how.t_end = 200;
  int ended = 0;
  for (const bool forces : {true, false})
    for (int k = 0; k < 12; ++k) {
      oracle::RandomScene options;
      options.bodies = 2 + k % 3;
      options.branching = k % 2 == 0;
      options.motion = BaseMotion::fixed;
      Scene scene = oracle::random_scene(300 + k, options);
      for (Hinge& hinge : scene.hinges) hinge.latch = Latch{2e4, 40};
      Goal goal{.peak_moment = !forces, .peak_force = forces, .audit = false};
      const Outcome early = Deployment().run(scene, how, goal);
      if (early.status != Status::deployed) continue;
      goal.to_t_end = true;
      const Outcome whole = Deployment().run(scene, how, goal);
      ended += early.t_end < how.t_end;
      const std::vector<Peak>& seen = forces ? early.peak_force : early.peak_moment;
      const std::vector<Peak>& all = forces ? whole.peak_force : whole.peak_moment;
      CAPTURE(forces, k, early.t_end);
      for (std::size_t i = 0; i < all.size(); ++i) CHECK(seen[i].value == all[i].value);
    }
  CHECK(ended >= 12);
}
