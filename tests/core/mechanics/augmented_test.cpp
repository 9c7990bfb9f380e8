// The recursion for hinges that are locked or carry an inertia, against a dense constrained solve.
#include "core/mechanics/augmented.hpp"
#include "tests/core/mechanics/constrained_wing.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

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
