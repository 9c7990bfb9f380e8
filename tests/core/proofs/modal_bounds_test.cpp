// The bounds by the modes of a latched wing: the tests search for motions that break them.
#include "tests/core/proofs/latched_wing.hpp"
#include "tests/support/dry_friction.hpp"
#include "tests/support/real_scenes.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

using namespace wingspread;
using oracle::Draws;
using oracle::Latched;
using oracle::with_latches;

namespace {

struct Shares {
  double moment = 0, force = 0;
  double base = 0; ///< of a free base: way and rate by the hinges
};

/// The bounds by the modes alone, with the energy's cap, and inside the energy's box.
enum class Kind { modes, capped, in_reach };

/// What T + Σ ½ κ u² does not exceed from this state on, J.
template <BaseMotion M> std::optional<double> energy_of(Latched<M>& wing, const State<double>& x) {
  if (const auto left = wing.remaining.energy(wing.system, x, 0.)) return left->elastic;
  if (M != BaseMotion::prescribed) return std::nullopt;
  const auto so_far = wing.remaining.energy_so_far(wing.system, x, 0.);
  return so_far ? wing.modes->most_energy(*so_far, wing.t_end) : std::nullopt;
}

/// Largest shares of the bounds that the motion from x takes, by Runge and Kutta's classical steps;
/// none where no bound was found.
template <BaseMotion M>
std::optional<Shares> shares_from(Latched<M>& wing, State<double> x, Kind kind, double h,
                                  int steps) {
  const Layout& at = wing.at;
  const HingeVector rates =
      wing.modes->rates(wing.modes->start(&x[at.angle(1)], &x[at.rate(1)], 0));
  if (!wing.model.is_tuned_for(rates) && !wing.tune(rates.data())) return std::nullopt;
  std::optional<double> energy;
  if (kind != Kind::modes) energy = energy_of(wing, x);
  double spin = 0;
  if (M == BaseMotion::free) spin = std::abs(total_motion(wing.system, x, 0.).spin());
  std::optional<HingeBounds> bounds;
  if (kind == Kind::in_reach && energy) bounds = wing.bound_in_reach(x, *energy, spin);
  if (!bounds) bounds = wing.bound(x, 0, energy, spin);
  if (!bounds) return std::nullopt;
  const HingeVector &moment = bounds->moment, &force = bounds->force;
  Shares worst;
  State<double> k1(at.size()), k2 = k1, k3 = k1, k4 = k1, y = x;
  double t = 0;
  const auto stage = [&](const State<double>& k, double part, State<double>& to) {
    for (int j = 0; j < at.size(); ++j) y[j] = x[j] + part * k[j];
    wing.system(y, to, t + part);
  };
  for (int step = 0; step < steps; ++step) {
    t = step * h;
    if (wing.model.quickening != 0 && t > wing.t_end) break;
    wing.bear(x);
    wing.system(x, k1, t);
    for (int i = 1; i <= at.bodies; ++i) {
      const Vec2<double>& f = wing.work.forces[i];
      worst.moment = std::max(worst.moment, std::abs(wing.system.moment(x, i)) / moment(i - 1));
      worst.force = std::max(worst.force, std::sqrt(dot(f, f)) / force(i - 1));
    }
    if (M == BaseMotion::free) {
      const double rate =
          wing.model.turns.row(0) * Eigen::Map<Eigen::VectorXd>(&x[at.rate(1)], at.bodies);
      const double way = std::abs(wing.modes->turn_of_base(&x[at.angle(1)]));
      worst.base =
          std::max({worst.base, way / bounds->base.way, std::abs(rate) / bounds->base.rate});
    }
    stage(k1, h / 2, k2), stage(k2, h / 2, k3), stage(k3, h, k4);
    for (int j = 0; j < at.size(); ++j) x[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
  }
  return worst;
}

struct Sought {
  Shares worst;
  int bounded = 0, tried = 0;
};

/// From random states of this size.
template <BaseMotion M>
void seek(Latched<M>& wing, Draws& draws, double size, int states, Sought& sought) {
  const double fast = wing.fastest(), slow = std::sqrt(fast);
  double h = 0.3 / fast;
  for (int i = 1; i <= wing.at.bodies; ++i) {
    const HingeTerms<double>& hinge = wing.wing.hinges[i];
    const double least = wing.wing.bodies[i].central_inertia;
    if (hinge.most_regularized() > 0)
      h = std::min(h, hinge.slip_rate * least / hinge.most_regularized());
  }
  for (int k = 0; k < states; ++k) {
    State<double> x = wing.rest();
    if (M == BaseMotion::free && draws.chance(0.5)) // the whole turns
      x[wing.at.freedoms() + 2] = draws.uniform(-1, 1) * draws.log_uniform(1e-4, 0.1) * slow;
    const double rates = draws.log_uniform(0.1 * slow, fast);
    for (int i = 1; i <= wing.at.bodies; ++i) {
      x[wing.at.angle(i)] += size * draws.uniform(-1, 1) * draws.log_uniform(1e-3, 1);
      x[wing.at.rate(i)] = size * rates * draws.uniform(-1, 1) * draws.log_uniform(1e-3, 1);
    }
    ++sought.tried;
    const Kind kind = k % 2 == 0 ? Kind::in_reach : k % 4 == 1 ? Kind::modes : Kind::capped;
    const std::optional<Shares> found = shares_from(wing, x, kind, h, 4000);
    if (!found) continue;
    ++sought.bounded;
    sought.worst.moment = std::max(sought.worst.moment, found->moment);
    sought.worst.force = std::max(sought.worst.force, found->force);
    sought.worst.base = std::max(sought.worst.base, found->base);
  }
}

/// The accelerations' slopes about rest are M_0⁻¹K and M_0⁻¹C.
template <BaseMotion M> void check_model(const Scene& scene) {
  Latched<M> wing(scene);
  REQUIRE(wing.has_model);
  const int n = wing.at.bodies;
  const State<double> rest = wing.rest();
  const Eigen::VectorXd forces = wing.model.mass * wing.accelerations(rest);
  CHECK(forces.cwiseAbs().maxCoeff() < 1e-9 * wing.model.stiffness.diagonal().maxCoeff());
  constexpr double d = 1e-6;
  for (int j = 1; j <= n; ++j)
    for (const bool by_rate : {false, true}) {
      const int k = by_rate ? wing.at.rate(j) : wing.at.angle(j);
      State<double> up = rest, down = rest;
      up[k] += d, down[k] -= d;
      const Eigen::VectorXd slope =
          wing.model.mass * (wing.accelerations(up) - wing.accelerations(down)) / (2 * d);
      const Eigen::MatrixXd& of = by_rate ? wing.model.damping : wing.model.stiffness;
      CAPTURE(j, by_rate);
      CHECK((slope + of.col(j - 1)).cwiseAbs().maxCoeff() <=
            1e-5 * of.cwiseAbs().maxCoeff() + 1e-6 * wing.model.stiffness.maxCoeff());
    }
}

} // namespace

TEST_CASE("the linear model about rest is that of the equations of motion") {
  oracle::RealFeatures features;
  features.backlash = features.air = features.stops = features.gravity = false;
  features.preloads = features.windows = false; // where the law changes there is no slope
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    oracle::RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 6);
    options.motion = BaseMotion::fixed;
    options.friction = false;
    Draws draws(seed);
    Scene scene = with_latches(oracle::random_scene(seed, options), draws);
    if (seed > 10) scene = oracle::with_real_hinges(scene, seed, features);
    for (Hinge& hinge : scene.hinges) {
      if (hinge.damper && hinge.damper->law == DamperLaw::power) hinge.damper.reset();
      hinge.friction.scale = 0;
    }
    for (Synchronisation& loop : scene.synchronisations)
      loop.table.reset(); // the way to rest is long
    CAPTURE(seed);
    check_model<BaseMotion::fixed>(scene);
    scene.base.motion = BaseMotion::free;
    scene.base.mass = draws.log_uniform(1, 100), scene.base.inertia = draws.log_uniform(1, 100);
    scene.base.rate = 0;
    check_model<BaseMotion::free>(scene);
  }
}

