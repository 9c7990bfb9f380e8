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
};

/// Largest shares of the bounds that the motion from x takes, by Runge and Kutta's classical steps;
/// none where no bound was found.
template <BaseMotion M>
std::optional<Shares> shares_from(Latched<M>& wing, State<double> x, bool by_energy, double h,
                                  int steps) {
  const Layout& at = wing.at;
  const HingeVector rates =
      wing.modes->rates(wing.modes->start(&x[at.angle(1)], &x[at.rate(1)], 0));
  if (!wing.model.is_tuned_for(rates) && !wing.tune(rates.data())) return std::nullopt;
  std::optional<double> energy;
  if (by_energy) energy = wing.remaining.energy(wing.system, x, 0., 0.);
  double spin = 0;
  if (M == BaseMotion::free) spin = std::abs(total_motion(wing.system, x, 0.).spin());
  const std::optional<HingeBounds> bounds = wing.bound(x, 0, energy, spin);
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
    wing.bear(x);
    wing.system(x, k1, t);
    for (int i = 1; i <= at.bodies; ++i) {
      const Vec2<double>& f = wing.work.forces[i];
      worst.moment = std::max(worst.moment, std::abs(wing.system.moment(x, i)) / moment(i - 1));
      worst.force = std::max(worst.force, std::sqrt(dot(f, f)) / force(i - 1));
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
    const std::optional<Shares> found = shares_from(wing, x, k % 2 == 0, h, 4000);
    if (!found) continue;
    ++sought.bounded;
    sought.worst.moment = std::max(sought.worst.moment, found->moment);
    sought.worst.force = std::max(sought.worst.force, found->force);
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

template <BaseMotion M> Sought seek_on_random_wings(int count, std::uint64_t seed, double turning) {
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
    scene.base.angular_acceleration = 0;
    for (Hinge& hinge : scene.hinges) hinge.friction.regularization_rate = 0.02;
    Latched<M> wing(scene);
    if (!wing.has_model) continue;
    Sought sought;
    seek(wing, draws, draws.log_uniform(1e-6, 3e-2), 6, sought);
    CAPTURE(k, sought.worst.moment, sought.worst.force);
    CHECK(sought.worst.moment <= 1);
    CHECK(sought.worst.force <= 1);
    all.worst.moment = std::max(all.worst.moment, sought.worst.moment);
    all.worst.force = std::max(all.worst.force, sought.worst.force);
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
TEST_CASE("no motion breaks the bounds by modes: random wings on free bases") {
  check(seek_on_random_wings<BaseMotion::free>(60, 40, 0), 150);
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

TEST_CASE("there is no model by modes of backlash, of air, of a base that turns faster") {
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
  CHECK_FALSE(Latched<BaseMotion::prescribed>(scene).has_model);
}

namespace {

/// The largest part that moments and rotation from random states take of what (3), (4) and the remainders leave them.
/// Only some hinges are off rest and in motion, so that few terms of a bound stand alone.
template <BaseMotion M> double most_left_out(Latched<M>& wing, Draws& draws, int states) {
  const Layout& at = wing.at;
  const int n = at.bodies;
  const RestModel& m = wing.model;
  double most = 0;
  for (int k = 0; k < states; ++k) {
    const double size = draws.log_uniform(1e-3, 1);
    State<double> x = wing.rest(), dxdt(at.size());
    for (int i = 1; i <= n; ++i) {
      if (draws.chance(0.4)) x[at.angle(i)] += size * draws.uniform(-1, 1);
      if (draws.chance(0.4)) x[at.rate(i)] = draws.uniform(-1, 1);
    }
    if (M == BaseMotion::free && draws.chance(0.3)) x[at.freedoms() + 2] = draws.uniform(-1, 1);
    wing.system(x, dxdt, 0);
    Eigen::VectorXd u(n), v(n), a(n);
    BodyVector rates = BodyVector::Zero(n + 1), accelerations = rates;
    if (M == BaseMotion::free)
      rates(0) = x[at.freedoms() + 2], accelerations(0) = dxdt[at.freedoms() + 2];
    if (M == BaseMotion::prescribed) rates(0) = m.turn_rate;
    for (int i = 1; i <= n; ++i) {
      u(i - 1) = x[at.angle(i)] - m.angles(i - 1), v(i - 1) = x[at.rate(i)],
            a(i - 1) = dxdt[at.rate(i)];
      rates(i) = rates(m.parents[i - 1]) + v(i - 1);
      accelerations(i) = accelerations(m.parents[i - 1]) + a(i - 1);
    }
    const Eigen::VectorXd left = m.mass * a + m.stiffness * u + m.damping * v;
    const auto off = m.bound_turns(u.cwiseAbs(), accelerations.cwiseAbs(), rates.cwiseAbs());
    const Eigen::VectorXd bound = m.turns.cwiseAbs().transpose() * off.moments +
                                  m.bound_remainders(u.cwiseAbs(), v.cwiseAbs());
    const Eigen::VectorXd terms = m.mass.cwiseAbs() * a.cwiseAbs() +
                                  m.stiffness.cwiseAbs() * u.cwiseAbs() +
                                  m.damping.cwiseAbs() * v.cwiseAbs();
    const double rounding = 1e-12 * (m.stiffness.maxCoeff() + terms.maxCoeff());
    for (int i = 0; i < n; ++i) most = std::max(most, std::abs(left(i)) / (bound(i) + rounding));
    if (M != BaseMotion::free) continue;
    const double spin = std::abs(total_motion(wing.system, x, 0.).spin());
    const double rigid = std::abs(rates(0) - m.turns.row(0) * v);
    most = std::max(most, (rigid - 1e-12) / (m.rigid * (spin + off.momentum)));
  }
  return most;
}

/// The same over random trees; with loops whose tables fall if `loops`.
template <BaseMotion M> double most_left_out(std::uint64_t seed, bool loops, double turning = 0) {
  double most = 0;
  for (int k = 0; k < 60; ++k) {
    Draws draws(seed + k);
    oracle::RandomScene options;
    options.bodies = 2 + k % 4, options.motion = M, options.friction = false;
    options.mass_lower = 1, options.mass_upper = 30;
    Scene scene = with_latches(oracle::random_scene(seed + k, options), draws);
    scene.base.acceleration = {0, 0}, scene.base.angular_acceleration = 0;
    scene.base.rate = turning * draws.uniform(-1, 1);
    for (Hinge& hinge : scene.hinges)
      hinge.spring = {}, hinge.harness = {}; // at rest without a moment
    if (loops) {
      Synchronisation loop;
      loop.name = "loop", loop.first = 0, loop.second = 1;
      loop.stiffness = draws.log_uniform(1e2, 1e4), loop.damping = draws.log_uniform(1, 1e2);
      const double end = std::abs(scene.hinges[0].latched - scene.hinges[0].stowed), top = end / 2,
                   to = std::abs(scene.hinges[1].latched - scene.hinges[1].stowed);
      if (k % 2 == 0)
        oracle::tabulate(loop, {0, top, 2 * end},
                         {0, to + draws.uniform(1, 4) * end, to - draws.uniform(0, 9) * end});
      else // falls everywhere, and is at rest where both hinges latch
        oracle::tabulate(
            loop, {0, end, 2 * end},
            {to + draws.log_uniform(0.1, 8) * end, to, to - draws.log_uniform(0.1, 8) * end});
      if (draws.chance(0.5)) loop.preload = draws.log_uniform(1, 1e3);
      scene.synchronisations.push_back(loop);
    }
    Latched<M> wing(scene);
    CAPTURE(k);
    REQUIRE(wing.model.size() == options.bodies);
    const double own = most_left_out(wing, draws, 40);
    CHECK(own <= 1 + 1e-6);
    most = std::max(most, own);
  }
  return most;
}

} // namespace

TEST_CASE(
    "what the linear model leaves out stays inside its bounds, on trees and with falling loops") {
  CHECK(most_left_out<BaseMotion::fixed>(5000, false) > 0.99);
  CHECK(most_left_out<BaseMotion::free>(5100, false) > 0.9);
  CHECK(most_left_out<BaseMotion::prescribed>(5200, false, 1) > 0.9);
  CHECK(most_left_out<BaseMotion::fixed>(5300, true) > 0.5);
  CHECK(most_left_out<BaseMotion::free>(5400, true) > 0.5);
}

TEST_CASE("a damper with a window damps a rest inside, on whichever side the hinge is now") {
  Scene scene = oracle::latching_panel(); // from 90 deg to 0; its spring holds it at −2/1e4 rad
  Hinge& hinge = scene.hinges[0];
  hinge.damper.emplace().coefficient = 7; // viscous
  const double rest = -2e-4;
  struct Window {
    double low, high;
    bool acts;
  };
  for (const auto& [low, high, acts] : {Window{0, 1, false},
                                        {-1, 0, true},
                                        {rest - 1e-5, 1, true},
                                        {rest + 1e-5, 1, false},
                                        {-1, rest - 1e-5, false},
                                        {-1, rest + 1e-5, true},
                                        {rest, 1, false},
                                        {-1, rest, false}}) {
    hinge.damper->window = {high, low};
    Latched<BaseMotion::fixed> wing(scene);
    for (const bool above_low : {false, true})
      for (const bool above_high : {false, true}) {
        wing.system.note_crossing(1, Edge::window_low, above_low);
        wing.system.note_crossing(1, Edge::window_high, above_high);
        CAPTURE(low, high, above_low, above_high);
        REQUIRE(wing.tune(&wing.still[wing.at.rate(1)]));
        CHECK(wing.model.angles(0) == Approx(rest));
        CHECK(wing.model.damping(0, 0) ==
              hinge.latch->damping + hinge.friction.viscous + (acts ? 7 : 0));
        CHECK(wing.model.room(0) <= std::min(std::abs(rest - low), std::abs(rest - high)) + 1e-12);
      }
  }
}
