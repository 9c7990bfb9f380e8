// Natural modes against closed forms and against the accelerations of the dense formulation.
#include "core/proofs/natural_modes.hpp"
#include "tests/core/proofs/dense_rest.hpp"
#include "tests/support/bending_scenes.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

using namespace wingspread;
using namespace wingspread::oracle;
using std::numbers::pi;

namespace {

WingModes modes_of(const Scene& scene, const std::optional<std::vector<int>>& latched = {}) {
  std::optional<WingModes> found = natural_modes(scene, latched);
  REQUIRE(found);
  return std::move(*found);
}

Motor random_motor(Draws& draws) {
  Motor motor{.rate = draws.uniform(-1, 1), .gain = draws.log_uniform(0.3, 100)};
  motor.torque_limit = motor.gain * draws.log_uniform(0.05, 5);
  if (draws.chance(0.5)) return motor;
  motor.time = {0, 1, 2}, motor.interpolation = Interpolation::linear;
  for (int k = 0; k < 3; ++k) motor.rates.push_back(draws.uniform(-1, 1));
  motor.table = std::make_shared<Curve>(motor.time, motor.rates, motor.interpolation);
  motor.scale = draws.uniform(0.5, 1.5);
  return motor;
}

std::vector<int> all_hinges(const Scene& scene) {
  std::vector<int> all(scene.hinges.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// CHECKs that a free base turns against the hinges of a mode: the whole has no angular momentum.
void check_momentum(const Scene& scene, const WingModes& found, const NaturalMode& mode) {
  const DenseWing<long double> wing(scene);
  WingState<long double> state = wing.initial_state();
  state.base_velocity.setZero();
  for (int i = 0; i < wing.size(); ++i) {
    state.angles(i) = found.rest[i];
    state.rates(i) = mode.shape[i];
  }
  const auto momentum = [&](long double base_rate) {
    state.base_rate = base_rate, state.base_velocity.setZero();
    long double mass = scene.base.mass;
    for (const Body& body : scene.bodies) mass += body.mass;
    state.base_velocity = -wing.balance(state).linear_momentum / mass;
    return wing.balance(state).angular_momentum;
  };
  const long double still = momentum(0), of_base = momentum(1) - still;
  CHECK(std::abs(momentum(mode.base_angle)) < 1e-10L * (std::abs(still) + std::abs(of_base)));
}

/// CHECKs rest, frequencies and damping ratios of some latched hinges against the dense formulation.
/// @return the number of modes; −1 if no rest was found
int check_modes(const Scene& scene, const std::vector<int>& latched) {
  const std::optional<WingModes> found = natural_modes(scene, latched);
  if (!found) return -1;
  const Scene made = in_segments(scene).scene;
  REQUIRE(found->rest.size() == made.hinges.size());
  const DenseRest rest(made, found->rest, latched);
  const std::vector<std::array<double, 2>> exact = rest.modes();
  REQUIRE(found->modes.size() == exact.size());
  if (exact.empty()) return 0;
  CHECK((rest.unbalanced.array().abs() < 1e-9 * (1 + rest.stiffness.cwiseAbs().maxCoeff())).all());
  const double largest = exact.back()[0];
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const auto& [frequency, ratio] = exact[k];
    CAPTURE(k, frequency, ratio);
    CHECK(std::abs(found->modes[k].frequency - frequency) < 1e-6 * frequency + 1e-7 * largest);
    if (scene.base.motion == BaseMotion::free) check_momentum(made, *found, found->modes[k]);
    const bool alone = (k == 0 || frequency - exact[k - 1][0] > 1e-3 * frequency) &&
                       (k + 1 == exact.size() || exact[k + 1][0] - frequency > 1e-3 * frequency);
    if (alone && frequency > 1e-3 * largest)
      CHECK(found->modes[k].damping_ratio == Approx(ratio).epsilon(1e-5).margin(1e-9));
  }
  return static_cast<int>(exact.size());
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
  Scene rattling = scene; // its latch bears, as a joint that is pressed to one side
  rattling.hinges[0].latch->backlash = 0.01;
  CHECK(natural_frequencies(rattling) == natural_frequencies(scene));
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

TEST_CASE("a driven base stands still for small swings") {
  Scene scene = seed_scene();
  const std::vector<double> fixed = natural_frequencies(scene);
  scene.base = driven_by_table(scene, 3, 10).base;
  REQUIRE(scene.base.table);
  scene.base.acceleration.setZero();
  for (const double rate :
       {0.0, 3.0}) { // a table's rates and accelerations do not act, nor does a rate
    scene.base.rate = scene.base.angular_acceleration = rate;
    const WingModes found = modes_of(scene);
    REQUIRE(found.modes.size() == fixed.size());
    for (std::size_t k = 0; k < fixed.size(); ++k)
      CHECK(found.modes[k].frequency == Approx(fixed[k]).epsilon(1e-12));
    CHECK(natural_frequencies(scene)[0] == Approx(fixed[0]).epsilon(1e-12));
  }
  // a constant acceleration beside a table of rates acts
  BaseTable::Columns rates;
  rates.time = {0, 1}, rates.rate = {0.1, 0.3};
  scene.base.table = std::make_shared<const BaseTable>(rates, Interpolation::linear);
  scene.base.acceleration = {2, -3};
  const std::vector<double> pushed = natural_frequencies(scene);
  CHECK(std::abs(pushed[0] - fixed[0]) > 1e-6 * fixed[0]);
  scene.base.table = nullptr, scene.base.rate = scene.base.angular_acceleration = 0;
  CHECK(natural_frequencies(scene) == pushed);
}

TEST_CASE("two hinges that a loop alone ties turn freely together") {
  Scene scene = coaxial_discs(2, 3);
  scene.hinges[1].parent = base_index;
  for (Hinge& hinge : scene.hinges) hinge.latch.reset(), hinge.spring = {};
  Synchronisation loop;
  loop.name = "loop", loop.first = 0, loop.second = 1, loop.stiffness = 1e3;
  for (int k = 0; k < 40; ++k) { // what rounding leaves of K's second pivot has either sign
    const double ratio = (k % 2 ? 1 : -1) * (0.3 + 0.17 * k);
    CAPTURE(ratio);
    loop.ratio = ratio;
    scene.synchronisations = {loop};
    const std::vector<double> found = natural_frequencies(scene);
    REQUIRE(found.size() == 2);
    CHECK(found[0] == 0);
    CHECK(found[1] == Approx(hertz(std::sqrt(1e3 * (ratio * ratio / 2 + 1.0 / 3)))).epsilon(1e-10));
  }
}

TEST_CASE(
    "a hinge that nothing holds has the frequency 0; one that is not latched is held stowed") {
  Scene scene = seed_scene();
  scene.hinges[2].latch.reset(), scene.hinges[2].spring = {};
  std::vector<double> frequencies = natural_frequencies(scene);
  REQUIRE(frequencies.size() == 3);
  CHECK(frequencies[0] == 0);
  CHECK(frequencies[1] > 0.1);
  CHECK(modes_of(scene).modes[0].damping_ratio == 0); // what does not swing is not damped
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

TEST_CASE(
    "a hinge that is not latched swings on its elastic hold as on a joint of this stiffness") {
  Scene held = seed_scene();
  held.hinges[1].spring = {}; // a joint between equal angles knows no sense of its spring
  Scene jointed = held;
  held.hinges[1].release = Release{.time = 1}, held.hinges[1].hold = Hold{20, 0.05};
  Hinge& joint = jointed.hinges[1];
  joint.joint = Joint{20, 0.05}, joint.latched = joint.stowed, joint.latch.reset();
  for (const std::vector<int>& latched : {std::vector<int>{0}, {0, 2}, {}}) {
    const WingModes found = modes_of(held, latched), expected = modes_of(jointed, latched);
    REQUIRE(found.modes.size() == latched.size() + 1);
    REQUIRE(expected.modes.size() == found.modes.size());
    for (std::size_t k = 0; k < found.modes.size(); ++k) {
      CHECK(found.modes[k].frequency == Approx(expected.modes[k].frequency).epsilon(1e-12));
      CHECK(found.modes[k].damping_ratio == Approx(expected.modes[k].damping_ratio).epsilon(1e-9));
    }
    CHECK(found.modes[0].frequency <
          modes_of(seed_scene(), std::vector<int>{0}).modes[0].frequency);
  }
  CHECK(modes_of(held, std::vector<int>{0, 1, 2}).modes.size() == 3); // latched: the hold is gone
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
  // the same of a panel of another length and mass, by its frequency
  Body& panel = scene.bodies[0];
  panel.mass = 9.5, panel.inertia = 9.5 * 1.8 * 1.8 / 12;
  panel.plate->from = {-0.9, 0}, panel.plate->to = {0.9, 0};
  panel.flexible->bending_stiffness.reset(), panel.flexible->frequency = 8;
  scene.hinges[0].child_point = {-0.9, 0};
  const WingModes longer = modes_of(scene, std::vector<int>{});
  CHECK(longer.modes[0].frequency == Approx(8).epsilon(2e-3));
  CHECK(longer.modes[0].damping_ratio == Approx(0.02).epsilon(2e-3));
}

TEST_CASE("random latched wings have the modes of the dense formulation") {
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
    const int modes = check_modes(scene, all_hinges(scene));
    CHECK(modes > 0);
    compared += modes;
  }
  CHECK(compared > 3 * static_cast<int>(cases));
}

TEST_CASE(
    "random wings with loops, motors and measured laws have the modes of the dense formulation") {
  const auto cases = static_cast<std::uint64_t>(random_cases(200, 24));
  int loops = 0, driven = 0, held = 0, without = 0;
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    RandomScene options;
    options.bodies = 2 + static_cast<int>(seed % 4);
    options.friction = false;
    options.motion = seed % 2 ? BaseMotion::free : BaseMotion::fixed;
    // no friction, no stop, no backlash, no air: small swings have none
    RealFeatures features{.measured = false, .stops = false, .backlash = false, .air = false};
    Scene scene = with_real_hinges(random_scene(seed + 600, options), seed, features);
    Draws draws(seed + 70);
    for (Hinge& hinge : scene.hinges) {
      if (hinge.damper && hinge.damper->law == DamperLaw::power) hinge.damper.reset();
      if (draws.chance(0.5)) hinge.motor = random_motor(draws);
      driven += hinge.motor.has_value();
    }
    loops += static_cast<int>(scene.synchronisations.size());
    CAPTURE(seed);
    without += check_modes(scene, all_hinges(scene)) < 0;
    std::vector<int> latched;
    for (const int i : all_hinges(scene))
      if (draws.chance(0.5)) latched.push_back(i);
    held += static_cast<int>(scene.hinges.size() - latched.size());
    without += check_modes(scene, latched) < 0;
  }
  CHECK(without == 0);
  for (const int drawn : {loops, driven, held}) CHECK(drawn > static_cast<int>(cases));
}

TEST_CASE("a motor damps a latched hinge by its gain, pushes it by its torque, and at its limit "
          "only pushes") {
  Scene scene = latching_panel();
  const double k = 1e4, c = 30;
  const double by_latch = 100 / (2 * std::sqrt(k * panel_inertia));
  const double both = (100 + c) / (2 * std::sqrt(k * panel_inertia));
  const double inward = scene.hinges[0].latched > scene.hinges[0].stowed ? -1 : 1;
  struct Given {
    double rate, limit, torque, ratio;
  };
  for (const Given& given : {Given{0, 5, 0, both},
                             {0.1, 5, 3, both},
                             {-0.1, 5, -3, both},
                             {0.1, 2, 2, by_latch},
                             {-0.1, 2, -2, by_latch}}) {
    CAPTURE(given.rate, given.limit);
    scene.hinges[0].spring = {};
    scene.hinges[0].motor = Motor{.rate = given.rate, .gain = c, .torque_limit = given.limit};
    const WingModes found = modes_of(scene);
    CHECK(found.modes[0].damping_ratio == Approx(given.ratio).epsilon(1e-12));
    CHECK(found.modes[0].frequency == Approx(hertz(std::sqrt(k / panel_inertia))).epsilon(1e-12));
    CHECK(found.rest[0] - scene.hinges[0].latched ==
          Approx(-inward * given.torque / k).epsilon(1e-12).margin(1e-16));
  }
  // by a table: what it ends with
  Motor by_table{.time = {0, 1, 2}, .rates = {5, 9, 0.2}, .interpolation = Interpolation::linear};
  by_table.table = std::make_shared<Curve>(by_table.time, by_table.rates, by_table.interpolation);
  by_table.scale = 0.5, by_table.gain = c, by_table.torque_limit = 5;
  scene.hinges[0].motor = by_table;
  const WingModes found = modes_of(scene);
  CHECK(found.modes[0].damping_ratio == Approx(both).epsilon(1e-12));
  CHECK(found.rest[0] - scene.hinges[0].latched == Approx(-inward * 3 / k).epsilon(1e-12));
}

TEST_CASE(
    "a loop between two latched hinges stiffens and damps them, half as much with a slack strand") {
  // two discs, each on its own latch on a fixed base: the loop acts on their difference alone
  const double k = 40, stiffness = 25, damping = 0.3;
  Scene scene = coaxial_discs(1, 1);
  scene.hinges[1].parent = base_index, scene.hinges[1].parent_point = scene.hinges[0].parent_point;
  for (Hinge& hinge : scene.hinges) hinge.latch = Latch{k, 0}, hinge.spring = {};
  const double inertia = scene.bodies[0].inertia;
  Synchronisation loop;
  loop.name = "loop", loop.first = 0, loop.second = 1;
  loop.ratio = (scene.hinges[1].latched - scene.hinges[1].stowed) /
               (scene.hinges[0].latched - scene.hinges[0].stowed);
  REQUIRE(loop.ratio == 1);
  loop.stiffness = stiffness, loop.damping = damping;
  scene.synchronisations = {loop};
  const auto expect = [&](double share) {
    const WingModes found = modes_of(scene);
    const double whole = k + 2 * share * stiffness;
    CHECK(found.modes[0].frequency == Approx(hertz(std::sqrt(k / inertia))).epsilon(1e-12));
    CHECK(found.modes[1].frequency == Approx(hertz(std::sqrt(whole / inertia))).epsilon(1e-12));
    CHECK(found.modes[0].damping_ratio == Approx(0).margin(1e-12));
    CHECK(found.modes[1].damping_ratio ==
          Approx(2 * share * damping / (2 * std::sqrt(whole * inertia))).epsilon(1e-12));
  };
  expect(1);
  scene.synchronisations[0].preload = 1e-3; // out of step at rest by more than the preload allows
  scene.hinges[0].latched += 0.2;
  expect(0.5);
}