TEST_CASE("no motion breaks the bounds by modes: the seed wing") {
  Latched<BaseMotion::fixed> wing(oracle::seed_scene());
  REQUIRE(wing.has_model);
  Draws draws(1);
  for (const double size : {1e-5, 1e-4, 1e-3, 1e-2}) {
    Sought sought;
    seek(wing, draws, size, 40, sought);
    CAPTURE(size, sought.bounded, sought.worst.moment, sought.worst.force);
    CHECK(sought.worst.moment <= 1);
    CHECK(sought.worst.force <= 1);
    if (size > 1e-3) continue;
    CHECK(sought.bounded >= 39);
    CHECK(sought.worst.moment > 0.9);
    CHECK(sought.worst.force > 0.8);
  }
}

namespace {

template <BaseMotion M>
Sought seek_on_random_wings(int count, std::uint64_t seed, double turning, double quickening = 0) {
  Sought all;
  for (int k = 0; k < count; ++k) {
    Draws draws(seed + k);
    oracle::RandomScene options;
    options.bodies = 1 + k % 6;
    options.branching = k % 2 == 0;
    options.motion = M;
    options.friction = k % 4 == 0;
    options.mass_lower = 1, options.mass_upper = 30;
    Scene scene = with_latches(oracle::random_scene(600 + k, options), draws);
    scene.base.rate = M == BaseMotion::prescribed ? turning * draws.uniform(-1, 1) : 0;
    scene.base.angular_acceleration =
        quickening == 0 ? 0 : quickening * draws.log_uniform(1e-3, 1) * (k % 2 == 0 ? 1 : -1);
    for (Hinge& hinge : scene.hinges) hinge.friction.regularization_rate = 0.02;
    Latched<M> wing(scene, 20);
    if (!wing.has_model) continue;
    Sought sought;
    seek(wing, draws, draws.log_uniform(1e-6, 3e-2), 6, sought);
    CAPTURE(k, sought.worst.moment, sought.worst.force);
    CHECK(sought.worst.moment <= 1);
    CHECK(sought.worst.force <= 1);
    all.worst.moment = std::max(all.worst.moment, sought.worst.moment);
    CHECK(sought.worst.base <= 1);
    all.worst.force = std::max(all.worst.force, sought.worst.force);
    all.worst.base = std::max(all.worst.base, sought.worst.base);
    all.bounded += sought.bounded, all.tried += sought.tried;
  }
  return all;
}

/// Enough were bounded, and some bounds are sharp.
void check(const Sought& all, int least) {
  CAPTURE(all.bounded, all.tried, all.worst.moment, all.worst.force);
  CHECK(all.bounded >= least);
  CHECK(all.worst.moment > 0.95);
  CHECK(all.worst.force > 0.9);
}

} // namespace

