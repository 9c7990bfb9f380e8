// The energy of a latched wing on a base that turns faster and faster, or is pushed: no motion exceeds what is said of it.
#include "tests/core/proofs/latched_wing.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace wingspread;
using oracle::Latched;

namespace {

using Driven = Latched<BaseMotion::prescribed>;

/// T + Σ ½ κ (φ − rest)² as seen from the base, by a wing on a base that stands still, J.
struct SeenEnergy {
  explicit SeenEnergy(Scene scene) : still(standing(scene)) {}

  [[nodiscard]] double operator()(const Driven& wing, const State<double>& x) {
    double sum = total_motion(still.system, x, 0.).kinetic;
    for (int i = 1; i <= wing.at.bodies; ++i) {
      const double u = x[wing.at.angle(i)] - wing.remaining.rest()[wing.at.angle(i)];
      sum += 0.5 * wing.remaining.least_stiffness()[i - 1] * u * u;
    }
    return sum;
  }

private:
  static Scene standing(Scene scene) {
    scene.base = {};
    return scene;
  }
  Latched<BaseMotion::fixed> still;
};

/// The largest energy seen on the way, by Runge and Kutta's classical steps, J.
double largest_on_way(Driven& wing, SeenEnergy& seen, State<double> x, double h, int steps) {
  const int n = wing.at.size();
  State<double> k1(n), k2(n), k3(n), k4(n), y(n);
  double most = 0;
  const auto stage = [&](const State<double>& k, double part, double t, State<double>& to) {
    for (int j = 0; j < n; ++j) y[j] = x[j] + part * k[j];
    wing.system(y, to, t + part);
  };
  for (int step = 0; step < steps; ++step) {
    const double t = step * h;
    most = std::max(most, seen(wing, x));
    wing.system(x, k1, t);
    stage(k1, h / 2, t, k2), stage(k2, h / 2, t, k3), stage(k3, h, t, k4);
    for (int j = 0; j < n; ++j) x[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
  }
  return most;
}

/// A wing that hardly damps, on soft latches.
Scene ringing_wing(int k, oracle::Draws& draws) {
  oracle::RandomScene options;
  options.bodies = 1 + k % 5, options.branching = k % 3 == 0;
  options.motion = BaseMotion::prescribed, options.friction = false;
  options.mass_lower = 1, options.mass_upper = 10;
  Scene scene = oracle::random_scene(2600 + k, options);
  scene.base = {}, scene.base.motion = BaseMotion::prescribed;
  for (Hinge& hinge : scene.hinges) {
    hinge.spring = {}, hinge.harness = {}, hinge.friction = {};
    hinge.stowed = hinge.latched + 3 * draws.sign(); // far from where it swings
    const double stiffness = draws.log_uniform(300, 3000);
    hinge.latch = Latch{stiffness, 1e-5 * stiffness};
  }
  return scene;
}

/// Moves the hinges, from rest, so that the energy seen is this much.
State<double> with_energy(Driven& wing, SeenEnergy& seen, oracle::Draws& draws, double energy) {
  State<double> x = wing.rest();
  const State<double> rest = x;
  const double fast = wing.fastest();
  for (int i = 1; i <= wing.at.bodies; ++i) {
    x[wing.at.angle(i)] += draws.uniform(-1, 1);
    x[wing.at.rate(i)] = fast * draws.uniform(-1, 1) * draws.log_uniform(0.01, 1);
  }
  const State<double> far = x;
  double low = 0, high = 1;
  for (int pass = 0; pass < 60; ++pass) {
    const double share = (low + high) / 2;
    for (std::size_t j = 0; j < x.size(); ++j) x[j] = rest[j] + share * (far[j] - rest[j]);
    (seen(wing, x) < energy ? low : high) = share;
  }
  return x;
}

} // namespace

TEST_CASE("no motion on a base that turns faster and faster has more energy than (11) says") {
  int bounded = 0, tried = 0, grown = 0;
  double closest = 0;
  for (int k = 0; k < 120; ++k) {
    oracle::Draws draws(8100 + k);
    Scene scene = ringing_wing(k, draws);
    scene.base.rate = draws.uniform(-1, 1) * draws.log_uniform(1e-2, 2);
    scene.base.angular_acceleration = draws.sign() * draws.log_uniform(1e-3, 1);
    const double end = draws.log_uniform(0.1, 5);
    Driven wing(scene, end);
    if (!wing.has_model) continue;
    SeenEnergy seen(scene);
    const State<double> x = with_energy(wing, seen, draws, draws.log_uniform(1e-3, 1));
    const auto so_far = wing.remaining.energy_so_far(wing.system, x, 0.);
    REQUIRE(so_far);
    const auto most = wing.modes->most_energy(*so_far, end);
    ++tried;
    if (!most) continue;
    ++bounded;
    const int steps = static_cast<int>(end * wing.fastest() / 0.3) + 1;
    const double largest = largest_on_way(wing, seen, x, end / steps, steps);
    CAPTURE(k, scene.base.rate, scene.base.angular_acceleration, end, *so_far, *most);
    CHECK(largest <= *most);
    closest = std::max(closest, largest / *most);
    grown += largest > 1.1 * seen(wing, x);
  }
  CAPTURE(bounded, tried, grown, closest);
  CHECK((bounded >= 60 && grown >= 10));
  CHECK(closest > 0.9);
}

TEST_CASE(
    "the time left adds to (11) at least what the angular acceleration does off the way to rest") {
  int bounded = 0;
  double closest = 0;
  for (int k = 0; k < 40; ++k) {
    oracle::Draws draws(8700 + k);
    Scene scene = ringing_wing(k, draws);
    const double quickening = draws.log_uniform(1e-3, 1e-2), time = 1e-3;
    scene.base.rate = draws.uniform(-0.01, 0.01), scene.base.angular_acceleration = quickening;
    Driven wing(scene, time);
    if (!wing.has_model) continue;
    SeenEnergy seen(scene);
    const double energy = draws.log_uniform(0.01, 1);
    const auto now = wing.modes->most_energy(energy, 0),
               later = wing.modes->most_energy(energy, time);
    if (!now || !later) continue;
    ++bounded;
    const double power = (*later - *now) / time;
    Latched<BaseMotion::fixed> still([&] {
      Scene s = scene;
      s.base = {};
      return s;
    }());
    for (int n = 0; n < 30; ++n) {
      State<double> x = with_energy(wing, seen, draws, energy), at_rest = wing.rest();
      for (int i = 1; i <= wing.at.bodies; ++i) at_rest[wing.at.rate(i)] = x[wing.at.rate(i)];
      const double momentum = total_motion(still.system, x, 0.).angular -
                              total_motion(still.system, at_rest, 0.).angular;
      CAPTURE(k, quickening, energy, power);
      CHECK(quickening * std::abs(momentum) <= power * (1 + 1e-6));
      closest = std::max(closest, quickening * std::abs(momentum) / power);
    }
  }
  CAPTURE(bounded, closest);
  CHECK(bounded >= 20);
  CHECK(closest > 0.3);
}

TEST_CASE("no motion on a base that is pushed, or turns, has more energy than (4) says") {
  int grown = 0;
  double closest = 0;
  for (int k = 0; k < 60; ++k) {
    oracle::Draws draws(8400 + k);
    Scene scene = ringing_wing(k, draws);
    if (k % 2 == 0)
      scene.base.rate = draws.sign() * draws.log_uniform(0.03, 1);
    else
      scene.base.acceleration = {draws.sign() * draws.log_uniform(1e-2, 1),
                                 draws.sign() * draws.log_uniform(1e-2, 1)};
    Driven wing(scene);
    if (!wing.has_model) continue;
    SeenEnergy seen(scene);
    const State<double> x = with_energy(wing, seen, draws, draws.log_uniform(1e-3, 1));
    const auto left = wing.remaining.energy(wing.system, x, 0.);
    REQUIRE(left);
    const double largest = largest_on_way(wing, seen, x, 0.3 / wing.fastest(), 3000);
    CAPTURE(k, scene.base.rate, scene.base.acceleration.x(), left->whole, left->elastic);
    CHECK(largest <= left->elastic);
    closest = std::max(closest, largest / left->elastic);
    grown += largest > 1.1 * seen(wing, x);
  }
  CAPTURE(grown, closest);
  CHECK(grown >= 10);
  CHECK(closest > 0.9);
}
