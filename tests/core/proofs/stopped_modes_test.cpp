// Natural modes of wings that press their stops at rest: a stop is then a spring beside the latch.
#include "core/proofs/natural_modes.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

WingModes modes_at_stops(const Scene& scene) {
  std::optional<WingModes> found = natural_modes(scene);
  REQUIRE(found);
  return std::move(*found);
}

double sense_of(const Hinge& hinge) { return hinge.latched > hinge.stowed ? 1 : -1; }

/// The wing with each pressed far stop written into its latch and spring: k_s (latched + s gap − φ) is −k_s (φ − latched)
/// and a constant moment s k_s gap towards deploying.
Scene with_stops_in_latches(Scene scene, const std::vector<double>& rest) {
  for (std::size_t h = 0; h < scene.hinges.size(); ++h) {
    Hinge& hinge = scene.hinges[h];
    if (!hinge.far_stop) continue;
    const Stop stop = *hinge.far_stop;
    const double depth = sense_of(hinge) * (rest[h] - hinge.latched) - stop.gap;
    if (depth > 0) {
      hinge.latch->stiffness += stop.stiffness;
      hinge.latch->damping += stop.stiffness * stop.dissipation * depth;
      hinge.spring.torque_stowed += stop.stiffness * stop.gap;
      hinge.spring.torque_latched += stop.stiffness * stop.gap;
    }
    hinge.far_stop.reset();
  }
  return scene;
}

} // namespace

TEST_CASE("a latch that pulls its panel onto a stop swings by both stiffnesses") {
  Scene scene = latching_panel();
  Hinge& hinge = scene.hinges[0];
  const double s = sense_of(hinge), torque = 4, gap = 0.002, latch = 600, stop = 800;
  hinge.spring = {.torque_stowed = torque, .torque_latched = torque};
  hinge.friction = {};
  hinge.latch = Latch{latch, 0.5};
  hinge.far_stop = Stop{stop, 0.25, gap};
  const double inertia = latch / std::pow(
                                     2 * std::numbers::pi *
                                         [&] {
                                           Scene alone = scene;
                                           alone.hinges[0].far_stop.reset();
                                           return modes_at_stops(alone).modes[0].frequency;
                                         }(),
                                     2);
  const WingModes found = modes_at_stops(scene);
  const double rest = (torque + stop * gap) / (latch + stop);
  CHECK(s * (found.rest[0] - hinge.latched) == Approx(rest).epsilon(1e-12));
  const double omega = std::sqrt((latch + stop) / inertia);
  CHECK(found.modes[0].frequency == Approx(omega / (2 * std::numbers::pi)).epsilon(1e-12));
  const double damping = 0.5 + stop * 0.25 * (rest - gap);
  CHECK(found.modes[0].damping_ratio == Approx(damping / (2 * omega * inertia)).epsilon(1e-12));
  CHECK(natural_frequencies(scene)[0] == found.modes[0].frequency);
  hinge.far_stop->gap = 0.02; // not reached: as without
  CHECK(modes_at_stops(scene).modes[0].frequency ==
        Approx(omega / (2 * std::numbers::pi) * std::sqrt(latch / (latch + stop))).epsilon(1e-12));
}

TEST_CASE("a hinge without a latch rests on the stop that its spring presses, at either side") {
  Scene scene = latching_panel();
  Hinge& hinge = scene.hinges[0];
  const double s = sense_of(hinge);
  hinge.latch.reset(), hinge.friction = {};
  hinge.far_stop = Stop{800, 0, 0};
  hinge.spring = {.torque_stowed = 4, .torque_latched = 2};
  CHECK(s * (modes_at_stops(scene).rest[0] - hinge.latched) > 0);
  CHECK(s * (modes_at_stops(scene).rest[0] - hinge.latched) == Approx(2.0 / 800).epsilon(1e-2));
  hinge.spring = {.torque_stowed = -2, .torque_latched = -4};
  hinge.stop = Stop{800, 0, 0.01};
  CHECK(s * (hinge.stowed - modes_at_stops(scene).rest[0]) ==
        Approx(0.01 + 2.0 / 800).epsilon(1e-2));
}

TEST_CASE("random wings that press their stops have the modes of stiffer latches") {
  const auto cases = static_cast<std::uint64_t>(random_cases(200, 40));
  int pressed = 0;
  for (std::uint64_t seed = 1; seed <= cases; ++seed) {
    RandomScene options;
    options.bodies = 1 + static_cast<int>(seed % 5);
    options.friction = false;
    options.motion = seed % 2 ? BaseMotion::free : BaseMotion::fixed;
    Scene scene = random_scene(seed + 90, options);
    for (Hinge& hinge : scene.hinges) hinge.stop.reset(), hinge.far_stop.reset();
    const WingModes loose = modes_at_stops(scene);
    Draws draws(seed);
    for (std::size_t h = 0; h < scene.hinges.size(); ++h) {
      Hinge& hinge = scene.hinges[h];
      const double beyond = sense_of(hinge) * (loose.rest[h] - hinge.latched);
      if (hinge.latch && beyond > 0)
        hinge.far_stop = Stop{hinge.latch->stiffness * draws.log_uniform(0.1, 10),
                              draws.uniform(0, 1), draws.uniform(0, 0.9) * beyond};
      pressed += hinge.far_stop.has_value();
    }
    const WingModes stopped = modes_at_stops(scene);
    const WingModes same = modes_at_stops(with_stops_in_latches(scene, stopped.rest));
    CAPTURE(seed);
    REQUIRE(stopped.modes.size() == same.modes.size());
    for (std::size_t h = 0; h < same.rest.size(); ++h)
      CHECK(stopped.rest[h] == Approx(same.rest[h]).margin(1e-10));
    for (std::size_t k = 0; k < same.modes.size(); ++k) {
      CHECK(
          stopped.modes[k].frequency ==
          Approx(same.modes[k].frequency).epsilon(1e-9).margin(1e-9 * same.modes.back().frequency));
      CHECK(stopped.modes[k].damping_ratio ==
            Approx(same.modes[k].damping_ratio).epsilon(1e-6).margin(1e-9));
    }
  }
  CHECK(pressed > static_cast<int>(cases));
}
