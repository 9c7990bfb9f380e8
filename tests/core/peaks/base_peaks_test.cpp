#include "core/deployment.hpp"
#include "core/peaks/base_peaks.hpp"
#include "tests/support/closed_forms.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("the largest magnitude of a polynomial is found inside its interval", "[peaks]") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int n = 0; n < 200; ++n) {
    Quintic<double> p;
    for (double& c : p) c = uniform(random);
    double most = 0, sampled = 0;
    raise_magnitude(most, p);
    for (int k = 0; k <= 20000; ++k) sampled = std::max(sampled, std::abs(value(p, k / 20000.0)));
    // |p''| <= 20 · 4, so that between samples the crest is at most 80/8 (5e-5)² higher
    CHECK(most >= sampled * (1 - 1e-15));
    CHECK(most <= sampled + 3e-8);
  }
  double most = 3;
  raise_magnitude(most, Quintic<double>{1, 2, -2, 1, 0, 1});
  CHECK(most == 3); // nothing exceeds what is known
}

namespace {

/// A free base and a panel that are hinged at the mass centres of both, with a spring about φ = 0: the relative angle
/// swings as φ_0 cos ωt, and the base turns against it by I_p/(I_b + I_p) of that.
struct Swing {
  static constexpr double base = 3, panel = 1, start = 0.7, stiffness = 2;
  [[nodiscard]] static Scene scene() {
    Scene scene = unit_oscillator(start);
    scene.base.motion = BaseMotion::free;
    scene.base.mass = 100, scene.base.inertia = base;
    scene.base.angle = 0.4;
    scene.bodies[0].inertia = panel;
    Hinge& hinge = scene.hinges[0];
    hinge.parent_point.setZero(), hinge.child_point.setZero();
    pull_towards(hinge, 0, stiffness);
    return scene;
  }
  static constexpr double share = panel / (base + panel);
  [[nodiscard]] static double omega() {
    return std::sqrt(stiffness * (base + panel) / (base * panel));
  }
};

} // namespace

TEST_CASE("how far and how fast a free base turns, against its closed form", "[peaks]") {
  const Outcome out = Deployment().run(Swing::scene(), within(1e-10, 10), to_the_end);
  REQUIRE(out.base_peaks.has_value());
  CHECK(out.base_peaks->angle == Approx(2 * Swing::share * Swing::start).epsilon(1e-8));
  CHECK(out.base_peaks->rate == Approx(Swing::share * Swing::start * Swing::omega()).epsilon(1e-8));
  // Before half a period it is where it ends, and not yet a crest.
  const double quarter = 0.5 * std::acos(-1.0) / Swing::omega();
  const Outcome early = Deployment().run(Swing::scene(), within(1e-10, 0.5 * quarter), to_the_end);
  CHECK(early.base_peaks->angle ==
        Approx(Swing::share * Swing::start * (1 - std::cos(0.25 * std::acos(-1.0)))).epsilon(1e-8));
  CHECK(!Deployment().run(unit_oscillator(1), within(1e-6, 1), to_the_end).base_peaks.has_value());
}

TEST_CASE("a base that spins from the start changes its rate as one at rest does", "[peaks]") {
  const Outcome still = Deployment().run(Swing::scene(), within(1e-10, 10), to_the_end);
  for (const double spin : {-3.0, -0.2, 0.05, 4.0}) {
    Scene scene = Swing::scene();
    scene.base.rate = spin;
    const Outcome out = Deployment().run(scene, within(1e-10, 10), to_the_end);
    CAPTURE(spin);
    REQUIRE(out.base_peaks.has_value());
    CHECK(out.base_peaks->rate == Approx(still.base_peaks->rate).epsilon(1e-7));
    CHECK(std::abs(out.base_peaks->angle - std::abs(spin) * 10) <=
          still.base_peaks->angle * (1 + 1e-7));
  }
}

// The amplitudes are those of the closed form; the crests lie inside steps. Each method's own error of the swing is below
// its tolerance here, the dense output's is not: 1e-5 with the long steps of extrapolation.
TEST_CASE(
    "a free base's largest turn and rate have the accuracy of the method, not of its dense output",
    "[peaks]") {
  for (const std::string method : {"dop853", "dopri5", "fehlberg78", "bulirsch_stoer",
                                   "adams_bashforth_moulton", "cash_karp54", "seulex"})
    for (const double stiffness : {2.0, 37.0}) {
      Scene scene = Swing::scene();
      pull_towards(scene.hinges[0], 0, stiffness);
      Integration how = within(1e-8, 7);
      how.method = method;
      const Outcome out = Deployment().run(scene, how, to_the_end);
      const double omega =
          std::sqrt(stiffness * (Swing::base + Swing::panel) / (Swing::base * Swing::panel));
      REQUIRE(out.base_peaks.has_value());
      CAPTURE(method, stiffness);
      CHECK(out.base_peaks->angle == Approx(2 * Swing::share * Swing::start).epsilon(1e-7));
      CHECK(out.base_peaks->rate == Approx(Swing::share * Swing::start * omega).epsilon(1e-7));
    }
}
