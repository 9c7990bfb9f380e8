// Natural modes against closed forms and against the accelerations of the dense formulation.
#include "core/proofs/natural_modes.hpp"
#include "tests/support/bending_scenes.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/dense_wing.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/real_scenes.hpp"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

WingModes modes_of(const Scene& scene, const std::optional<std::vector<int>>& latched = {}) {
  std::optional<WingModes> found = natural_modes(scene, latched);
  REQUIRE(found);
  return std::move(*found);
}

double hertz(double omega) { return omega / (2 * pi); }

/// The frequencies of a latched scene by the dense formulation: differences of its accelerations about rest, in extended
/// precision, Hz.
std::vector<double> dense_frequencies(const Scene& scene, const std::vector<double>& rest) {
  const DenseWing<long double> wing(scene);
  const int n = wing.size();
  WingState<long double> state = wing.initial_state();
  state.base_rate = 0, state.base_velocity.setZero();
  state.rates.setZero();
  for (int i = 0; i < n; ++i) {
    state.angles(i) = rest[i];
    if (scene.hinges[i].latch) state.engagement(i) = 1;
  }
  Eigen::MatrixXd A(n, n); // −M⁻¹K
  constexpr long double step = 1e-5L;
  for (int j = 0; j < n; ++j) {
    WingState<long double> ahead = state, behind = state;
    ahead.angles(j) += step, behind.angles(j) -= step;
    A.col(j) =
        ((wing.respond(ahead).hinge_accelerations - wing.respond(behind).hinge_accelerations) /
         (2 * step))
            .cast<double>();
  }
  std::vector<double> found;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  for (const auto& value : solver.eigenvalues())
    found.push_back(hertz(std::sqrt(std::max(0.0, -value.real()))));
  std::sort(found.begin(), found.end());
  return found;
}

} // namespace

TEST_CASE("a latched panel swings as a spring and damper with its inertia") {
  const Scene scene = latching_panel();
  const WingModes found = modes_of(scene);
  REQUIRE(found.modes.size() == 1);
  const double omega = std::sqrt(1e4 / panel_inertia);
  CHECK(found.modes[0].frequency == Approx(hertz(omega)).epsilon(1e-13));
  CHECK(found.modes[0].damping_ratio ==
        Approx(100 / (2 * std::sqrt(1e4 * panel_inertia))).epsilon(1e-13));
  CHECK(found.modes[0].shape == std::vector<double>{1});
  CHECK(natural_frequencies(scene) == std::vector<double>{found.modes[0].frequency});
}

TEST_CASE("gravity alone holds a pendulum, and stiffens a latch below or softens it above") {
  Scene scene = latching_panel(); // its centre of mass lies 0.5 m along +x of the hinge
  scene.hinges[0].latch.reset(), scene.hinges[0].spring = {};
  scene.environment.gravity = {9, 0};
  CHECK(modes_of(scene).modes[0].frequency ==
        Approx(hertz(std::sqrt(10 * 9 * 0.5 / panel_inertia))).epsilon(1e-12));
  scene.hinges[0].latch = Latch{1e3, 0};
  for (const double g : {9.0, -9.0}) {
    scene.environment.gravity = {g, 0};
    CHECK(modes_of(scene).modes[0].frequency ==
          Approx(hertz(std::sqrt((1e3 + 10 * g * 0.5) / panel_inertia))).epsilon(1e-12));
  }
  scene.environment.gravity = {0, -9}; // sags to k u = m g c cos u
  const double sag = modes_of(scene).rest[0];
  CHECK(1e3 * -sag == Approx(45 * std::cos(sag)).epsilon(1e-10));
}

TEST_CASE("a free base takes part: two discs swing with the reduced inertia") {
  Scene scene = coaxial_discs(2, 3);
  scene.bodies.resize(1), scene.hinges.resize(1);
  scene.hinges[0].latch = Latch{50, 0.1};
  scene.base.motion = BaseMotion::free, scene.base.mass = 5, scene.base.inertia = 6;
  const double reduced = 2.0 * 6 / (2 + 6);
  const WingModes found = modes_of(scene);
  CHECK(found.modes[0].frequency == Approx(hertz(std::sqrt(50 / reduced))).epsilon(1e-13));
  CHECK(found.modes[0].damping_ratio == Approx(0.1 / (2 * std::sqrt(50 * reduced))).epsilon(1e-13));
  CHECK(found.modes[0].base_angle == Approx(-2.0 / 8).epsilon(1e-13));
}

