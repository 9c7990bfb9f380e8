#include "tests/support/dense_wing.hpp"
#include "tests/support/drifted.hpp"
#include "tests/support/random_scenes.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <stdexcept>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The largest difference of the accelerations, relative to the largest of them.
double difference(const Vector<double>& found, const Vector<double>& expected) {
  return (found - expected).lpNorm<Eigen::Infinity>() / (1 + expected.lpNorm<Eigen::Infinity>());
}

} // namespace

TEST_CASE("the smooth step goes from 0 to 1 with level ends") {
  CHECK(smooth_step(-0.1) == 0);
  CHECK(smooth_step(0.5) == 0.5);
  CHECK(smooth_step(0.25) == 0.15625); // u²(3 − 2u)
  CHECK(smooth_step(1.1) == 1);
}

TEST_CASE("a panel on a fixed base turns about its hinge: J + m c²") {
  const DenseWing<double> wing(harmonic_panel());
  WingState<double> state = wing.initial_state();
  CHECK(wing.respond(state).hinge_accelerations(0) == Approx(-2 / 3.).epsilon(4 * epsilon));

  state.angles(0) = 0.7;
  state.rates(0) = -1.3;
  const WingResponse<double> response = wing.respond(state);
  const double acceleration = -2 * 0.7 / (std::acos(-1.) / 2) / 3;
  CHECK(response.moments(0) == Approx(3 * acceleration));
  CHECK(response.hinge_accelerations(0) == Approx(acceleration));
  // the hinge carries the panel's mass: tangentially m c φ̈, centripetally m c φ̇²
  CHECK(response.forces.col(0).norm() == Approx(10 * 0.5 * std::hypot(acceleration, 1.3 * 1.3)));
}

TEST_CASE("a panel on an accelerated base is a pendulum, on a turning one feels its rate") {
  Scene scene = harmonic_panel();
  scene.hinges[0].spring = {};
  scene.hinges[0].parent_point = {0.4, 0};
  scene.base.motion = BaseMotion::prescribed;
  scene.base.acceleration = {0, 9.81};
  WingState<double> state = DenseWing<double>(scene).initial_state();
  state.angles(0) = 0.6;
  const double pendulum = -10 * 0.5 * 9.81 * std::cos(0.6) / 3;
  CHECK(DenseWing<double>(scene).respond(state).hinge_accelerations(0) == Approx(pendulum));

  scene.base.acceleration.setZero();
  state.base_rate = 1.5;
  const double centrifugal = -10 * 0.5 * 0.4 * 1.5 * 1.5 * std::sin(0.6) / 3;
  CHECK(DenseWing<double>(scene).respond(state).hinge_accelerations(0) == Approx(centrifugal));
  CHECK(DenseWing<double>(scene).respond(state).base_angular_acceleration == 0);
}

TEST_CASE("two free bodies obey the two equations written by hand") {
  // With u = R(θ0) c_pi, v = −R(θ1) c_ii, reduced mass μ, and the moment M across the hinge:
  //   (J0 + μu²) ω̇0 + μ u·v ω̇1 = −M + μ ω1² u×v
  //   μ u·v ω̇0 + (J1 + μv²) ω̇1 =  M − μ ω0² u×v
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RandomScene options;
    options.bodies = 1;
    options.motion = BaseMotion::free;
    const Scene scene = random_scene(seed, options);
    const WingState<double> state = random_state(seed, scene);
    const WingResponse<double> response = DenseWing<double>(scene).respond(state);

    const double theta0 = state.base_angle, theta1 = theta0 + state.angles(0);
    const double omega0 = state.base_rate, omega1 = omega0 + state.rates(0);
    const Eigen::Vector2d u = Eigen::Rotation2Dd(theta0) * scene.hinges[0].parent_point;
    const Eigen::Vector2d v = Eigen::Rotation2Dd(theta1) * -scene.hinges[0].child_point;
    const double m0 = scene.base.mass, m1 = scene.bodies[0].mass, mu = m0 * m1 / (m0 + m1);
    const double moment = response.moments(0);
    Eigen::Matrix2d mass;
    mass << scene.base.inertia + mu * u.squaredNorm(), mu * u.dot(v), //
        mu * u.dot(v), scene.bodies[0].inertia + mu * v.squaredNorm();
    const Eigen::Vector2d right{-moment + mu * omega1 * omega1 * cross(u, v),
                                moment - mu * omega0 * omega0 * cross(u, v)};
    const Eigen::Vector2d turn = mass.inverse() * right;
    const Eigen::Vector2d apart = turn(0) * Eigen::Vector2d(-u.y(), u.x()) - omega0 * omega0 * u +
                                  turn(1) * Eigen::Vector2d(-v.y(), v.x()) - omega1 * omega1 * v;
    INFO("seed " << seed);
    CHECK(response.base_angular_acceleration == Approx(turn(0)).epsilon(1e-10));
    CHECK(response.hinge_accelerations(0) == Approx(turn(1) - turn(0)).epsilon(1e-10));
    CHECK((response.forces.col(0) - mu * apart).norm() < 1e-11 * (1 + mu * apart.norm()));
    CHECK((response.base_acceleration + mu / m0 * apart).norm() < 1e-11 * (1 + apart.norm()));
  }
}

