// What the energy's change before the first latch is said to be: dissipated, exchanged, or of the integration's error.
#include "montecarlo/report/text/outcome_report.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <string>
#include <utility>
#include <vector>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Of the wing's first second.
Outcome first_second(const Scene& scene) {
  Integration integration;
  integration.t_end = 1;
  return Deployment().run(scene, integration, Goal{.to_t_end = true});
}

} // namespace

TEST_CASE("the energy's change before the first latch has its cause") {
  Scene scene = read_scene_file(three_panel_file());
  const Outcome outcome = first_second(scene);
  const auto told = [&](const char* cause) {
    CHECK_THAT(outcome_text(scene, outcome),
               Catch::Contains(std::string(" J ") + cause + " before the first latch."));
  };
  told("of integration error"); // its latches damp, but not before they engage
  scene.hinges[1].damper = Damper{};
  told("dissipated");
  scene.hinges[1].damper.reset();
  scene.hinges[2].friction.viscous = 0.1;
  told("dissipated");
  scene.base.motion = BaseMotion::prescribed;
  told("dissipated or exchanged with the base");
  scene.hinges[0].motor = Motor{};
  told("dissipated or exchanged with the motors and the base");
  scene.base.motion = BaseMotion::fixed;
  told("dissipated or exchanged with the motors");
}

TEST_CASE("each part that dissipates alone makes the energy's change a dissipation") {
  const Scene plain = read_scene_file(three_panel_file());
  const Outcome outcome = first_second(plain);
  const std::vector<std::pair<const char*, void (*)(Scene&)>> parts{
      {"coulomb", [](Scene& scene) { scene.hinges[1].friction.coulomb = 0.1; }},
      {"viscous", [](Scene& scene) { scene.hinges[1].friction.viscous = 0.1; }},
      {"damper", [](Scene& scene) { scene.hinges[1].damper.emplace(); }},
      {"stop",
       [](Scene& scene) {
         scene.hinges[1].stop = Stop{100, 0.1, 0};
       }},
      {"far stop",
       [](Scene& scene) {
         scene.hinges[1].far_stop = Stop{100, 0.1, 0};
       }},
      {"hold",
       [](Scene& scene) {
         scene.hinges[1].hold = Hold{100, 1};
       }},
      {"joint",
       [](Scene& scene) {
         scene.hinges[1].joint = Joint{100, 1};
       }},
      {"loop", [](Scene& scene) { scene.synchronisations.emplace_back().damping = 1; }},
      {"bending", [](Scene& scene) { scene.bodies[1].flexible.emplace().damping_ratio = 0.01; }},
      {"air", [](Scene& scene) {
         scene.bodies[1].plate.emplace();
         scene.environment.air_density = 1.2;
       }}};
  for (const auto& [name, add] : parts) {
    CAPTURE(name);
    Scene scene = plain;
    add(scene);
    CHECK_THAT(outcome_text(scene, outcome), Catch::Contains(" J dissipated before"));
  }
}

TEST_CASE("a part that only stores energy leaves its change to the integration error") {
  const Scene plain = read_scene_file(three_panel_file());
  const Outcome outcome = first_second(plain);
  const std::vector<std::pair<const char*, void (*)(Scene&)>> parts{
      {"stops",
       [](Scene& scene) {
         scene.hinges[1].stop = scene.hinges[1].far_stop = Stop{100, 0, 0};
       }},
      {"joint",
       [](Scene& scene) {
         scene.hinges[1].joint = Joint{100, 0};
       }},
      {"loop", [](Scene& scene) { scene.synchronisations.emplace_back().stiffness = 100; }},
      {"bending", [](Scene& scene) { scene.bodies[1].flexible.emplace().frequency = 5; }},
      {"plate without air", [](Scene& scene) { scene.bodies[1].plate.emplace(); }},
      {"air without plate", [](Scene& scene) { scene.environment.air_density = 1.2; }},
      {"free base", [](Scene& scene) { scene.base.motion = BaseMotion::free; }}};
  for (const auto& [name, add] : parts) {
    CAPTURE(name);
    Scene scene = plain;
    add(scene);
    CHECK_THAT(outcome_text(scene, outcome), Catch::Contains(" J of integration error before"));
  }
}
