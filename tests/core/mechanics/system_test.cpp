// The right-hand side with hinges that stick, and linear solves, against a dense constrained solve.
// Without hinges that stick: recursion_test.cpp.
#include "core/mechanics/linear_solve.hpp"
#include "core/mechanics/system.hpp"
#include "tests/core/mechanics/constrained_wing.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A random wing without friction, whose root sticks and others may.
template <BaseMotion M> struct Sticking {
  RandomScene options;
  Scene scene;
  WingState<double> state;
  Constraints constraints;
  Posed<M> at;

  Sticking(std::uint64_t seed, int n, bool real)
      : options(made(n)), scene(drawn(seed, options, real)),
        state(random_state(seed + 1000, scene)), constraints(random_constraints(seed + 2000, n)),
        at(scene, state) {
    constraints.locked[at.wing.hinge_of[1]] = true;
    for (int i = 1; i <= n; ++i)
      if (constraints.locked[at.wing.hinge_of[i]]) at.system.set_contact(i, Contact::stuck);
  }

private:
  static Scene drawn(std::uint64_t seed, const RandomScene& options, bool real) {
    RealFeatures features;
    features.gravity = M != BaseMotion::fixed; // which it would make one that is driven
    const Scene scene = random_scene(seed, options);
    return real ? with_real_hinges(scene, seed + 3000, features) : scene;
  }
  static RandomScene made(int n) {
    RandomScene options = of(n, true);
    options.motion = M, options.friction = false;
    return options;
  }
};

/// The right-hand side with hinges that stick.
template <BaseMotion M> void check_right_hand_side(std::uint64_t seed, int n, bool real) {
  Sticking<M> wing(seed, n, real);
  auto& system = wing.at.system;
  const State<double>& x = wing.at.x;
  const Layout& layout = system.layout();
  wing.constraints.added.assign(n, 0);
  for (int i = 1; i <= n; ++i)
    wing.constraints.tau[wing.at.wing.hinge_of[i]] = system.sliding_moment(x, i);
  const auto expected = dense<long double>(wing.scene, wing.state, wing.constraints);

  State<double> dxdt(layout.size());
  system.want_forces(true);
  system(x, dxdt, 0.0);
  Motions<double> got{Vector<double>(n), Columns2<double>(2, n),
                      expected.base.template cast<double>(), Vector<double>(n)};
  const int v = layout.freedoms();
  if (M == BaseMotion::free) got.base << dxdt[v], dxdt[v + 1], dxdt[v + 2];
  for (int i = 1; i <= n; ++i) {
    const int hinge = wing.at.wing.hinge_of[i];
    const Vec2<double>& force = wing.at.work.forces[i];
    got.hinges(hinge) = dxdt[layout.rate(i)];
    got.forces.col(hinge) << force.x, force.y;
    got.moments(hinge) = system.moment(x, i);
    if (wing.constraints.locked[hinge])
      CHECK(system.locking_moment(x, i) == got.moments(hinge) - wing.constraints.tau[hinge]);
  }
  CAPTURE(seed, n);
  compare(got, expected, wing.constraints, 1e-12);
}

/// (M + E) q̈ = τ: a wing at rest, on a base that nothing drives.
template <BaseMotion M> void check_linear_solve(std::uint64_t seed, int n, bool real) {
  Sticking<M> wing(seed, n, real);
  auto& system = wing.at.system;
  const std::vector<int>& hinge_of = wing.at.wing.hinge_of;
  std::vector<double> qdd(system.layout().freedoms());
  LinearSolve<double> linear;
  linear.factorize(system, wing.at.x, 0.0,
                   [&](int i) { return wing.constraints.added[hinge_of[i]]; });
  linear.solve(
      system, [&](int i) { return wing.constraints.tau[hinge_of[i]]; }, qdd.data());

  Scene still = wing.scene;
  still.base.acceleration = {0, 0}, still.base.angular_acceleration = 0;
  still.environment = {};
  wing.state.rates.setZero();
  wing.state.base_rate = 0, wing.state.base_velocity.setZero();
  const auto expected = dense<long double>(still, wing.state, wing.constraints);
  Vector<double> hinges(n);
  for (int i = 1; i <= n; ++i) hinges(hinge_of[i]) = qdd[system.layout().angle(i)];
  CAPTURE(seed, n);
  CHECK(deviation(hinges, expected.hinges) < 1e-12);
  if (M == BaseMotion::free)
    CHECK(deviation(Eigen::Vector3d(qdd[0], qdd[1], qdd[2]), expected.base) < 1e-12);
}

template <BaseMotion M> void check_system(std::uint64_t seed, int n, bool real) {
  CAPTURE(static_cast<int>(M), real);
  check_right_hand_side<M>(seed, n, real);
  check_linear_solve<M>(seed, n, real);
}

} // namespace

TEST_CASE("a system with hinges that stick, and its linear solves, agree with the dense solve") {
  for (const bool real : {false, true})
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const int n = 1 + static_cast<int>(seed);
      check_system<BaseMotion::fixed>(seed, n, real);
      check_system<BaseMotion::prescribed>(seed + 100, n, real);
      check_system<BaseMotion::free>(seed + 200, n, real);
    }
}