TEST_CASE("double and quadruple precision agree as far as the mass matrix lets them") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed) % 12;
    options.branching = seed % 2 == 0;
    const Scene scene = random_scene(seed, options);
    const WingState<double> state = random_state(seed + 1000, scene);
    const WingResponse<double> coarse = DenseWing<double>(scene).respond(state);
    const WingResponse<long double> better =
        DenseWing<long double>(scene).respond(state.cast<long double>());
    const WingResponse<Quad> fine = DenseWing<Quad>(scene).respond(state.cast<Quad>());
    const Vector<double> truth = fine.hinge_accelerations.cast<double>();
    INFO("seed " << seed);
    // mass ratios of 1e3 and their powers along a chain: condition numbers up to about 1e6
    CHECK(difference(coarse.hinge_accelerations, truth) < 1e-9);
    CHECK(difference(better.hinge_accelerations.cast<double>(), truth) < 1e-12);
    CHECK((better.forces.cast<double>() - fine.forces.cast<double>()).norm() <
          1e-11 * (1 + fine.forces.cast<double>().norm()));
  }
}

TEST_CASE("power balance: the rate of T + P is what friction and dampers take") {
  // a centred difference over ±h of the balance along the local parabola; its error is O(h²)
  const Quad h = 1e-12; // an engaged stiff latch on a light panel: 1e8 rad/s²
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RandomScene options;
    options.bodies = 4;
    options.motion = seed % 2 ? BaseMotion::free : BaseMotion::fixed;
    const Scene scene = random_scene(seed, options);
    const DenseWing<Quad> wing(scene);
    const WingState<Quad> state = random_state(seed, scene).cast<Quad>();
    const WingResponse<Quad> response = wing.respond(state);
    const WingBalance<Quad> after = wing.balance(drifted(state, response, h));
    const WingBalance<Quad> before = wing.balance(drifted(state, response, -h));
    double taken = 0;
    for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
      const Friction& friction = scene.hinges[i].friction;
      const double rate = static_cast<double>(state.rates(i));
      const double damping = state.engagement(i) == 1 ? scene.hinges[i].latch->damping : 0;
      taken += (friction.viscous + damping) * rate * rate +
               friction.coulomb * rate * rate / std::hypot(rate, friction.regularization_rate);
    }
    const Quad power =
        (after.kinetic + after.potential - before.kinetic - before.potential) / (2 * h);
    INFO("seed " << seed);
    CHECK(static_cast<double>(power) == Approx(-taken).epsilon(1e-8).margin(1e-8));
    if (scene.base.motion != BaseMotion::free) continue;
    const Quad torque = (after.angular_momentum - before.angular_momentum) / (2 * h);
    CHECK(std::abs(static_cast<double>(torque)) < 1e-8 * (1 + taken));
  }
}

TEST_CASE("the order in which bodies and hinges are listed does not matter") {
  const Scene scene = two_wing_free_spacecraft();
  Scene shuffled = scene;
  const int n = static_cast<int>(scene.hinges.size());
  for (int i = 0; i < n; ++i) {
    Hinge& hinge = shuffled.hinges[n - 1 - i] = scene.hinges[i];
    if (hinge.parent != base_index) hinge.parent = n - 1 - hinge.parent;
    hinge.child = n - 1 - hinge.child;
    shuffled.bodies[n - 1 - i] = scene.bodies[i];
  }
  const WingState<double> state = random_state(7, scene);
  WingState<double> reversed = state;
  reversed.angles.reverseInPlace();
  reversed.rates.reverseInPlace();
  reversed.engagement.reverseInPlace();
  const Vector<double> there = DenseWing<double>(scene).respond(state).hinge_accelerations;
  const Vector<double> back = DenseWing<double>(shuffled).respond(reversed).hinge_accelerations;
  CHECK(difference(back.reverse(), there) < 1e-12);
}

TEST_CASE("a chain of 1000 panels is within reach, in long double too") {
  RandomScene options;
  options.bodies = 1000;
  options.branching = false;
  options.mass_lower = 5;
  options.mass_upper = 20;
  const Scene scene = random_scene(3, options);
  const WingState<double> state = random_state(4, scene);
  const Vector<double> found = DenseWing<double>(scene).respond(state).hinge_accelerations;
  const Vector<double> truth = DenseWing<long double>(scene)
                                   .respond(state.cast<long double>())
                                   .hinge_accelerations.cast<double>();
  CHECK(difference(found, truth) < 1e-8);
}

TEST_CASE("what the dense wing cannot do it refuses") {
  Scene scene = seed_scene();
  scene.hinges[0].friction.model = FrictionModel::exact;
  CHECK_THROWS_WITH(DenseWing<double>(scene), "DenseWing: exact friction is not smooth");
  scene = seed_scene();
  scene.hinges[0].parent = 2; // a ring
  CHECK_THROWS_WITH(DenseWing<double>(scene), "DenseWing: the hinges do not form a tree");
}
