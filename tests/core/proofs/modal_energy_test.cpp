// The bounds inside the energy's box, where friction leaves nothing else: against (7) and (10) by other means. They neither
// fall below nor rise above what the energy allows.
#include "tests/core/proofs/latched_wing.hpp"
#include "tests/support/decompositions.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace wingspread;
using oracle::Latched;

namespace {

/// What an energy allows a wing, by the symbols of modal_bounds.hpp.
struct Allowed {
  double size = 0, mu = 0; ///< √(2E'/(1 − μ)); μ
  double drift = 0;        ///< of the rigid turning by (4), rad/s
};

/// By the pairs of the model, with eigenvalues in place of Collatz's ratios.
template <BaseMotion M> struct EnergyOracle {
  explicit EnergyOracle(const Latched<M>& wing)
      : model(wing.model), n(wing.model.size()),
        kappa(Eigen::Map<const Eigen::VectorXd>(wing.remaining.least_stiffness(), n)),
        apart(Eigen::Map<const Eigen::VectorXd>(&wing.remaining.rest()[wing.at.angle(1)], n) -
              wing.model.angles),
        inverse(wing.model.mass.inverse()),
        answers(((model.turns * inverse * model.turns.transpose()).array() + model.rigid)
                    .abs()
                    .matrix()) {}

  /// The hinges between two bodies share the energy.
  [[nodiscard]] double turn(double energy, int k, int l) const {
    double soft = 0, way = 0;
    for (; k != l; (k > l ? k : l) = model.parents[std::max(k, l) - 1]) {
      const int i = std::max(k, l) - 1;
      soft += 1 / kappa(i), way += std::abs(apart(i));
    }
    return std::sqrt(2 * energy * soft) + way;
  }

  /// Bounds |M − M(rest)| of the bodies.
  [[nodiscard]] Eigen::MatrixXd changes(double energy) const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n + 1, n + 1);
    for (const RestModel::Pair& pair : model.pairs) {
      const double way = turn(energy, pair.first, pair.second);
      const double change = 0.5 * pair.cosine * way * way + pair.sine * way;
      all(pair.first, pair.second) += change, all(pair.second, pair.first) += change;
    }
    if (M != BaseMotion::free) all.row(0).setZero(), all.col(0).setZero();
    return all;
  }

  [[nodiscard]] Allowed allowed(double energy, double spin) const {
    Allowed all;
    double own = energy;
    Eigen::MatrixXd changed = changes(own);
    for (int pass = 0; pass < 2 && M == BaseMotion::free; ++pass) { // smaller ways leave less
      const double inertia = 1 / model.rigid, change = changed.sum();
      if (change >= inertia) return {INFINITY, 1, INFINITY};
      own = energy - spin * spin / (2 * (inertia + change));
      changed = changes(own);
    }
    all.mu = (answers * changed).eigenvalues().cwiseAbs().maxCoeff();
    all.size = std::sqrt(2 * own / (1 - all.mu));
    const double whirl = M == BaseMotion::free ? spin / (1 / model.rigid - changed.sum()) : 0;
    const Eigen::VectorXd rates = (all.size * answers.diagonal().cwiseSqrt()).array() + whirl;
    all.drift = model.rigid * (changed * rates).sum();
    return all;
  }

  /// Of the moment of hinge i.
  [[nodiscard]] double moment(const Allowed& all, int i) const {
    const Eigen::VectorXd K = model.stiffness.row(i), C = model.damping.row(i);
    const double root = std::sqrt(K.dot(K.cwiseQuotient(kappa)) + C.dot(inverse * C));
    return all.size * root + std::abs(K.dot(apart)) + model.remainders[i].steady +
           std::abs(model.moment(i));
  }

  const RestModel& model;
  int n;
  Eigen::VectorXd kappa, apart;
  Eigen::MatrixXd inverse, answers;
};

/// A wing on latches that hardly damp, with friction that could swing it for ever.
Scene rubbing_wing(std::uint64_t seed, BaseMotion motion, bool loops) {
  oracle::Draws draws(seed);
  oracle::RandomScene options;
  options.bodies = (loops ? 2 : 1) + static_cast<int>(seed % 4), options.motion = motion;
  options.mass_lower = 1, options.mass_upper = 10;
  Scene scene = oracle::random_scene(seed, options);
  scene.base.rate = 0, scene.base.mass = 20, scene.base.inertia = 20;
  for (Hinge& hinge : scene.hinges) {
    hinge.spring = {}, hinge.harness = {};
    hinge.stowed = hinge.latched + 3 * draws.sign(); // far from where it swings
    hinge.friction.coulomb = 1, hinge.friction.viscous = 0;
    hinge.friction.regularization_rate = 0.02;
    const double stiffness = draws.log_uniform(100, 300);
    hinge.latch = Latch{stiffness, 1e-6 * stiffness};
  }
  if (loops) { // the wing then rests off the latched angles
    Synchronisation loop;
    loop.second = 1, loop.ratio = draws.uniform(0.9, 1.1), loop.stiffness = 30;
    loop.damping = 1e-5;
    scene.synchronisations = {loop};
  }
  return scene;
}

/// Holds the bounds against what energies allow by which μ is up to 0.8. @param turning share of the energy that turns the whole
template <BaseMotion M> void check_against_energy(bool loops, double turning) {
  int all = 0, close = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed, turning, loops);
    Latched<M> wing(rubbing_wing(seed, M, loops));
    REQUIRE(wing.has_model);
    const EnergyOracle<M> oracle(wing);
    for (double energy = 0.1; energy < 300; energy *= 3) {
      const double spin = turning == 0 ? 0 : std::sqrt(2 * turning * energy / wing.model.rigid);
      const Allowed allowed = oracle.allowed(energy, spin);
      if (!(allowed.mu < 0.8)) break;
      const auto found = wing.bound_in_reach(wing.rest(), energy, spin);
      if (!found) continue;
      CAPTURE(energy, allowed.mu, allowed.size);
      for (int i = 0; i < wing.model.size(); ++i) {
        const double moment = oracle.moment(allowed, i);
        CHECK(found->moment(i) > 0.98 * moment);
        const double way = allowed.size * std::sqrt((1 - allowed.mu) / oracle.kappa(i));
        CHECK(found->way(i) < 1.001 * (way + std::abs(oracle.apart(i))));
        ++all, close += found->moment(i) < 1.03 * moment;
      }
      CHECK(found->base.drift < 1.1 * allowed.drift + 1e-9);
    }
  }
  CAPTURE(all, close);
  CHECK(all > 100);
  CHECK(close > 0.9 * all); // μ by a few of Collatz's steps may be too large
}

} // namespace

TEST_CASE("inside the energy's box moments are bounded as the energy allows: fixed bases") {
  check_against_energy<BaseMotion::fixed>(false, 0);
  check_against_energy<BaseMotion::fixed>(true, 0); // loops shift the rest
}

TEST_CASE(
    "inside the energy's box moments are bounded as the energy allows: free bases that may turn") {
  for (const double turning : {0.0, 0.5, 0.9})
    check_against_energy<BaseMotion::free>(false, turning);
}