TEST_CASE("no motion breaks the bounds by modes: random wings on fixed bases") {
  check(seek_on_random_wings<BaseMotion::fixed>(60, 10, 0), 200);
}
TEST_CASE("no motion breaks the bounds by modes: random wings that are pushed") {
  check(seek_on_random_wings<BaseMotion::prescribed>(60, 20, 0), 200);
}
TEST_CASE("no motion breaks the bounds by modes: random wings on bases that turn") {
  check(seek_on_random_wings<BaseMotion::prescribed>(60, 30, 0.3), 130);
}
TEST_CASE(
    "no motion breaks the bounds by modes: random wings on bases that turn faster and faster") {
  check(seek_on_random_wings<BaseMotion::prescribed>(60, 50, 0.1, 0.1), 100);
}
TEST_CASE("no motion breaks the bounds by modes: random wings on free bases") {
  const Sought all = seek_on_random_wings<BaseMotion::free>(60, 40, 0);
  check(all, 150);
  CHECK(all.worst.base > 0.8);
}

TEST_CASE("friction swings a wing that is hardly damped no further than its energy tells") {
  Scene scene = oracle::seed_scene();
  for (Hinge& hinge : scene.hinges) {
    hinge.friction.coulomb = 1, hinge.friction.regularization_rate = 0.02;
    hinge.latch->damping = 1e-4 * hinge.latch->stiffness; // about 1e-3 of critical
  }
  Latched<BaseMotion::fixed> wing(scene);
  REQUIRE(wing.has_model);
  Draws draws(5);
  Sought sought;
  seek(wing, draws, 1e-3, 20, sought);
  CHECK(sought.worst.moment <= 1);
  CHECK(sought.worst.force <= 1);
  State<double> x = wing.rest();
  for (int i = 1; i <= 3; ++i) x[wing.at.angle(i)] += 1e-3;
  const auto energy = energy_of(wing, x);
  REQUIRE(energy);
  const auto with = wing.bound_in_reach(x, *energy, 0), without = wing.bound(x, 0, std::nullopt, 0);
  REQUIRE(with);
  CAPTURE(with->moment, wing.model.stiffness);
  for (int i = 0; i < 3; ++i) {
    const double by_hinge =
        std::sqrt(2 * *energy * wing.model.stiffness(i, i)); // all of it in one hinge
    CHECK(with->moment(i) < 1.2 * by_hinge + 2);
    if (without) CHECK(with->moment(i) < 0.5 * without->moment(i));
  }
}

