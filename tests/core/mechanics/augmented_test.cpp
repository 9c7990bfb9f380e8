// The recursion for hinges that are locked or carry an inertia, against a dense constrained solve.
//
// The reference knows the wing without either: hinge accelerations, hinge forces and the base's
// acceleration answer the moments m across the hinges linearly,
//
//     q̈ = A m + a0,    f = F m + f0                                                           (1)
//
// and n + 1 dense solves (dense_wing.hpp) give A, a0, F, f0. Then for a hinge of added inertia E
// that takes the moment τ, and for one that is locked,
//
//     m_i + E_i q̈_i = τ_i,        q̈_i = 0                                                     (2)
//
// are n equations for m: what crosses each hinge, friction that holds it included.
#include "core/mechanics/augmented.hpp"
#include "core/mechanics/linear_solve.hpp"
#include "tests/support/dense_wing.hpp"
#include "tests/support/random_scenes.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <algorithm>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// What is asked of each hinge, in Scene order.
struct Constraints {
  std::vector<double> added; ///< E, kg·m²
  std::vector<double> tau;   ///< N·m
  std::vector<bool> locked;
};

/// A third of the hinges locked, a third with inertias from far below to far above the bodies'.
Constraints random_constraints(std::uint64_t seed, int hinges) {
  Draws draws(seed);
  Constraints constraints;
  for (int i = 0; i < hinges; ++i) {
    const int kind = draws.below(3);
    const double inertia = draws.log_uniform(1e-6, 1e6);
    constraints.locked.push_back(kind == 0);
    constraints.added.push_back(kind == 1 ? inertia : 0);
    constraints.tau.push_back(draws.uniform(-5, 5));
  }
  return constraints;
}

/// Accelerations of the hinges and forces in them, Scene order, the base's and the axis moments.
template <class T> struct Motions {
  Vector<T> hinges;
  Columns2<T> forces;
  Eigen::Matrix<T, 3, 1> base;
  Vector<T> moments;
};

// ---- the reference, (1) and (2)

template <class T>
Motions<T> under_moments(Scene scene, const WingState<double>& state,
                         const std::vector<double>& moments) {
  for (std::size_t i = 0; i < scene.hinges.size(); ++i) {
    Hinge& hinge = scene.hinges[i];
    const double drive = hinge.latched > hinge.stowed ? moments[i] : -moments[i];
    hinge.spring = {drive, drive};
    hinge.harness = {}, hinge.friction = {}, hinge.latch.reset();
  }
  WingState<T> open = state.cast<T>();
  open.engagement.setZero();
  const WingResponse<T> response = DenseWing<T>(scene).respond(open);
  Motions<T> result{response.hinge_accelerations, response.forces, {}, {}};
  result.base << response.base_acceleration, response.base_angular_acceleration;
  return result;
}

template <class T>
Motions<T> dense(const Scene& scene, const WingState<double>& state,
                 const Constraints& constraints) {
  const int n = static_cast<int>(scene.hinges.size());
  const Motions<T> none = under_moments<T>(scene, state, std::vector<double>(n, 0));
  std::vector<Motions<T>> unit;
  Matrix<T> A(n, n);
  for (int j = 0; j < n; ++j) {
    std::vector<double> moments(n, 0);
    moments[j] = 1;
    unit.push_back(under_moments<T>(scene, state, moments));
    A.col(j) = unit[j].hinges - none.hinges;
  }
  Matrix<T> equations = Matrix<T>::Identity(n, n);
  Vector<T> right(n);
  for (int i = 0; i < n; ++i) {
    const T added(constraints.added[i]);
    if (constraints.locked[i])
      equations.row(i) = A.row(i), right(i) = -none.hinges(i);
    else
      equations.row(i) += added * A.row(i),
          right(i) = T(constraints.tau[i]) - added * none.hinges(i);
  }
  Motions<T> result = none;
  result.moments = equations.partialPivLu().solve(right);
  for (int j = 0; j < n; ++j) {
    const T& m = result.moments(j);
    result.hinges += m * (unit[j].hinges - none.hinges);
    result.forces += m * (unit[j].forces - none.forces);
    result.base += m * (unit[j].base - none.base);
  }
  return result;
}

// ---- the recursion

