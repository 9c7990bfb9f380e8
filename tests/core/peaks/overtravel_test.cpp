// Overtravel over a step in which a hinge turns back, in either sense of its travel.
#include "core/peaks/overtravel.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("overtravel is that of the turn inside the step, or of the step's end", "[overtravel]") {
  for (const double sense : {1.0, -1.0}) {
    Scene scene = free_panel(0.4);
    scene.hinges[0].latched = 0.4 + sense * 1.2;
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    const System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    const Layout& at = system.layout();
    // beyond(s) = 4 a s (1 − s) + b s: it turns inside the step
    const auto most = [&](double a, double b, double h, double before) {
      Step<double> step;
      step.t = 1, step.h = h;
      step.x = {0.4, -sense * (4 * a + b) / h};
      step.dxdt = {step.x[1], sense * 8 * a / (h * h)};
      step.x1 = {0.4 - sense * b, -sense * (b - 4 * a) / h};
      step.dxdt1 = {step.x1[1], sense * 8 * a / (h * h)};
      double found = before;
      raise_overtravel(found, wing, at, step, 1);
      return found;
    };
    // beyond(s) = a s² − b s³: it sets out from rest, and turns at s = 2a/3b if that is inside
    const auto from_rest = [&](double a, double b, double h) {
      Step<double> step;
      step.t = 1, step.h = h;
      step.x = {0.4, 0};
      step.dxdt = {0, -sense * 2 * a / (h * h)};
      step.x1 = {0.4 - sense * (a - b), -sense * (2 * a - 3 * b) / h};
      step.dxdt1 = {step.x1[1], -sense * (2 * a - 6 * b) / (h * h)};
      double found = 0;
      raise_overtravel(found, wing, at, step, 1);
      return found;
    };
    CAPTURE(sense);
    CHECK(from_rest(0.06, 0.06, 0.3) == Approx(4. / 27 * 0.06));
    CHECK(from_rest(0.06, 0.12, 3) == Approx(4. / 27 * 0.06 * 0.25)); // well on its way at the end
    CHECK(from_rest(0.06, 0.04, 0.3) == Approx(0.02));                // turns at the end
    CHECK(from_rest(-0.06, -0.03, 0.3) == 0);                         // the way to the latch
    CHECK(most(0.05, 0, 0.3, 0) == Approx(0.05));
    CHECK(most(0.05, 0.04, 2, 0) == Approx(0.05 * 1.2 * 1.2));
    CHECK(most(0.05, -0.04, 2, 0) == Approx(0.05 * 0.8 * 0.8));
    CHECK(most(0.01, 0.2, 0.3, 0) == Approx(0.2)); // at the end
    CHECK(most(-0.05, 0, 0.3, 0) == 0);            // the way to the latch
    CHECK(most(0.05, 0, 0.3, 0.06) == 0.06);       // less than before
  }
}
