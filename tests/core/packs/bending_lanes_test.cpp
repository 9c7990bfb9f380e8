// Runs of wings that bend have the bits of the runs alone: each lane has its own run's segments and joints.
#include "core/deployment.hpp"
#include "tests/core/packs/same_bits.hpp"
#include "tests/support/bending_scenes.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// `count` units of a wing, with dispersed panels, joints, laws and base. One is unphysical; in one a hinge sits at the other end of
/// its panel, and so on another segment.
std::vector<Scene> bending_units(const Scene& drawing, int count) {
  std::vector<Scene> scenes;
  for (int k = 0; k < count; ++k) {
    Draws draws(500 + k);
    Scene scene = drawing;
    for (Body& body : scene.bodies) {
      body.mass *= draws.uniform(0.9, 1.1), body.inertia *= draws.uniform(0.95, 1.05);
      if (!body.flexible) continue;
      if (body.flexible->frequency) *body.flexible->frequency *= draws.uniform(0.8, 1.2);
      if (body.flexible->bending_stiffness)
        *body.flexible->bending_stiffness *= draws.uniform(0.8, 1.2);
      body.flexible->damping_ratio *= draws.uniform(0.5, 1.5);
      body.plate->to += 0.01 * draws.vector(1);
    }
    for (Hinge& hinge : scene.hinges) {
      hinge.spring.scale *= draws.uniform(0.9, 1.1);
      hinge.friction.scale *= draws.uniform(0.5, 2);
      if (hinge.joint) hinge.joint->stiffness *= draws.uniform(0.8, 1.2);
      if (k == 3 && hinge.parent != base_index) hinge.parent_point *= -1;
    }
    if (k == 5) scene.bodies[0].mass = -1;
    scene.base.mass *= draws.uniform(0.9, 1.1), scene.base.rate *= draws.uniform(0.9, 1.1);
    scenes.push_back(scene);
  }
  return scenes;
}

} // namespace

TEST_CASE("a run in a lane has the bits of the run alone: random wings that bend") {
  Integration how;
  how.rtol = 1e-5, how.atol = 1e-7, how.t_end = 1, how.max_steps = 3000;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 4);
    options.mass_lower = 1, options.mass_upper = 20;
    options.motion = static_cast<BaseMotion>(seed % 3);
    const Scene scene = with_bending(random_scene(seed, options), seed);
    CAPTURE(seed);
    Goal goal = seed % 2 == 0 ? every_peak : latches_alone;
    goal.mode_frequencies = seed % 4 == 0;
    require_equal_bits(bending_units(scene, 8), how, goal);
  }
}