/// A scene's wing in a given state, for any base motion.
template <BaseMotion M> struct Posed {
  Wing<double> wing;
  Workspace<double> work;
  System<double, Tree, M> system;
  State<double> x;

  Posed(const Scene& scene, const WingState<double>& state)
      : wing(made(scene, state)), system(wing, wing.tree, std::nullopt, work) {
    const Layout& at = system.layout();
    system.start(x);
    if (M == BaseMotion::free) {
      const int v = at.freedoms();
      x[2] = state.base_angle, x[v + 2] = state.base_rate;
      for (int k : {0, 1}) x[k] = state.base_position(k), x[v + k] = state.base_velocity(k);
    }
    for (int i = 1; i <= at.bodies; ++i) {
      x[at.angle(i)] = state.angles[wing.hinge_of[i]];
      x[at.rate(i)] = state.rates[wing.hinge_of[i]];
    }
  }

private:
  /// A prescribed base stands at t = 0 where the state has it.
  static Wing<double> made(Scene scene, const WingState<double>& state) {
    if (M == BaseMotion::prescribed)
      scene.base.angle = state.base_angle, scene.base.rate = state.base_rate;
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    return wing;
  }
};

/// The passes of augmented.hpp one by one, with the bodies' rates.
template <BaseMotion M>
Motions<double> recursive(const Scene& scene, const WingState<double>& state,
                          const Constraints& constraints) {
  Posed<M> at(scene, state);
  const Tree& tree = at.wing.tree;
  const int n = tree.bodies();
  at.system.place_all(at.x, 0.0);
  auto& frames = at.work.frames;
  Augmented<double> parts;
  parts.resize(n);
  auto& bodies = parts.bodies;
  for (int i = n; i >= 1; --i) {
    const int hinge = at.wing.hinge_of[i];
    factorize(at.wing, tree, frames, bodies, i,
              {constraints.added[hinge], bool(constraints.locked[hinge])});
    load<true>(tree, frames, bodies, i, constraints.tau[hinge]);
  }
  bodies[0].acceleration = frames[0].acceleration;
  bodies[0].angular_acceleration = frames[0].angular_acceleration;
  if (M == BaseMotion::free) {
    factorize(at.wing, tree, frames, bodies, 0, HingeConstraint<double>{});
    load<true>(tree, frames, bodies, 0, 0.0);
    accelerate_free_base(bodies[0]);
  }
  Motions<double> result{Vector<double>(n), Columns2<double>(2, n), {}, Vector<double>(n)};
  result.base << bodies[0].acceleration.x, bodies[0].acceleration.y, bodies[0].angular_acceleration;
  for (int i = 1; i <= n; ++i) {
    const int hinge = at.wing.hinge_of[i];
    result.hinges(hinge) = accelerate_augmented<true>(tree, frames, bodies, i);
    const double parents = bodies[tree.parent_of(i)].angular_acceleration;
    const Vec2<double> force = augmented_force(bodies[i], parents);
    result.forces.col(hinge) << force.x, force.y;
    result.moments(hinge) = axis_moment(bodies[i], parents);
  }
  return result;
}

Motions<double> recursive(const Scene& scene, const WingState<double>& state,
                          const Constraints& constraints) {
  switch (scene.base.motion) {
  case BaseMotion::prescribed:
    return recursive<BaseMotion::prescribed>(scene, state, constraints);
  case BaseMotion::free:
    return recursive<BaseMotion::free>(scene, state, constraints);
  case BaseMotion::fixed:
    break;
  }
  return recursive<BaseMotion::fixed>(scene, state, constraints);
}

// ---- the two against each other

/// Largest deviation of a kind, relative to the largest of that kind; to 1e-3 of the usual where
/// all of it is next to nothing.
template <class Got, class Expected> double deviation(const Got& got, const Expected& expected) {
  const auto reference = expected.template cast<double>().eval();
  REQUIRE(got.allFinite()); // a NaN would pass over
  return (got - reference).cwiseAbs().maxCoeff() / std::max(reference.cwiseAbs().maxCoeff(), 1e-3);
}

template <class T>
void compare(const Motions<double>& got, const Motions<T>& expected, const Constraints& constraints,
             double tolerance) {
  CHECK(deviation(got.hinges, expected.hinges) < tolerance);
  CHECK(deviation(got.forces, expected.forces) < tolerance);
  CHECK(deviation(got.base, expected.base) < tolerance);
  CHECK(deviation(got.moments, expected.moments) < tolerance);
  for (std::size_t i = 0; i < constraints.locked.size(); ++i)
    if (constraints.locked[i]) CHECK(got.hinges(i) == 0);
}

