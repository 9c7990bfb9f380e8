// The recursion while hinges are locked, against a dense constrained solve.
#include "core/mechanics/energy.hpp"
#include "tests/core/mechanics/constrained_wing.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The passes of locked.hpp one by one, with the bodies' rates.
template <BaseMotion M>
Motions<double> recursive(const Scene& scene, const WingState<double>& state,
                          const Constraints& constraints) {
  Posed<M> at(scene, state);
  const Tree& tree = at.wing.tree;
  const int n = tree.bodies();
  at.system.place_all(at.x, 0.0);
  auto& frames = at.work.frames;
  std::vector<Crossing<double>> crossings(n + 1);
  const auto is_locked = [&](int i) { return bool(constraints.locked[at.wing.hinge_of[i]]); };
  for (int i = n; i >= 1; --i) {
    frames[i].moment = constraints.tau[at.wing.hinge_of[i]];
    gather_with_locks(at.wing, tree, frames, crossings, i, is_locked(i));
  }
  if (M == BaseMotion::free) {
    gather_with_locks(at.wing, tree, frames, crossings, 0, false);
    accelerate_free_base(frames[0]);
  }
  Motions<double> result{Vector<double>(n), Columns2<double>(2, n), {}, Vector<double>(n)};
  result.base << frames[0].acceleration.x, frames[0].acceleration.y, frames[0].angular_acceleration;
  for (int i = 1; i <= n; ++i) {
    const int hinge = at.wing.hinge_of[i];
    result.hinges(hinge) = accelerate_with_locks<M, double>(tree, frames, i, is_locked(i));
    const double parents = frames[tree.parent_of(i)].angular_acceleration;
    const Vec2<double> force = hinge_force(frames[i], crossings[i], parents);
    result.forces.col(hinge) << force.x, force.y;
    result.moments(hinge) = axis_moment(frames[i], crossings[i], parents);
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

TEST_CASE("locked hinges agree with a dense constrained solve") {
  // 1-30 bodies, all base motions, masses over three decades, inertias over twelve
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const int n = 1 + static_cast<int>(seed % 30);
    const Scene scene = random_scene(seed, of(n, seed % 2 == 0));
    const auto state = random_state(seed + 1000, scene);
    Constraints constraints = random_constraints(seed + 2000, n);
    constraints.added.assign(n, 0);
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

namespace {

/// An evaluation of the system with these hinges locked, and the passes of locked.hpp at all bodies.
template <BaseMotion M> void require_same_bits(const Scene& scene, std::uint64_t seed) {
  Posed<M> at(scene, random_state(seed + 1000, scene)),
      by_passes(scene, random_state(seed + 1000, scene));
  const Layout& layout = at.system.layout();
  const int n = layout.bodies;
  const Constraints constraints = random_constraints(seed, n);
  for (int i = 1; i <= n; ++i)
    if (constraints.locked[at.wing.hinge_of[i]]) at.system.set_contact(i, Contact::stuck);
  if (at.work.locked == 0) return;
  State<double> dxdt(at.x.size());
  at.system(at.x, dxdt, 0.0);

  by_passes.system.place_all(by_passes.x, 0.0);
  auto& frames = by_passes.work.frames;
  const Tree& tree = at.wing.tree;
  std::vector<Crossing<double>> crossings(n + 1);
  for (int i = n; i >= 1; --i) {
    frames[i].moment = at.work.frames[i].moment;
    gather_with_locks(at.wing, tree, frames, crossings, i, at.system.is_locked(i));
  }
  if (M == BaseMotion::free) {
    gather_with_locks(at.wing, tree, frames, crossings, 0, false);
    accelerate_free_base(frames[0]);
  }
  for (int i = 1; i <= n; ++i) {
    const double relative =
        accelerate_with_locks<M, double>(tree, frames, i, at.system.is_locked(i));
    CHECK(dxdt[layout.rate(i)] == relative);
    const double parents = frames[tree.parent_of(i)].angular_acceleration;
    CHECK(at.work.holding[i] == axis_moment(frames[i], crossings[i], parents));
  }
}

} // namespace

namespace {

/// Compares an evaluation of the system, some of whose hinges are locked, with the dense constrained solve.
/// @return how many are locked
template <BaseMotion M> int compare_evaluation(const Scene& scene, std::uint64_t seed) {
  const auto state = random_state(seed + 1000, scene);
  Posed<M> at(scene, state);
  const Layout& layout = at.system.layout();
  Constraints constraints = random_constraints(seed, layout.bodies);
  std::fill(constraints.added.begin(), constraints.added.end(), 0);
  for (int i = 1; i <= layout.bodies; ++i)
    if (constraints.locked[at.wing.hinge_of[i]])
      at.system.set_contact(i, i % 2 == 0 ? Contact::stuck : Contact::held);
  if (at.work.locked == 0) return 0;
  State<double> dxdt(at.x.size());
  at.system(at.x, dxdt, 0.0);
  for (int i = 1; i <= layout.bodies; ++i)
    if (!at.system.is_locked(i)) constraints.tau[at.wing.hinge_of[i]] = at.system.moment(at.x, i);
  const Motions<long double> expected = dense<long double>(scene, state, constraints);
  const double size = static_cast<double>(expected.moments.cwiseAbs().maxCoeff());
  for (int i = 1; i <= layout.bodies; ++i) {
    const int hinge = at.wing.hinge_of[i];
    CAPTURE(seed, i);
    CHECK(dxdt[layout.rate(i)] ==
          Approx(static_cast<double>(expected.hinges(hinge))).epsilon(1e-8).margin(1e-8));
    if (at.system.is_locked(i))
      CHECK(at.work.holding[i] ==
            Approx(static_cast<double>(expected.moments(hinge))).margin(1e-9 * size));
  }
  return at.work.locked;
}

} // namespace

TEST_CASE("what locks hinges in the air and under gravity agrees with a dense constrained solve") {
  int locked = 0;
  for (std::uint64_t seed = 1; seed <= 90; ++seed) {
    RandomScene options = of(1 + static_cast<int>(seed % 6), seed % 2 == 0);
    // a fixed base under gravity is one that is driven upwards
    options.motion = seed % 3 == 0 ? BaseMotion::free : BaseMotion::prescribed;
    RealFeatures features{.tables = false, .measured = false, .scales = false};
    features.dampers = features.windows = features.stops = features.backlash = false;
    features.loops = features.preloads = features.dissipation = false;
    const Scene scene = with_real_hinges(random_scene(seed, options), seed, features);
    locked += scene.base.motion == BaseMotion::free
                  ? compare_evaluation<BaseMotion::free>(scene, seed)
                  : compare_evaluation<BaseMotion::prescribed>(scene, seed);
  }
  CHECK(locked > 50);
}

TEST_CASE("an evaluation with locks spares free hinges the locks' terms, with the same bits") {
  for (std::uint64_t seed = 0; seed < 90; ++seed) {
    const Scene scene = random_scene(seed, of(2 + static_cast<int>(seed % 11), true));
    CAPTURE(seed);
    switch (scene.base.motion) {
    case BaseMotion::prescribed:
      require_same_bits<BaseMotion::prescribed>(scene, seed);
      break;
    case BaseMotion::free:
      require_same_bits<BaseMotion::free>(scene, seed);
      break;
    case BaseMotion::fixed:
      require_same_bits<BaseMotion::fixed>(scene, seed);
    }
  }
}

TEST_CASE("the end of a step gets the conserved momenta, and the derivative there, with and "
          "without locks") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Scene scene = random_scene(seed, of(1 + static_cast<int>(seed % 8), true));
    if (scene.base.motion != BaseMotion::free) continue;
    Posed<BaseMotion::free> at(scene, random_state(seed + 1000, scene));
    if (seed % 2 == 0) at.system.set_contact(1, Contact::stuck);
    at.work.keeps_momenta = true;
    at.work.conserved = conserved(at.system, at.x, 0.0);
    const State<double> before = at.x;
    const int v = at.system.layout().freedoms();
    at.x[0] += 0.1, at.x[v + 1] -= 0.02, at.x[v + 2] += 0.3; // off the invariants
    State<double> dxdt(at.x.size()), anew(at.x.size());
    at.system.end_step(at.x, dxdt, 0.0);
    CAPTURE(seed);
    for (const int k : {0, 1, v, v + 1, v + 2})
      CHECK(at.x[k] == Approx(before[k]).epsilon(1e-9).margin(1e-9));
    for (int i = 1; i <= at.system.layout().bodies; ++i)
      CHECK(at.x[at.system.layout().rate(i)] == before[at.system.layout().rate(i)]);
    at.system(at.x, anew, 0.0);
    CHECK(dxdt == anew);
  }
}

TEST_CASE("the common centre of mass of a free wing is put where it falls under gravity") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Scene scene = random_scene(seed, of(1 + static_cast<int>(seed % 6), true));
    if (scene.base.motion != BaseMotion::free) continue;
    scene.environment = Environment{{0.3, -9.81}, 0};
    Posed<BaseMotion::free> at(scene, random_state(seed + 500, scene));
    at.work.keeps_momenta = true;
    at.work.conserved = conserved(at.system, at.x, 0.0);
    const State<double> before = at.x;
    const Vec2<double> drift = at.work.conserved.velocity;
    const int v = at.system.layout().freedoms();
    const double t = 0.7;
    State<double> dxdt(at.x.size());
    at.x[0] -= 0.2, at.x[1] += 0.3, at.x[v] += 0.1; // off
    at.system.end_step(at.x, dxdt, t);
    CAPTURE(seed); // in the same pose: all has moved and sped up as its centre of mass
    CHECK(at.x[0] == Approx(before[0] + drift.x * t + 0.5 * 0.3 * t * t).epsilon(1e-9));
    CHECK(at.x[1] == Approx(before[1] + drift.y * t - 0.5 * 9.81 * t * t).epsilon(1e-9));
    CHECK(at.x[v] == Approx(before[v] + 0.3 * t).epsilon(1e-9));
    CHECK(at.x[v + 1] == Approx(before[v + 1] - 9.81 * t).epsilon(1e-9));
  }
}
