#include "core/methods/spectral_radius.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("the spectral radius is found within a fifth") {
  for (const auto& [stiffness, damping] : {std::pair(1e4, 1.), {1e4, 1e4}, {1e9, 1e3}, {0., 10.}}) {
    Scene scene = latching_panel();
    scene.hinges[0].latch = Latch{stiffness, damping};
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    State<double> x;
    system.start(x);
    SpectralRadius<double> radius;
    CHECK(radius.estimate(system, x, 0.0) == 0); // constant moment, no latch yet
    system.engage(1);
    // I λ² + d λ + k = 0
    const double d = damping / panel_inertia / 2, k = stiffness / panel_inertia;
    const double exact = d * d < k ? std::sqrt(k) : d + std::sqrt(d * d - k);
    CAPTURE(stiffness, damping);
    CHECK(radius.estimate(system, x, 0.0) == Approx(exact).epsilon(0.2));
  }
}
