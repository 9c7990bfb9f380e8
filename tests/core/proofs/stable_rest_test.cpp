// The rest about which a wing without latches swings: stable, and balanced by the dense formulation.
#include "core/proofs/natural_modes.hpp"
#include "tests/core/proofs/dense_rest.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/decompositions.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// Hinges without latches between two stops, with flat springs that push away from one of them.
Scene stopped_wing(std::uint64_t seed) {
  RandomScene options;
  options.bodies = 1 + static_cast<int>(seed % 4);
  options.friction = options.harness = options.latches = false;
  options.motion = seed % 3 == 0 ? BaseMotion::free : BaseMotion::fixed;
  Scene scene = random_scene(seed, options);
  Draws draws(seed + 40);
  if (seed % 3 == 1) scene.environment.gravity = draws.vector(0.5);
  for (Hinge& hinge : scene.hinges) {
    if (hinge.stowed == hinge.latched) hinge.latched += 1;
    hinge.spring = {};
    hinge.spring.torque_stowed = draws.uniform(-0.5, 2);
    hinge.spring.torque_latched =
        draws.chance(0.5) ? hinge.spring.torque_stowed : draws.uniform(-0.5, 2);
    hinge.stop = Stop{draws.log_uniform(30, 3e4), 0.2, draws.uniform(0, 0.3)};
    hinge.far_stop = Stop{draws.log_uniform(30, 3e4), 0.2, draws.uniform(0, 0.3)};
  }
  return scene;
}

/// Whether a hinge rests so near to the contact with a stop that differences cross it.
bool barely_touches(const Scene& scene, const std::vector<double>& rest) {
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Hinge& hinge = scene.hinges[i];
    const double sense = hinge.latched > hinge.stowed ? 1 : -1;
    for (const double way : {sense * (rest[i] - hinge.latched) - hinge.far_stop->gap,
                             sense * (hinge.stowed - rest[i]) - hinge.stop->gap})
      if (std::abs(way) < 1e-4) return true;
  }
  return false;
}

} // namespace

TEST_CASE("a wing between stops swings about a rest that balances and is stable") {
  const auto cases = static_cast<std::uint64_t>(random_cases(400, 60));
  long off = 0;
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    const Scene scene = stopped_wing(seed);
    CAPTURE(seed);
    const std::optional<WingModes> found = natural_modes(scene);
    REQUIRE(found);
    const DenseRest dense(scene, found->rest, {});
    for (std::size_t i = 0; i < scene.hinges.size(); ++i)
      off += std::abs(found->rest[i] - scene.hinges[i].latched) > 0.1;
    const double stiffest = dense.stiffness.cwiseAbs().maxCoeff();
    CHECK(dense.unbalanced.cwiseAbs().maxCoeff() < 1e-9 * (1 + stiffest));
    if (barely_touches(scene, found->rest)) continue;
    const Eigen::MatrixXd symmetric = 0.5 * (dense.stiffness + dense.stiffness.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(symmetric);
    CHECK(modes.eigenvalues()(0) > -1e-6 * stiffest);
    const auto wanted = dense.modes();
    REQUIRE(wanted.size() == found->modes.size());
    for (std::size_t k = 0; k < wanted.size(); ++k)
      CHECK(found->modes[k].frequency == Approx(wanted[k][0]).epsilon(1e-5).margin(1e-5));
  }
  CHECK(off > static_cast<long>(cases)); // most rest elsewhere than at the latched angle
}

TEST_CASE("a constant spring swings about its far stop, and about gravity's balance, not at an "
          "angle that is no rest") {
  Scene scene = latching_panel(); // 10 kg, its centre of mass lies 0.5 m along +x of the hinge
  Hinge& hinge = scene.hinges[0];
  hinge.latch.reset();
  hinge.stowed = -1.5, hinge.latched = 0;
  hinge.spring = {};
  hinge.spring.torque_stowed = hinge.spring.torque_latched = 1;
  CHECK_FALSE(natural_modes(scene)); // it turns on and on
  CHECK(natural_frequencies(scene).empty());
  hinge.far_stop = Stop{100, 0.3, 0.1};
  const std::optional<WingModes> stopped = natural_modes(scene);
  REQUIRE(stopped);
  CHECK(stopped->rest[0] == Approx(0.11).epsilon(1e-12));
  CHECK(stopped->modes[0].frequency == Approx(hertz(std::sqrt(100 / panel_inertia))));
  hinge.far_stop.reset();
  for (const Eigen::Vector2d& g : {Eigen::Vector2d(0.25, 0), Eigen::Vector2d(0, -0.25),
                                   Eigen::Vector2d(-0.15, -0.2), Eigen::Vector2d(-0.25, 0)}) {
    scene.environment.gravity = g;
    const std::optional<WingModes> hung = natural_modes(scene);
    REQUIRE(hung);
    const double phi = hung->rest[0];
    // moment 1 + m l (g_y cos φ − g_x sin φ); its stiffness m l (g_y sin φ + g_x cos φ) is √(1.25² − 1)
    CHECK(1 + 5 * (g.y() * std::cos(phi) - g.x() * std::sin(phi)) == Approx(0).margin(1e-11));
    CHECK(hung->modes[0].frequency == Approx(hertz(std::sqrt(0.75 / panel_inertia))).epsilon(1e-9));
  }
}
