// No event brings energy into a wing: an engagement, a latch that lets go, a release or a contact at most takes it away.
#include "tests/core/deployment/random_lives.hpp"
#include "tests/support/random_cases.hpp"

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("the energy of a wing that nothing drives never rises, whatever happens to it") {
  long holds = 0, latched = 0, let_go = 0;
  for (int k = 0; k < random_cases(300, 80); ++k) {
    RandomScene options;
    options.bodies = 1 + k % 4;
    options.motion = k % 2 == 0 ? BaseMotion::fixed : BaseMotion::free;
    options.mass_lower = 1, options.mass_upper = 10;
    Scene scene = with_life(random_scene(31000 + k, options), 31500 + k, true);
    for (Hinge& hinge : scene.hinges) hinge.motor.reset();
    for (const Hinge& hinge : scene.hinges) holds += hinge.hold.has_value();
    CAPTURE(k);
    double least = std::numeric_limits<double>::infinity(), largest = 0, last = 0;
    Goal goal = every_peak;
    goal.to_t_end = true;
    const Outcome out = Deployment().run(scene, within(1e-9, 5), goal, [&](const Sample& sample) {
      const double total = sample.kinetic + sample.potential;
      largest = std::max({largest, std::abs(sample.kinetic), std::abs(sample.potential)});
      const bool rises = total > least + 1e-6 * (1 + largest);
      if (rises) FAIL("from " << least << " to " << total << " J at " << sample.t << " s");
      least = std::min(least, total);
      last = total;
    });
    CHECK(last == Approx(out.energy.final).margin(1e-6 * (1 + largest)));
    latched += std::ssize(out.latches), let_go += std::ssize(out.let_go);
  }
  CHECK(holds > 20);
  CHECK(latched > 50);
  CHECK(let_go > 10);
}
