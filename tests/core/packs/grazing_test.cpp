// Latches just before a turning point: a run in a lane must find the latch as the run alone does, though
// the hinge has turned back at the step's end.
#include "tests/core/packs/same_bits.hpp"
#include "tests/support/closed_forms.hpp"

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("a run in a lane has the bits of the run alone: hinges that graze their latches") {
  std::vector<Scene> scenes;
  for (int k = 0; k < 200; ++k) {
    Draws draws(3000 + k);
    Scene scene = harmonic_panel(); // turns at −90°
    Hinge& hinge = scene.hinges[0];
    const double stiffness = draws.uniform(0.5, 3);
    hinge.latched = -hinge.stowed * (1 - draws.log_uniform(1e-6, 1e-1));
    pull_towards(hinge, 0, stiffness);
    hinge.latch = Latch{1e4 * draws.uniform(0.5, 2), 100};
    scenes.push_back(scene);
  }
  for (const double rtol : {1e-3, 1e-6, 1e-9})
    for (const Goal& goal : {Goal{.audit = false}, latches_only}) {
      Integration how = within(rtol, 15);
      CAPTURE(rtol, goal.peak_force);
      long latched = 0;
      for (const Scene& scene : scenes)
        latched += !Deployment().run(scene, how, goal).latches.empty();
      CHECK(latched > 150); // loose steps' interpolants miss the latch of some
      require_equal_bits(scenes, how, goal);
    }
}
