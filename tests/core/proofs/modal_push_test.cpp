// The bounds by modes under a push on a base that turns; and where the compiler knows how many hinges there are.
#include "tests/core/proofs/latched_wing.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace wingspread;
using oracle::Draws;
using oracle::Latched;
using oracle::with_latches;

TEST_CASE(
    "a push is followed as the base turns under it, and not taken for one that finds every mode") {
  Scene scene = oracle::seed_scene();
  scene.base.motion = BaseMotion::prescribed;
  for (const double rate : {-0.2, 0.035, 0.1}) {
    scene.base.rate = rate, scene.base.angle = 0.7, scene.base.acceleration = {0.06, -0.08};
    for (Hinge& hinge : scene.hinges) hinge.friction = {}, hinge.latch->damping = 200;
    Latched<BaseMotion::prescribed> wing(scene);
    REQUIRE(wing.has_model);
    const Layout& at = wing.at;
    State<double> x = wing.rest();
    constexpr double turn = 2 * std::numbers::pi;
    const int round = static_cast<int>(turn / std::abs(rate) / 0.002);
    const auto ring_off = [&](int steps, double from, const auto& look) {
      State<double> k1(at.size()), k2 = k1, y = x; // Heun's steps of 2 ms
      for (int step = 0; step < steps; ++step) {
        const double t = from + 0.002 * step;
        wing.system(x, k1, t);
        look();
        for (int j = 0; j < at.size(); ++j) y[j] = x[j] + 0.002 * k1[j];
        wing.system(y, k2, t + 0.002);
        for (int j = 0; j < at.size(); ++j) x[j] += 0.001 * (k1[j] + k2[j]);
      }
    };
    const int before = std::max(round, 60000);
    ring_off(before, 0, [] {});
    const std::vector<double> no_peak(at.bodies, 1e300);
    REQUIRE(wing.modes.none_exceeds(&x[at.angle(1)], &x[at.rate(1)], no_peak.data(), no_peak.data(),
                                    0.002 * before, std::nullopt, 0));
    const Eigen::VectorXd bound = wing.modes.moment();
    Eigen::VectorXd most = Eigen::VectorXd::Zero(at.bodies);
    ring_off(round, 0.002 * before, [&] {
      for (int i = 1; i <= at.bodies; ++i)
        most(i - 1) = std::max(most(i - 1), std::abs(wing.system.moment(x, i)));
    });
    CAPTURE(rate, bound.transpose(), most.transpose());
    CHECK((most.array() <= bound.array()).all());
    CHECK(bound(0) < 1.5 * most(0));
  }
}

namespace {

/// Bounds of matrices whose size the compiler knows, and of any, from random states of a latched chain.
/// @return from how many states nothing exceeds them
template <int N> int compare_known(std::uint64_t seed) {
  Draws draws(seed);
  oracle::RandomScene options;
  options.bodies = N, options.branching = false;
  options.motion = BaseMotion::free;
  options.mass_lower = 1, options.mass_upper = 30;
  Latched<BaseMotion::free> wing(with_latches(oracle::random_scene(800 + seed, options), draws));
  REQUIRE(wing.has_model);
  ModalBounds<N> known;
  REQUIRE(known.prepare(wing.model));
  known.prepare_cap(wing.prospects.least_stiffness(), &wing.prospects.rest()[wing.at.angle(1)]);
  const std::vector<double> peaks(N, 1e300);
  int bounded = 0;
  for (int k = 0; k < 20; ++k) {
    std::vector<double> angles(N), rates(N);
    for (int i = 0; i < N; ++i) {
      angles[i] = wing.model.angles(i) + draws.uniform(-1, 1) * draws.log_uniform(1e-5, 1e-2);
      rates[i] = draws.uniform(-1, 1) * draws.log_uniform(1e-4, 0.1);
    }
    const auto ask = [&](auto& bounds) {
      return bounds.none_exceeds(angles.data(), rates.data(), peaks.data(), peaks.data(), 0,
                                 k % 2 == 0 ? std::optional(1e-3) : std::nullopt, 0.01 * k);
    };
    CAPTURE(N, seed, k);
    const bool holds = ask(wing.modes);
    REQUIRE(ask(known) == holds);
    CHECK((known.rates() - wing.modes.rates()).norm() <= 1e-9 * wing.modes.rates().norm());
    CHECK((known.moment() - wing.modes.moment()).norm() <= 1e-9 * wing.modes.moment().norm());
    CHECK((known.force() - wing.modes.force()).norm() <= 1e-9 * wing.modes.force().norm());
    bounded += holds;
  }
  return bounded;
}

} // namespace

TEST_CASE(
    "bounds by modes are the same whether or not the compiler knows how many hinges there are") {
  int bounded = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    bounded += compare_known<1>(seed) + compare_known<2>(seed) + compare_known<3>(seed) +
               compare_known<4>(seed);
  CHECK(bounded > 200);
}
