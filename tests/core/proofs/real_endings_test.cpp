// Runs with real hinges end early only if they lose no result.
#include "tests/core/deployment/real_runs.hpp"

#include <algorithm>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// A heavy free base at the origin, and on its right a panel with a plate from 0 to 1.5 m, which the
/// wind from below turns from 0 to its latch at 1 rad.
Scene weather_vane(double coulomb) {
  Scene scene = free_panel();
  scene.base.motion = BaseMotion::free;
  scene.base.mass = 1e8, scene.base.inertia = 1e8;
  scene.hinges[0].latch = Latch{};
  scene.environment.air_density = 1.2;
  scene.bodies[0].plate = Plate{{-0.5, 0}, {1, 0}, 2, 1.5};
  if (coulomb > 0) rub(scene.hinges[0], coulomb);
  return scene;
}

/// What an early end must not have missed.
void check_nothing_lost(const Scene& scene, double further,
                        std::optional<double> smoothing = std::nullopt) {
  Integration how = within(1e-8, 60);
  how.smoothing = smoothing;
  const Outcome early = Deployment().run(scene, how, {});
  if (early.status == Status::failed) return;
  Integration on = how;
  on.t_end = std::min(60., early.t_end + further);
  const Outcome late = Deployment().run(scene, on, to_the_end);
  CAPTURE(to_string(early.status), early.reason, early.t_end, early.peaks_final);
  REQUIRE(late.status != Status::failed);
  CHECK(late.latches.size() == early.latches.size());
  if (!early.peaks_final) return;
  CHECK(late.peaks_final); // whatever else is asked for
  for (std::size_t i = 0; i < late.peak_moment.size(); ++i) {
    CAPTURE(i);
    CHECK(late.peak_moment[i].value <= early.peak_moment[i].value * (1 + 1e-6));
    CHECK(late.peak_force[i].value <= early.peak_force[i].value * (1 + 1e-6));
  }
}

/// Random wings that have a chance to deploy: strong springs, ways of π at most.
Scene eager(std::uint64_t seed) {
  RandomScene options;
  options.bodies = 1 + static_cast<int>(seed % 4);
  options.mass_lower = 1, options.mass_upper = 20;
  options.motion = static_cast<BaseMotion>(seed % 3);
  options.harness = false;
  Scene scene = random_scene(seed, options);
  scene.base.angular_acceleration = 0;
  for (Hinge& hinge : scene.hinges)
    hinge.spring.torque_stowed *= 5, hinge.spring.torque_latched *= 5,
        hinge.friction.viscous += 0.5, hinge.latch->damping += 50;
  return scene;
}

/// Adds a detent to the hinge's spring: a moment that rises to `height` and falls again within ± `width`, at a share of
/// the travel before the latched angle.
void add_detent(Hinge& hinge, double share, double width, double height) {
  const double travel = hinge.stowed - hinge.latched;
  const auto angle = [&](double from_latched) { return hinge.latched + from_latched * travel; };
  const auto line = [&](double x) {
    return std::lerp(hinge.spring.torque_latched, hinge.spring.torque_stowed, x);
  };
  const double half = width / std::abs(travel);
  const std::vector<double> shares{1, share + half, share, share - half, 0};
  std::vector<double> angles, torques;
  for (const double x : shares) angles.push_back(angle(x)), torques.push_back(line(x));
  torques[2] += height;
  hinge.spring.table = torque_table(angles, torques, Interpolation::linear);
}

} // namespace

TEST_CASE("the wind of its own flight opens a wing that has no energy of its own") {
  Scene scene = weather_vane(0);
  scene.base.velocity = {0, -3};
  scene.hinges[0].latch = Latch{1e3, 10};
  const Outcome out = run_everywhere(scene, 1e-11, 10);
  CAPTURE(to_string(out.status), out.reason);
  REQUIRE(out.status == Status::deployed);
  compare(out, real_reference(scene, out.t_end), 1e-8, 1e-6);
}

TEST_CASE("a falling wing whose hinges stick is blown open once it falls fast enough") {
  // F = ½ ρ C b v² on 1.5 m, 0.75 m from the hinge: it breaks loose where B v² = τ, v = g t
  Scene scene = weather_vane(2);
  scene.environment.gravity = {0, -10};
  const double B = 0.5 * 1.2 * 1.5 * 2 * 1.5 * 0.75;
  const double loose = std::sqrt(2 / B) / 10;
  const Outcome out = run_everywhere(scene, 1e-11, 10);
  CAPTURE(to_string(out.status), out.reason, loose);
  REQUIRE(out.status == Status::deployed);
  CHECK(out.latches[0].time > loose);
  const Outcome before = run(scene, 1e-11, 0.999 * loose);
  CHECK(before.final.angles[0] == 0);
  CHECK(before.status == Status::timed_out); // no energy bounds what the air may still do
  const Outcome after = run(scene, 1e-11, 1.05 * loose);
  CHECK(after.final.angles[0] > 0);
}

