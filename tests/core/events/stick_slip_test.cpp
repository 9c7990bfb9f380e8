// Latched hinges that creep to where their load is the limit of friction: they must not stick and slip by rounding.
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/whole_runs.hpp"

#include <catch2/catch.hpp>

#include <numbers>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A folded chain on a free base with latches from lightly damped to overdamped, and τ_s = τ_c.
Scene draw_creeping_chain(std::uint64_t seed) {
  Draws draws(seed);
  Scene scene;
  scene.base.motion = BaseMotion::free;
  scene.base.mass = draws.log_uniform(3, 100), scene.base.inertia = 0.3 * scene.base.mass;
  scene.base.velocity = {draws.uniform(-0.3, 0.3), draws.uniform(-0.3, 0.3)};
  const int bodies = 1 + draws.below(3);
  double length_before = 0;
  for (int k = 0; k < bodies; ++k) {
    const double length = draws.uniform(0.4, 1.2), mass = draws.log_uniform(1, 15);
    Body body;
    body.name = "b" + std::to_string(k), body.mass = mass, body.inertia = mass * length * length / 12;
    scene.bodies.push_back(body);
    Hinge hinge;
    hinge.name = "h" + std::to_string(k), hinge.child = k, hinge.parent = k - 1; // base_index: -1
    hinge.parent_point = k == 0 ? Eigen::Vector2d(0.2, 0.05) : Eigen::Vector2d(length_before / 2, 0);
    hinge.child_point = {-length / 2, 0.01};
    hinge.stowed = (k % 2 == 0 ? 1 : -1) * std::numbers::pi / (k == 0 ? 2 : 1);
    length_before = length;
    const double torque = draws.log_uniform(0.5, 4), stiffness = draws.log_uniform(1e4, 5e5);
    const double critical = 2 * std::sqrt(stiffness * body.inertia);
    hinge.spring = {torque, torque};
    hinge.latch = Latch{stiffness, critical * draws.log_uniform(0.01, 30)};
    hinge.friction.model = FrictionModel::exact;
    hinge.friction.coulomb = torque * draws.uniform(0.05, 0.3);
    scene.hinges.push_back(hinge);
  }
  return scene;
}

} // namespace

TEST_CASE("creep to the limit of friction costs no more than with a higher static limit") {
  for (int seed = 0; seed < random_cases(500, 12); ++seed) {
    Scene scene = draw_creeping_chain(seed);
    for (const double rtol : {1e-8, 1e-6}) {
      const Outcome creeping = run(scene, rtol, 12);
      Scene held = scene;
      for (Hinge& hinge : held.hinges) hinge.friction.static_level = 1.2 * hinge.friction.coulomb;
      CAPTURE(seed, rtol, creeping.reason);
      CHECK(creeping.status != Status::failed);
      CHECK(creeping.work.rhs_evaluations < 20 * run(held, rtol, 12).work.rhs_evaluations);
    }
  }
}

TEST_CASE("the margin of a release moves peaks and latches by no more than the tolerance") {
  for (int seed = 100; seed < random_cases(200, 106); ++seed) {
    const Scene scene = draw_creeping_chain(seed);
    const Outcome coarse = run(scene, 1e-8, 6), fine = run(scene, 1e-11, 6);
    CAPTURE(seed);
    REQUIRE(coarse.latches.size() == fine.latches.size());
    for (std::size_t k = 0; k < fine.latches.size(); ++k)
      CHECK(coarse.latches[k].time == Approx(fine.latches[k].time).epsilon(1e-6));
    for (std::size_t i = 0; i < scene.hinges.size(); ++i)
      CHECK(coarse.peak_moment[i].value == Approx(fine.peak_moment[i].value).epsilon(1e-5));
  }
}
