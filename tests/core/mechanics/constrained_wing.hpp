/// Wings whose hinges are locked or carry an inertia, by a dense constrained solve.
///
/// The reference uses the wing without locks and added inertias. Its hinge accelerations, hinge forces and base
/// acceleration are linear in the moments m across the hinges,
///
///     q̈ = A m + a0,    f = F m + f0                                                           (1)
///
/// and n + 1 dense solves (dense_wing.hpp) give A, a0, F, f0. Then for a hinge of added inertia E
/// that takes the moment τ, and for one that is locked,
///
///     m_i + E_i q̈_i = τ_i,        q̈_i = 0                                                     (2)
///
/// are n equations for m: the total moment across each hinge, with the friction that holds it.
#pragma once

#include "core/mechanics/system.hpp"
#include "tests/support/decompositions.hpp"
#include "tests/support/dense_wing.hpp"
#include "tests/support/random_scenes.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <algorithm>

namespace wingspread::oracle {

/// Which hinges are locked, and the added inertias and moments of the others, in Scene order.
struct Constraints {
  std::vector<double> added; ///< E, kg·m²
  std::vector<double> tau;   ///< N·m
  std::vector<bool> locked;
};

/// A third of the hinges locked, a third with inertias from far below to far above the bodies'.
inline Constraints random_constraints(std::uint64_t seed, int hinges) {
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
    hinge.damper.reset(), hinge.stop.reset();
  }
  scene.synchronisations.clear(); // their moments are told; gravity and air stay
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

// ---- the wing itself

/// A scene's wing in a given state, for any base motion.
template <BaseMotion M> struct Posed {
  Wing<double> wing;
  Workspace<double> work;
  System<double, Tree, M> system;
  State<double> x;

  Posed(const Scene& scene, const WingState<double>& state)
      : wing(made(scene, state)), system(wing, std::nullopt, work) {
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
    system.find_sides(x);
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

// ---- the two against each other

/// The largest deviation of a kind of quantity, relative to the largest value of that kind or to 1e-3, whichever is larger.
template <class Got, class Expected> double deviation(const Got& got, const Expected& expected) {
  const auto reference = expected.template cast<double>().eval();
  REQUIRE(got.allFinite()); // maxCoeff may ignore a NaN
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

inline RandomScene of(int bodies, bool branching) {
  RandomScene options;
  options.bodies = bodies, options.branching = branching;
  return options;
}

} // namespace wingspread::oracle