TEST_CASE("the energy caps the mode of one hinge where a motion without loss takes it") {
  Scene scene = oracle::seed_scene();
  scene.bodies.resize(1), scene.hinges.resize(1);
  Hinge& hinge = scene.hinges[0];
  hinge.spring = {}, hinge.harness = {};
  hinge.friction.coulomb = 1, hinge.friction.regularization_rate = 0.02;
  hinge.latch->damping = 1e-5 * hinge.latch->stiffness;
  Latched<BaseMotion::fixed> wing(scene);
  REQUIRE(wing.has_model);
  State<double> x = wing.rest();
  x[wing.at.angle(1)] += 0.01;
  const auto energy = energy_of(wing, x);
  REQUIRE(energy);
  const auto bounds = wing.bound(x, 0, energy, 0);
  REQUIRE(bounds);
  const double swing =
      0.01 * hinge.latch->stiffness; // friction alone could swing it to hundreds of times that
  CHECK(bounds->moment(0) >= swing);
  CHECK(bounds->moment(0) < 1.1 * (swing + hinge.friction.coulomb));
}

TEST_CASE("no motion breaks the bounds by modes: real hinges and loops") {
  Sought all;
  oracle::RealFeatures features;
  features.backlash = features.air = features.gravity = false;
  for (int k = 0; k < 60; ++k) {
    Draws draws(k + 100);
    oracle::RandomScene options;
    options.bodies = 2 + k % 4;
    options.motion = BaseMotion::fixed;
    options.friction = false;
    options.mass_lower = 1, options.mass_upper = 30;
    Scene scene = with_latches(oracle::random_scene(700 + k, options), draws);
    scene = oracle::with_real_hinges(scene, k, features);
    for (Hinge& hinge : scene.hinges) hinge.friction.regularization_rate = 0.02;
    Latched<BaseMotion::fixed> wing(scene);
    if (!wing.has_model) continue;
    Sought sought;
    seek(wing, draws, draws.log_uniform(1e-5, 3e-2), 6, sought);
    CAPTURE(k, sought.worst.moment, sought.worst.force);
    CHECK(sought.worst.moment <= 1);
    CHECK(sought.worst.force <= 1);
    all.bounded += sought.bounded, all.tried += sought.tried;
  }
  CAPTURE(all.bounded, all.tried);
  CHECK(all.bounded >= 80); // latches with dissipation damp little about rest
}

TEST_CASE("there is a model of forty bodies and none of more, on a fixed base and on a free one") {
  for (const int bodies : {most_modelled_bodies, most_modelled_bodies + 1}) {
    oracle::RandomScene options;
    options.bodies = bodies, options.motion = BaseMotion::fixed, options.friction = false;
    Draws draws(3);
    Scene scene = with_latches(oracle::random_scene(3, options), draws);
    for (Hinge& hinge : scene.hinges) hinge.spring = {}, hinge.harness = {};
    CHECK(Latched<BaseMotion::fixed>(scene).has_model == (bodies == most_modelled_bodies));
    scene.base.motion = BaseMotion::free, scene.base.mass = scene.base.inertia = 10;
    CHECK(Latched<BaseMotion::free>(scene).has_model == (bodies == most_modelled_bodies));
  }
}

TEST_CASE("there is no model by modes of backlash, of air, of a base whose accelerations change") {
  Scene scene = oracle::seed_scene();
  scene.hinges[0].latch->backlash = 1e-3;
  CHECK_FALSE(Latched<BaseMotion::fixed>(scene).has_model);
  scene = oracle::seed_scene();
  scene.bodies[0].plate = Plate{{-0.5, 0}, {0.5, 0}, 1, 1.2};
  scene.environment.air_density = 1.2;
  CHECK_FALSE(Latched<BaseMotion::fixed>(scene).has_model);
  scene = oracle::seed_scene();
  scene.base.motion = BaseMotion::prescribed;
  scene.base.rate = 0.1;
  CHECK(Latched<BaseMotion::prescribed>(scene).has_model);
  scene.base.angular_acceleration = 0.1;
  CHECK(Latched<BaseMotion::prescribed>(scene, 10).has_model);
  BaseTable::Columns ramp;
  ramp.time = {0, 1}, ramp.angular_acceleration = {0.1, 0.3};
  scene.base.table = std::make_shared<const BaseTable>(ramp, Interpolation::linear);
  CHECK_FALSE(Latched<BaseMotion::prescribed>(scene, 10).has_model);
}