RandomScene of(int bodies, bool branching) {
  RandomScene options;
  options.bodies = bodies, options.branching = branching;
  return options;
}

} // namespace

TEST_CASE("locked hinges and added inertias agree with a dense constrained solve") {
  // 1-30 bodies, all base motions, masses over three decades, inertias over twelve
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const int n = 1 + static_cast<int>(seed % 30);
    const Scene scene = random_scene(seed, of(n, seed % 2 == 0));
    const auto state = random_state(seed + 1000, scene);
    const Constraints constraints = random_constraints(seed + 2000, n);
    const Motions<double> got = recursive(scene, state, constraints);
    CAPTURE(seed, n, static_cast<int>(scene.base.motion));
    // quad costs too much for long wings
    if (n <= 6)
      compare(got, dense<Quad>(scene, state, constraints), constraints, 1e-12);
    else
      compare(got, dense<long double>(scene, state, constraints), constraints, 1e-12);
  }
}

TEST_CASE("a wing whose hinges are all locked moves as one body, or not at all") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const int n = 1 + static_cast<int>(seed % 12);
    const Scene scene = random_scene(seed, of(n, true));
    WingState<double> state = random_state(seed + 1000, scene);
    Constraints constraints = random_constraints(seed, n);
    constraints.locked.assign(n, true);
    const Motions<double> got = recursive(scene, state, constraints);
    CAPTURE(seed, n);
    compare(got, dense<long double>(scene, state, constraints), constraints, 1e-12);
    if (scene.base.motion == BaseMotion::fixed) {
      state.rates.setZero(); // at rest nothing holds it but the reactions to nothing
      const Motions<double> rest = recursive(scene, state, constraints);
      CHECK(rest.forces.isZero());
      CHECK(rest.moments.isZero());
    }
  }
}

TEST_CASE("an inertia as large as all the wing's and more locks the hinge") {
  const Scene scene = random_scene(3, of(8, true));
  const auto state = random_state(4, scene);
  Constraints heavy = random_constraints(5, 8), locked = heavy;
  for (int i = 0; i < 8; ++i)
    if (locked.locked[i]) heavy.locked[i] = false, heavy.added[i] = 1e12;
  const Motions<double> got = recursive(scene, state, heavy),
                        limit = recursive(scene, state, locked);
  CHECK(deviation(got.hinges, limit.hinges) < 1e-8);
  CHECK(deviation(got.forces, limit.forces) < 1e-8);
}

namespace {

/// A random wing without friction, whose root sticks and others may.
template <BaseMotion M> struct Sticking {
  RandomScene options;
  Scene scene;
  WingState<double> state;
  Constraints constraints;
  Posed<M> at;

  Sticking(std::uint64_t seed, int n)
      : options(made(n)), scene(random_scene(seed, options)),
        state(random_state(seed + 1000, scene)), constraints(random_constraints(seed + 2000, n)),
        at(scene, state) {
    constraints.locked[at.wing.hinge_of[1]] = true;
    for (int i = 1; i <= n; ++i)
      if (constraints.locked[at.wing.hinge_of[i]]) at.system.touch(i, Contact::stuck);
  }

private:
  static RandomScene made(int n) {
    RandomScene options = of(n, true);
    options.motion = M, options.friction = false;
    return options;
  }
};

/// The right-hand side with hinges that stick.
template <BaseMotion M> void check_right_hand_side(std::uint64_t seed, int n) {
  Sticking<M> wing(seed, n);
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
      CHECK(system.holding_friction(x, i) == got.moments(hinge) - wing.constraints.tau[hinge]);
  }
  CAPTURE(seed, n);
  compare(got, expected, wing.constraints, 1e-12);
}

/// (M + E) q̈ = τ: a wing at rest, on a base that nothing drives.
template <BaseMotion M> void check_linear_solve(std::uint64_t seed, int n) {
  Sticking<M> wing(seed, n);
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

template <BaseMotion M> void check_system(std::uint64_t seed, int n) {
  CAPTURE(static_cast<int>(M));
  check_right_hand_side<M>(seed, n);
  check_linear_solve<M>(seed, n);
}

} // namespace

TEST_CASE("a system with hinges that stick, and its linear solves, agree with the dense solve") {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const int n = 1 + static_cast<int>(seed);
    check_system<BaseMotion::fixed>(seed, n);
    check_system<BaseMotion::prescribed>(seed + 100, n);
    check_system<BaseMotion::free>(seed + 200, n);
  }
}
