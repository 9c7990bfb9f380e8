// The loads on a hinge just behind an angle at which one of its laws sets in.
#include "tests/core/deployment/real_runs.hpp"

#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("the hinge's peak force is that with which a panel enters its damper's window") {
  constexpr double mass = 10, lever = 0.5; // of latching_panel's centre of mass
  for (int seed = 1; seed <= 20; ++seed) {
    Draws draws(seed);
    const double rate = draws.log_uniform(0.1, 2), c = draws.log_uniform(20, 200);
    const double enters = draws.uniform(0.05, 0.5);
    Scene scene = thrown_panel(rate);
    Damper& damper = scene.hinges[0].damper.emplace();
    damper.coefficient = c, damper.window = {enters, enters + draws.uniform(0.1, 0.4)};
    const double braking = c * rate / panel_inertia; // rad/s²
    const double force = mass * lever * std::hypot(braking, rate * rate);
    for (const Scene& way : {scene, other_sense(scene)})
      for (const char* method :
           {"auto", "dopri5", "bulirsch_stoer", "adams_bashforth_moulton", "seulex"}) {
        Integration how = within(1e-9, 3 / rate);
        how.method = method;
        const Outcome out = Deployment().run(way, how, to_the_end);
        CAPTURE(seed, method, rate, c, out.reason);
        CHECK(out.peak_force[0].value == Approx(force).epsilon(1e-9));
        CHECK(out.peak_moment[0].value == Approx(c * rate).epsilon(1e-9));
        CHECK(out.peak_force[0].time == Approx(enters / rate).epsilon(1e-6));
      }
  }
}
