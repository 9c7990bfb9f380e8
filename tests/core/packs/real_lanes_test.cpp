// Runs with real hinges in lanes have the bits of the runs alone.
#include "core/deployment.hpp"
#include "tests/core/packs/same_bits.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/real_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// `count` units of a wing whose real hinges (springs, harnesses, dampers, loops, stops) are dispersed.
std::vector<Scene> real_units(const Scene& drawing, int count) {
  std::vector<Scene> scenes;
  for (int k = 0; k < count; ++k) {
    Draws draws(300 + k);
    Scene scene = drawing;
    for (Hinge& hinge : scene.hinges) {
      hinge.spring.scale *= draws.uniform(0.9, 1.1);
      hinge.harness.offset += draws.uniform(-0.02, 0.02);
      hinge.friction.scale *= draws.uniform(0.5, 2);
      if (hinge.damper) hinge.damper->scale *= draws.uniform(0.8, 1.2);
      if (hinge.stop) hinge.stop->stiffness *= draws.uniform(0.5, 2);
      if (hinge.latch) hinge.latch->backlash *= draws.uniform(0.5, 1.5);
    }
    for (Synchronisation& loop : scene.synchronisations) {
      loop.stiffness *= draws.uniform(0.8, 1.2);
      if (loop.preload) *loop.preload *= draws.uniform(0.5, 1.5);
    }
    for (Body& body : scene.bodies) body.mass *= draws.uniform(0.95, 1.05);
    scene.environment.air_density *= draws.uniform(0.9, 1.1);
    scenes.push_back(scene);
  }
  return scenes;
}

} // namespace

TEST_CASE("a run in a lane has the bits of the run alone: random wings with real hinges") {
  for (int k = 0; k < 24; ++k) {
    RandomScene options;
    options.bodies = 1 + k % 6;
    options.branching = k % 3 != 0;
    options.motion = static_cast<BaseMotion>(k % 3);
    CAPTURE(k, options.bodies);
    Integration how;
    how.rtol = 1e-6, how.atol = 1e-8, how.t_end = 2, how.max_steps = 3000;
    Scene scene = with_real_hinges(random_scene(700 + k, options), 800 + k);
    if (k % 4 == 3)
      for (Hinge& hinge : scene.hinges) hinge.friction.model = FrictionModel::exact;
    require_equal_bits(real_units(scene, 10), how, k % 2 ? every_peak : latches_alone);
  }
}

TEST_CASE("a run in a lane has the bits of the run alone: motors, of more runs than lanes") {
  for (const BaseMotion motion : {BaseMotion::fixed, BaseMotion::free}) {
    std::vector<Scene> scenes;
    for (int k = 0; k < 11; ++k) {
      Draws draws(2300 + k);
      RandomScene options;
      options.bodies = 3, options.motion = motion, options.friction = false;
      Scene scene = random_scene(2300, options);
      for (Hinge& hinge : scene.hinges) {
        Motor motor;
        motor.rate = draws.uniform(0.05, 0.5);
        motor.gain = draws.log_uniform(0.5, 5), motor.torque_limit = draws.log_uniform(0.3, 3);
        hinge.motor = motor;
      }
      scenes.push_back(scene);
    }
    Integration how = within(1e-6, 8);
    how.method = motion == BaseMotion::free ? "auto" : "dopri5";
    require_equal_bits(scenes, how, every_peak);
    const Outcome one = Deployment().run(scenes[0], within(1e-6, 8), every_peak);
    CHECK(one.motor_energy.size() == 3);
  }
}

TEST_CASE("a run in a lane has the bits of the run alone: bumps in tables narrower than a step") {
  for (const char* method : {"dopri5", "dop853"}) {
    std::vector<Scene> scenes;
    for (int k = 0; k < 12; ++k) {
      Draws draws(500 + k);
      Scene scene = latching_panel();
      Hinge& hinge = scene.hinges[0];
      const double way = hinge.latched - hinge.stowed, narrow = draws.log_uniform(1e-6, 1e-3);
      std::vector<double> at{hinge.stowed}, torque{2};
      for (const double share : {0.3, 0.5, 0.8})
        for (const double bump : {0., draws.log_uniform(1e-3, 1e3), 0.}) {
          at.push_back(at.size() % 3 == 1 ? hinge.stowed + share * way : at.back() + narrow * way);
          torque.push_back(2 + bump);
        }
      at.push_back(hinge.latched + way), torque.push_back(2);
      hinge.spring.table = torque_table(at, torque, Interpolation::linear);
      scenes.push_back(scene);
    }
    CAPTURE(method);
    Integration how = within(1e-4, 4);
    how.method = method;
    // runs in lanes share their tables
    for (const Scene& scene : scenes) require_equal_bits(real_units(scene, 9), how, every_peak);
  }
}

TEST_CASE("a run in a lane has the bits of the run alone: the yoke wing, with stops and without") {
  for (const Scene& scene : {yoke_wing(), yoke_wing_with_stops()})
    for (const char* method : {"auto", "dopri5", "dop853"}) {
      CAPTURE(method, scene.name);
      Integration how;
      how.method = method;
      require_equal_bits(real_units(scene, 10), how, every_peak);
    }
}
