// Hinges without a latch whose springs pull them onto a stop: their rest lies beyond it.
#include "core/deployment.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// Two panels: the root bounces on its stop at the latched side, the tip latches.
Scene bouncing_wing(int seed, BaseMotion motion) {
  Draws draws(static_cast<std::uint64_t>(seed));
  Scene scene;
  scene.base.motion = motion;
  if (motion == BaseMotion::free) scene.base.mass = 500, scene.base.inertia = 200;
  if (motion != BaseMotion::fixed && draws.chance(0.5)) scene.base.rate = draws.uniform(-0.1, 0.1);
  scene.bodies = {{"p", 4, 1.2}, {"q", draws.uniform(3, 20), 7}};
  for (int i = 0; i < 2; ++i) {
    Hinge hinge;
    hinge.name = i == 0 ? "root" : "tip", hinge.parent = i - 1, hinge.child = i;
    if (i == 0) hinge.parent = base_index;
    hinge.parent_point = {0.5, 0}, hinge.child_point = {-1, 0};
    hinge.stowed = 0, hinge.latched = i == 0 ? 1.5 : 1.8, hinge.harness = {};
    scene.hinges.push_back(hinge);
  }
  const double torque = draws.uniform(1.5, 3);
  scene.hinges[0].spring = {torque, torque * draws.uniform(0.5, 0.9)};
  scene.hinges[0].far_stop = Stop{draws.log_uniform(100, 1000), 0, 0.1};
  scene.hinges[0].friction.viscous = 0.05;
  scene.hinges[1].spring = {1, 1}, scene.hinges[1].latch = Latch{300, 1.5};
  return scene;
}

} // namespace

TEST_CASE("no peak is final while a spring makes its hinge bounce on a stop") {
  const int seeds = random_cases(60, 6);
  int risen = 0;
  for (int seed = 1; seed <= seeds; ++seed)
    for (const BaseMotion motion : {BaseMotion::fixed, BaseMotion::free, BaseMotion::prescribed}) {
      const Scene scene = bouncing_wing(seed, motion);
      const Integration how = within(1e-8, 40);
      const Outcome out = Deployment().run(scene, how, {});
      const Outcome whole = Deployment().run(scene, how, {.to_t_end = true});
      CAPTURE(seed, static_cast<int>(motion), out.t_end, out.peaks_final);
      for (std::size_t i = 0; i < 2; ++i) {
        if (out.t_end == whole.t_end) continue;
        CHECK(out.peak_moment[i].value == Approx(whole.peak_moment[i].value).epsilon(1e-9));
        CHECK(out.peak_force[i].value == Approx(whole.peak_force[i].value).epsilon(1e-9));
      }
      risen += whole.peak_moment[0].time > 25;
    }
  CHECK(risen > 0); // late peaks, which an early end would lose
}
