// Gravity and air: whole runs against closed forms, and what they must keep.
#include "tests/core/deployment/real_runs.hpp"

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

constexpr double g = 9.80665;

/// A pendulum let go at `amplitude` from its lowest point, which is its latched angle.
Scene pendulum(double amplitude) {
  Scene scene = free_panel(-pi / 2 + amplitude);
  scene.hinges[0].latched = -pi / 2;
  scene.environment.gravity = {0, -g};
  return scene;
}

void check_same(const Outcome& out, const Outcome& exact, double tolerance) {
  REQUIRE(out.latches.size() == exact.latches.size());
  for (std::size_t k = 0; k < exact.latches.size(); ++k) {
    REQUIRE(out.latches[k].hinge == exact.latches[k].hinge);
    CHECK(relative(out.latches[k].time, exact.latches[k].time) < tolerance);
    for (std::size_t j = 0; j < exact.latches[k].rates.size(); ++j)
      CHECK(std::abs(out.latches[k].rates[j] - exact.latches[k].rates[j]) < 10 * tolerance);
  }
  for (std::size_t i = 0; i < exact.peak_moment.size(); ++i) {
    CHECK(relative(out.peak_moment[i].value, exact.peak_moment[i].value) < 10 * tolerance);
    CHECK(relative(out.peak_force[i].value, exact.peak_force[i].value) < 10 * tolerance);
  }
}

} // namespace

TEST_CASE("a pendulum's quarter swing is an elliptic integral") {
  for (const double amplitude : {0.1, 1.2, 2.8}) {
    Scene scene = pendulum(amplitude);
    scene.hinges[0].latch = Latch{};
    CAPTURE(amplitude);
    const Arrival exact = pendulum_arrival(panel_inertia, 10 * g * 0.5, amplitude);
    check_arrival(run_everywhere(scene, 1e-11, 5), exact, 1e-8);
    scene.environment.gravity = {0, 0};
    scene.base.motion = BaseMotion::prescribed; // the lift that goes up
    scene.base.acceleration = {0, g};
    check_arrival(run_everywhere(scene, 1e-11, 5), exact, 1e-8);
  }
}

TEST_CASE("a pendulum comes back after its period, with its energy") {
  for (const double amplitude : {0.1, 1.2, 2.8}) {
    const double period = 4 * pendulum_arrival(panel_inertia, 10 * g * 0.5, amplitude).time;
    const Outcome out = run_everywhere(pendulum(amplitude), 1e-11, 3 * period, true);
    CAPTURE(amplitude, out.energy.drift_before_first_latch);
    CHECK(std::abs(out.final.angles[0] + pi / 2 - amplitude) < 1e-8);
    CHECK(std::abs(out.final.rates[0]) < 1e-7);
    CHECK(out.energy.drift_before_first_latch < 1e-9 * 10 * g); // J of half a metre up and down
  }
}

TEST_CASE("the hinge of a pendulum at rest carries its weight") {
  Scene scene = pendulum(0);
  scene.hinges[0].stowed = -pi / 2, scene.hinges[0].latched = 0;
  const Outcome out = run_everywhere(scene, 1e-10, 1, true);
  CHECK(relative(out.peak_force[0].value, 10 * g) < 1e-10);
  CHECK(std::abs(out.final.angles[0] + pi / 2) < 1e-12);
}

TEST_CASE("a wing that falls freely deploys as without gravity") {
  Scene scene = two_wing_free_spacecraft();
  const Outcome weightless = run(scene, 1e-10, 10);
  scene.environment.gravity = {1.5, -g};
  const Outcome falling = run_everywhere(scene, 1e-10, 10, true);
  check_same(falling, weightless, 1e-8);
  const Eigen::Vector2d fallen = 0.5 * 100 * scene.environment.gravity;
  CHECK((falling.final.base_position - weightless.final.base_position - fallen).norm() < 1e-7);
  CHECK((falling.final.base_velocity - weightless.final.base_velocity -
         10 * scene.environment.gravity)
            .norm() < 1e-7);
}

TEST_CASE("a base that is made to fall frees its wing of gravity") {
  Scene scene = seed_scene();
  const Outcome weightless = run(scene, 1e-10, 8);
  scene.base.motion = BaseMotion::prescribed;
  scene.environment.gravity = scene.base.acceleration = {-3, 5};
  check_same(run_everywhere(scene, 1e-10, 8, true), weightless, 1e-8);
}

TEST_CASE("a tilted hinge line: gravity in the plane pulls, and the energy stays") {
  Scene scene = seed_scene();
  scene.environment.gravity = {0.1, -0.05};
  const Outcome out = run_everywhere(scene, 1e-9, 12);
  CHECK(out.energy.drift_before_first_latch < 1e-8 * std::abs(out.energy.initial));
  CHECK(out.energy.drift_before_first_latch > 0);
  const ReferenceOutcome exact = real_reference(scene, 7);
  compare(run_everywhere(scene, 1e-10, 7, true), exact, 1e-8, 1e-7);
}

TEST_CASE("a wing in the air agrees with the reference, on every base", "[long]") {
  for (const BaseMotion motion : {BaseMotion::fixed, BaseMotion::prescribed, BaseMotion::free}) {
    Scene scene = seed_scene();
    scene.base.motion = motion;
    scene.base.mass = 200, scene.base.inertia = 80;
    scene.base.acceleration = {0.2, -0.1}, scene.base.angular_acceleration = 0.05;
    if (motion == BaseMotion::free) scene.base.velocity = {0.5, 0.2};
    scene.environment.air_density = 1.2, scene.environment.gravity = {0.05, 0.02};
    for (Body& body : scene.bodies) body.plate = Plate{{-0.5, 0}, {0.5, 0.02}, 1, 1.6};
    CAPTURE(static_cast<int>(motion));
    const ReferenceOutcome exact = real_reference(scene, 9);
    CHECK(!exact.latches.empty());
    const Outcome out = run_everywhere(scene, 1e-11, 9, true);
    compare(out, exact, 1e-8, 1e-6);
    for (int i = 0; i < 3; ++i) CHECK(std::abs(out.final.angles[i] - exact.final.angles(i)) < 1e-8);
    if (motion == BaseMotion::free)
      CHECK((out.final.base_position - exact.final.base_position).norm() < 1e-8);
  }
}
