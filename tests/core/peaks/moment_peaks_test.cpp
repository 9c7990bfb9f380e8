// The largest moment of a hinge.
#include "core/deployment.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

TEST_CASE("a peak at the very instant of the engagement is not missed") {
  // Overdamped: |T − k y − d φ̇| falls from the first, since d |M|/I > k φ̇ throughout.
  Scene scene = latching_panel();
  const double damping = 3000;
  scene.hinges[0].latch = Latch{1e4, damping};
  const ConstantDrive exact{2 / panel_inertia, pi / 2};
  for (const double rtol : {1e-4, 1e-6, 1e-9})
    with_every_method(scene, within(rtol, 3, 1e-4), to_the_end, MayGiveUp::fixed_step,
                      [&](const Outcome& out) {
                        check_latch(out, exact, 10 * rtol);
                        const double peak = damping * exact.rate() - 2;
                        CHECK(relative(out.peak_moment[0].value, peak) < 10 * rtol);
                        CHECK(out.peak_moment[0].time == out.latches[0].time);
                      });
}
