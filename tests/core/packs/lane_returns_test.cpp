// How often lanes ask their runs where nothing happens.
#include "tests/core/packs/same_bits.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE(
    "a run in a lane is asked for its proofs and radii only, in the first phase as in the last") {
  // a swing of 200 periods without an event; a stop far off makes the hinge real, and the radius is then measured
  std::vector<Scene> scenes;
  for (int k = 0; k < 12; ++k) {
    scenes.push_back(unit_oscillator(1 + 0.02 * k));
    scenes.back().hinges[0].far_stop = Stop{500, 0.2, 10};
  }
  const Goal goal{.peak_moment = false,
                  .peak_force = false,
                  .overtravel = false,
                  .audit = false,
                  .to_t_end = true};
  for (const char* method : {"auto", "dopri5"})
    for (const InstructionSet set : instruction_sets()) {
      if (set == InstructionSet::scalar) continue;
      Integration how = within(1e-8, 1200);
      how.method = method;
      long steps = 0;
      const Occupancy lanes = run_in_lanes(set, scenes, how, goal, [&](long, Outcome&& out) {
        steps += out.work.steps + out.work.rejected;
      });
      CAPTURE(method, to_string(set), steps, lanes.returns);
      CHECK(steps > 1000 * std::ssize(scenes));
      CHECK(lanes.returns < steps / 60 + 8 * std::ssize(scenes));
    }
}