TEST_CASE(
    "a hinge that nothing holds has the frequency 0; one that is not latched is held stowed") {
  Scene scene = seed_scene();
  scene.hinges[2].latch.reset(), scene.hinges[2].spring = {};
  std::vector<double> frequencies = natural_frequencies(scene);
  REQUIRE(frequencies.size() == 3);
  CHECK(frequencies[0] == 0);
  CHECK(frequencies[1] > 0.1);
  const Scene wing = seed_scene();
  const WingModes root = modes_of(wing, std::vector<int>{0});
  REQUIRE(root.modes.size() == 1); // the stack of three, folded, about the root
  CHECK(root.rest[1] == wing.hinges[1].stowed);
  double inertia = 0;
  for (const auto& [x, y] : {std::pair(0.505, -0.02), {0.505, -0.06}, {0.505, -0.10}})
    inertia += 0.5 + 10 * (x * x + y * y);
  CHECK(root.modes[0].frequency == Approx(hertz(std::sqrt(1e4 / inertia))).epsilon(1e-3));
  CHECK(root.modes[0].shape[1] == 0);
}

TEST_CASE("a cantilever of segments has frequencies that converge as the page says") {
  // errors of the first frequency of a uniform rod
  const std::pair<int, double> errors[] = {{4, 1.45e-2}, {8, 3.60e-3}, {16, 8.97e-4}};
  const double exact = std::pow(cantilever_roots[0], 2);
  for (const auto& [joints, error] : errors) {
    const WingModes found =
        modes_of(bending_rod(joints, 1), std::vector<int>{}); // the root is held
    REQUIRE(found.modes.size() == static_cast<std::size_t>(joints));
    CAPTURE(joints);
    CHECK(2 * pi * found.modes[0].frequency / exact - 1 == Approx(error).epsilon(0.005));
  }
  const WingModes fine = modes_of(bending_rod(32, 1), std::vector<int>{});
  for (int k = 0; k < 3; ++k)
    CHECK(2 * pi * fine.modes[k].frequency ==
          Approx(std::pow(cantilever_roots[k], 2)).epsilon(0.01));
}

TEST_CASE("a damping ratio given to a panel is its first mode's, and grows with the frequency") {
  Scene scene = bending_rod(16, 1);
  scene.bodies[0].flexible->damping_ratio = 0.02;
  const WingModes found = modes_of(scene, std::vector<int>{});
  CHECK(found.modes[0].damping_ratio == Approx(0.02).epsilon(2e-3));
  CHECK(found.modes[2].damping_ratio ==
        Approx(0.02 * found.modes[2].frequency / found.modes[0].frequency).epsilon(2e-3));
}

TEST_CASE("random latched wings have the frequencies of the dense formulation") {
  const auto cases = static_cast<std::uint64_t>(random_cases(200, 24));
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 5);
    options.friction = false;
    options.motion = seed % 2 ? BaseMotion::free : BaseMotion::fixed;
    Scene scene = with_bending(random_scene(seed, options), seed);
    if (seed % 4 < 2) scene.environment.gravity = {0.3, -0.4};
    CAPTURE(seed);
    const std::optional<WingModes> found = natural_modes(scene);
    REQUIRE(found);
    std::vector<double> rest = found->rest;
    const Segmented made = in_segments(scene);
    REQUIRE(rest.size() == made.scene.hinges.size());
    const std::vector<double> exact = dense_frequencies(made.scene, rest);
    const double largest = exact.back();
    for (std::size_t k = 0; k < exact.size(); ++k) {
      CAPTURE(k, exact[k]);
      CHECK(std::abs(found->modes[k].frequency - exact[k]) < 1e-6 * exact[k] + 1e-7 * largest);
      ++compared;
    }
  }
  CHECK(compared > 3 * static_cast<int>(cases));
}
