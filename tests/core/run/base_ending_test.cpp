// A run asked for the peaks of a free base's motion ends early, and loses none of them.
#include "core/deployment.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/real_scenes.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

#include <cstdint>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A random wing on a free base, at rest or turning, with linear or real hinges. The springs of one in five are too weak.
Scene on_free_base(std::uint64_t seed) {
  RandomScene options;
  options.bodies = 1 + static_cast<int>(seed % 4);
  options.branching = seed % 3 == 0;
  options.mass_lower = 1, options.mass_upper = 20;
  options.motion = BaseMotion::free;
  Scene scene = random_scene(seed, options);
  if (seed % 2 == 0) scene = with_real_hinges(scene, seed, {.gravity = false, .air = false});
  if (seed % 4 < 2) scene.base.rate = 0;
  for (Hinge& hinge : scene.hinges) hinge.initial_rate = 0;
  if (seed % 5 == 0)
    for (Hinge& hinge : scene.hinges) hinge.spring = {.torque_stowed = 0.05, .torque_latched = -1};
  return scene;
}

} // namespace

TEST_CASE("an early end loses no peak of a free base's motion") {
  int early_ends = 0, stalled = 0;
  for (int seed = 1; seed <= random_cases(2000, 60); ++seed) {
    const Scene scene = on_free_base(static_cast<std::uint64_t>(seed));
    Integration how;
    how.rtol = 1e-7, how.t_end = 30;
    const Outcome whole = Deployment().run(scene, how, to_the_end);
    const Outcome early = Deployment().run(scene, how, {.base_motion = true});
    CAPTURE(seed, early.t_end, early.reason, whole.reason);
    REQUIRE(early.status == whole.status);
    if (whole.status == Status::failed) continue;
    REQUIRE((early.base_peaks && whole.base_peaks));
    CHECK(early.base_peaks->angle == whole.base_peaks->angle);
    CHECK(early.base_peaks->rate == whole.base_peaks->rate);
    CHECK(early.peak_moment.size() == whole.peak_moment.size());
    for (std::size_t i = 0; i < whole.peak_moment.size(); ++i) {
      CHECK(early.peak_moment[i].value == whole.peak_moment[i].value);
      CHECK(early.peak_force[i].value == whole.peak_force[i].value);
    }
    stalled += whole.status == Status::stalled;
    early_ends += early.t_end < how.t_end;
  }
  CAPTURE(early_ends, stalled);
  CHECK(early_ends > 10);
  CHECK(stalled > 0);
}
