// Natural modes of wings that elastic holds hold, against closed forms.
#include "core/proofs/natural_modes.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <vector>

using namespace wingspread;

TEST_CASE("a hinge on its elastic hold swings with the hinge that a loop ties to it") {
  // K = [[k_latch + c g², −c g], [−c g, k_hold + c + spring's slope]], M = diag(1, 2)
  Scene scene;
  for (const auto& [name, inertia] : {std::pair("latched", 1.0), {"held", 2.0}}) {
    Body body;
    body.name = name, body.mass = 3, body.inertia = inertia;
    scene.bodies.push_back(body);
    Hinge hinge;
    hinge.name = name, hinge.child = static_cast<int>(scene.bodies.size()) - 1;
    hinge.stowed = 1, hinge.latched = 0, hinge.latch = Latch{1000, 0.05};
    scene.hinges.push_back(hinge);
  }
  Hinge& held = scene.hinges[1];
  held.release = Release{.time = 400}, held.hold = Hold{400, 0.02};
  Synchronisation loop;
  loop.name = "loop", loop.first = 0, loop.second = 1, loop.stiffness = 50;
  for (const double gear : {1.0, -0.5}) {
    loop.ratio = gear, loop.damping = 0.01;
    scene.synchronisations = {loop};
    for (const double slope : {0.0, 30.0}) {
      held.spring.torque_stowed = slope, held.spring.torque_latched = 0;
      const auto found = natural_modes(scene, std::vector<int>{0});
      REQUIRE((found && found->modes.size() == 2));
      Eigen::MatrixXd K(2, 2), C(2, 2), M = Eigen::Vector2d(1, 2).asDiagonal();
      K << 1000 + 50 * gear * gear, -50 * gear, -50 * gear, 400 + 50 + slope;
      C << 0.05 + 0.01 * gear * gear, -0.01 * gear, -0.01 * gear, 0.02 + 0.01;
      const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(K, M);
      for (int k = 0; k < 2; ++k) {
        const double omega = std::sqrt(modes.eigenvalues()(k));
        const Eigen::VectorXd v = modes.eigenvectors().col(k);
        CHECK(found->modes[k].frequency == Approx(omega / (2 * std::numbers::pi)).epsilon(1e-10));
        CHECK(found->modes[k].damping_ratio ==
              Approx(v.dot(C * v) / (2 * omega * v.dot(M * v))).epsilon(1e-8));
      }
    }
  }
  const auto none_latched = natural_modes(scene, std::vector<int>{});
  REQUIRE(none_latched);
  CHECK(none_latched->modes.size() == 1); // the other is held rigidly
  scene.synchronisations.clear();         // −400 (φ − 1) − 30 φ = 0
  const auto alone = natural_modes(scene, std::vector<int>{0});
  REQUIRE(alone);
  CHECK(alone->rest[1] == Approx(400.0 / 430).epsilon(1e-12));
}
