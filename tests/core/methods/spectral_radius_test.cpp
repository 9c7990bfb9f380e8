#include "core/methods/spectral_radius.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/decompositions.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/real_scenes.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

TEST_CASE("the spectral radius is found within a fifth") {
  for (const auto& [stiffness, damping] : {std::pair(1e4, 1.), {1e4, 1e4}, {1e9, 1e3}, {0., 10.}}) {
    Scene scene = latching_panel();
    scene.hinges[0].latch = Latch{stiffness, damping};
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    State<double> x;
    system.start(x);
    SpectralRadius<double> radius;
    CHECK(radius.estimate(system, x, 0.0) == 0); // constant moment, no latch yet
    system.engage(1);
    // I λ² + d λ + k = 0
    const double d = damping / panel_inertia / 2, k = stiffness / panel_inertia;
    const double exact = d * d < k ? std::sqrt(k) : d + std::sqrt(d * d - k);
    CAPTURE(stiffness, damping);
    CHECK(radius.estimate(system, x, 0.0) == Approx(exact).epsilon(0.2));
  }
}

namespace {

/// ρ over its bound, at a random configuration with all latches engaged and no rates: friction resists most there.
template <BaseMotion M> double share_of_bound(const Scene& scene, Draws& draws) {
  Wing<double> wing = make_wing<double>(scene, outward_order(scene));
  set_parameters(wing, scene);
  Workspace<double> work;
  System<double, Tree, M> system(wing, std::nullopt, work);
  State<double> x;
  system.start(x);
  const Layout& at = system.layout();
  const int n = at.bodies, base = at.freedoms() - n;
  for (int i = 1; i <= n; ++i) {
    system.engage(i);
    x[at.angle(i)] = draws.uniform(-3, 3), x[at.rate(i)] = 0;
  }
  LinearSolve<double> solve;
  solve.factorize(system, x, 0.0, [](int) { return 0.0; });
  Eigen::MatrixXd model = Eigen::MatrixXd::Zero(2 * n, 2 * n); // [0 E2; −M⁻¹K −M⁻¹D] of the hinges
  model.topRightCorner(n, n).setIdentity();
  State<double> column(at.freedoms());
  for (int i = 1; i <= n; ++i) {
    solve.solve(
        system, [&](int k) { return k == i ? 1.0 : 0.0; }, column.data());
    const Resistance<double> hinge = resistance(system, x, 0.0, i);
    for (int k = 0; k < n; ++k) {
      model(n + k, i - 1) = -column[base + k] * hinge.stiffness;
      model(n + k, n + i - 1) = -column[base + k] * hinge.damping;
    }
  }
  return model.eigenvalues().cwiseAbs().maxCoeff() / spectral_radius_bound<double>(system);
}

} // namespace

TEST_CASE("no wing's spectral radius exceeds its bound, and one wing attains it") {
  double most = 0, least = 1;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    Draws draws(seed);
    RandomScene options;
    options.bodies = 1 + draws.below(6);
    options.motion = seed % 2 == 0 ? BaseMotion::fixed : BaseMotion::free;
    options.friction = seed % 3 == 0;
    const Scene scene = random_scene(seed, options);
    const double share = seed % 2 == 0 ? share_of_bound<BaseMotion::fixed>(scene, draws)
                                       : share_of_bound<BaseMotion::free>(scene, draws);
    CAPTURE(seed, share);
    CHECK(share < 1 + 1e-9);
    most = std::max(most, share), least = std::min(least, share);
  }
  CHECK(most > 0.7); // it says something
  WARN("shares of the bound from " << least << " to " << most);

  Scene wheel =
      latching_panel(); // hinged where its centre of mass is: all of (1) and (2) is attained
  wheel.hinges[0].child_point = {0, 0};
  wheel.hinges[0].latch = Latch{1e4, 0};
  Draws draws(1);
  CHECK(share_of_bound<BaseMotion::fixed>(wheel, draws) == Approx(1));
}

namespace {

/// ρ by the differences of the hinges' moments, of a wing whose moments change little beside them.
template <BaseMotion M>
double radius_by_differences(System<double, Tree, M>& system, const State<double>& x) {
  const Layout& at = system.layout();
  const int n = at.bodies, base = at.freedoms() - n;
  LinearSolve<double> solve;
  solve.factorize(system, x, 0.0, [](int) { return 0.0; });
  Eigen::MatrixXd model = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  model.topRightCorner(n, n).setIdentity();
  State<double> column(at.freedoms());
  for (int j = 0; j < 2 * n; ++j) {
    const double d = 1e-7;
    State<double> up = x, down = x;
    const int k = j < n ? at.angle(j + 1) : at.rate(j - n + 1);
    up[k] += d, down[k] -= d;
    solve.solve(
        system,
        [&](int i) {
          return (system.sliding_moment(up, i) - system.sliding_moment(down, i)) / (2 * d);
        },
        column.data());
    for (int i = 0; i < n; ++i) model(n + i, j) = column[base + i];
  }
  return model.eigenvalues().cwiseAbs().maxCoeff();
}

} // namespace

TEST_CASE(
    "the spectral radius is that of loops, motors and friction too, and motors are in its bound") {
  double of_bound = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Draws draws(seed);
    RandomScene options;
    options.bodies = 2 + draws.below(3), options.motion = BaseMotion::fixed,
    options.springs = false;
    Scene scene = random_scene(seed, options);
    const int kind = static_cast<int>(seed % 3); // of what is stiff: loops, motors, friction
    for (Hinge& hinge : scene.hinges) {
      hinge.harness = {}, hinge.friction = {};
      if (kind == 1)
        hinge.motor = Motor{.rate = 0.1, .gain = draws.log_uniform(1, 1e3), .torque_limit = 1e6};
      if (kind == 2)
        hinge.friction.coulomb = draws.log_uniform(0.01, 1),
        hinge.friction.regularization_rate = draws.log_uniform(1e-4, 1e-2);
    }
    if (kind == 0) {
      Synchronisation loop;
      loop.name = "loop", loop.first = 0, loop.second = 1;
      loop.ratio = draws.sign() * draws.uniform(0.3, 3);
      loop.stiffness = draws.log_uniform(1, 1e4), loop.damping = draws.log_uniform(1e-2, 1e3);
      scene.synchronisations = {loop};
    }
    Wing<double> wing = make_wing<double>(scene, outward_order(scene));
    set_parameters(wing, scene);
    Workspace<double> work;
    System<double, Tree, BaseMotion::fixed> system(wing, std::nullopt, work);
    State<double> x, dxdt;
    system.start(x), dxdt.resize(x.size());
    for (int i = 1; i <= wing.size(); ++i) x[system.layout().rate(i)] = 0;
    system(x, dxdt, 0.0);
    SpectralRadius<double> radius;
    const double exact = radius_by_differences(system, x);
    const double share = radius.estimate(system, x, 0.0) / exact;
    CAPTURE(seed, kind, share);
    CHECK(share > 0.7);
    CHECK(share < 1.2);
    if (kind != 1) continue;
    CHECK(exact <= spectral_radius_bound<double>(system) * (1 + 1e-6));
    of_bound = std::max(of_bound, exact / spectral_radius_bound<double>(system));
  }
  CHECK(of_bound > 0.5);
}