TEST_CASE("in still air on a base that stands, peaks are proven final and do not rise") {
  RealFeatures features{false, false, false, false, false, false,
                        false, false, false, false, false, false};
  features.air = true;
  int deployed = 0, final = 0;
  for (std::uint64_t seed = 1; seed <= 48; ++seed) {
    Scene scene = eager(seed);
    scene.base = Base{};
    scene = with_real_hinges(scene, seed, features);
    if (scene.environment.air_density == 0) continue;
    scene.environment.air_density *= seed % 3 == 0 ? 30 : 1; // blows harder than it weighs
    if (seed % 2 == 0) scene.environment.gravity = {0.02, -0.05};
    CAPTURE(seed);
    check_nothing_lost(scene, 20);
    const Outcome out = Deployment().run(scene, within(1e-8, 60), {});
    deployed += out.status == Status::deployed, final += out.peaks_final;
    scene.base.motion = BaseMotion::prescribed, scene.base.rate = 0.01; // the air may bring energy
    check_nothing_lost(scene, 20);
  }
  CAPTURE(deployed, final);
  CHECK((deployed >= 15 && final > deployed / 2));
}

TEST_CASE("with real hinges, an early end misses no latch and no peak", "[long]") {
  int final = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    const Scene scene = with_real_hinges(eager(seed), seed);
    check_nothing_lost(scene, 10);
    final += Deployment().run(scene, within(1e-8, 60), {}).peaks_final ? 1 : 0;
  }
  WARN(final << " of 40 ended by proof");
}

TEST_CASE("on bases that turn faster and faster, an early end misses no latch and no peak") {
  RealFeatures features;
  features.backlash = features.air = features.gravity = features.stops = false;
  int deployed = 0, early = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Draws draws(seed);
    Scene scene = eager(seed);
    if (seed % 2 == 0) scene = with_real_hinges(scene, seed, features);
    scene.base = {};
    scene.base.motion = BaseMotion::prescribed;
    scene.base.rate = draws.uniform(-0.02, 0.02);
    scene.base.angular_acceleration = (seed % 4 < 2 ? 1 : -1) * draws.log_uniform(1e-5, 1e-2);
    if (seed % 8 == 0) scene.base.acceleration = {0.01, -0.02};
    check_nothing_lost(scene, 60);
    const Outcome out = Deployment().run(scene, within(1e-8, 60), {});
    deployed += out.status == Status::deployed;
    early += out.status == Status::deployed && out.t_end < 60;
  }
  CAPTURE(deployed, early);
  CHECK((deployed > 20 && early > deployed / 2));
}

TEST_CASE("with real hinges and smoothed latches, an early end misses no latch and no peak",
          "[long]") {
  RealFeatures features;
  features.backlash = features.air = features.gravity = features.stops = false;
  int deployed = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Scene scene = eager(seed);
    for (Hinge& hinge : scene.hinges) { // soft ones: it takes them long to turn the wing back
      Draws draws(seed);
      hinge.latch = Latch{draws.log_uniform(30, 3000), draws.log_uniform(0.2, 10)};
    }
    CAPTURE(seed);
    scene = with_real_hinges(scene, seed, features);
    check_nothing_lost(scene, 10, 1e-3);
    Integration how = within(1e-8, 60);
    how.smoothing = 1e-3;
    const Outcome out = Deployment().run(scene, how, {});
    deployed += out.status == Status::deployed && out.t_end < 60;
  }
  CHECK(deployed >= 10);
}

TEST_CASE(
    "with detents steeper than the latches are stiff, an early end misses no latch and no peak",
    "[long]") {
  int deployed = 0, final = 0; // of the wings with such a detent
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    Draws draws(seed);
    Scene scene = eager(seed);
    bool steep = false;
    for (Hinge& hinge : scene.hinges) {
      hinge.latch = Latch{draws.log_uniform(300, 10'000), draws.log_uniform(2, 50)};
      // some so near to the latched angle that the wing may come back to them
      const double width = draws.log_uniform(1e-3, 0.01), height = draws.uniform(1, 20);
      add_detent(hinge, draws.log_uniform(0.05, 0.9), width, height);
      steep = steep || height / width > hinge.latch->stiffness;
    }
    check_nothing_lost(scene, 10);
    const Outcome out = Deployment().run(scene, within(1e-8, 60), {});
    deployed += steep && out.status == Status::deployed, final += steep && out.peaks_final;
  }
  CAPTURE(deployed, final);
  CHECK((deployed > 10 && final > deployed / 2));
}

TEST_CASE("with each feature of real hinges, an early end misses no latch and no peak", "[long]") {
  const RealFeatures none{false, false, false, false, false, false,
                          false, false, false, false, false, false};
  bool RealFeatures::*const each[] = {
      &RealFeatures::tables,  &RealFeatures::measured, &RealFeatures::dampers,
      &RealFeatures::stops,   &RealFeatures::backlash, &RealFeatures::loops,
      &RealFeatures::gravity, &RealFeatures::air,      &RealFeatures::dissipation};
  for (int feature = 0; feature < 9; ++feature)
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      RealFeatures features = none;
      features.*each[feature] = true;
      CAPTURE(feature, seed);
      check_nothing_lost(with_real_hinges(eager(seed), seed, features), 10);
    }
}
