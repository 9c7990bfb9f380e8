// Holds that let go at one instant: those of mirrored wings, and those that wait for one hinge.
#include "core/deployment.hpp"
#include "tests/support/closed_forms.hpp"
#include "tests/support/similar_scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace wingspread;
using namespace wingspread::oracle;

namespace {

/// The hinge that carries the body on which hinge h hangs.
int inner_hinge_of(const Scene& scene, int h) {
  const auto carries = [&](const Hinge& hinge) { return hinge.child == scene.hinges[h].parent; };
  return static_cast<int>(std::ranges::find_if(scene.hinges, carries) - scene.hinges.begin());
}

/// The mirrored wings of symmetric_tree(): each outer hinge is held until the inner one's travel is this share of its
/// whole.
Scene mirrored_holds(double share) {
  Scene scene = symmetric_tree();
  for (int h = 0; h < std::ssize(scene.hinges); ++h) {
    if (scene.hinges[h].parent == base_index) continue;
    const int inner = inner_hinge_of(scene, h);
    const double travel = std::abs(scene.hinges[inner].latched - scene.hinges[inner].stowed);
    scene.hinges[h].release =
        Release{.event = Release::Event::passed, .after = inner, .angle = share * travel};
  }
  return scene;
}

} // namespace

TEST_CASE("holds of mirrored wings that see the same angle let go at one instant, in any unit of "
          "time") {
  for (int k = 0; k < 24; ++k) {
    const double share = 0.11 + 0.03 * k;
    const Scene scene = mirrored_holds(share);
    for (const double time : {0x1p-14, 1.0, 0x1p14}) {
      Integration how = within(1e-8, 15 * time);
      how.atol *= std::max(1 / time, 1e-3);
      const Outcome out = Deployment().run(in_units(scene, {.time = time}), how, latches_only);
      CAPTURE(share, time, out.reason);
      REQUIRE(out.releases.size() == 2);
      CHECK(out.releases[0].time == out.releases[1].time);
    }
  }
}

TEST_CASE("all holds that wait for one hinge's angle let go as it passes, and no other") {
  const double acceleration = 2 / panel_inertia; // of the panel, from rest
  Draws draws(3);
  for (int k = 0; k < 20; ++k) {
    Scene scene = latching_panel();
    scene.hinges[0].latch.reset();
    // three panels without springs beside the one that moves
    const double angle = draws.uniform(0.05, 1.4), other = draws.uniform(0.05, 1.4);
    for (int panel = 1; panel <= 3; ++panel) {
      scene.bodies.push_back(scene.bodies[0]);
      Hinge hinge = scene.hinges[0];
      hinge.child = panel, hinge.spring = {};
      scene.bodies[panel].name += std::to_string(panel), hinge.name += std::to_string(panel);
      hinge.release =
          Release{.event = Release::Event::passed, .after = 0, .angle = panel == 3 ? other : angle};
      scene.hinges.push_back(hinge);
    }
    const Outcome out = Deployment().run(scene, within(1e-10, 2.5), latches_only);
    REQUIRE(out.releases.size() == 3);
    for (const HingeEvent& release : out.releases) {
      const double way = release.hinge == 3 ? other : angle;
      CAPTURE(k, release.hinge, way);
      CHECK(release.time == Approx(std::sqrt(2 * way / acceleration)).epsilon(1e-9));
    }
    const auto time_of = [&](int hinge) {
      return std::ranges::find(out.releases, hinge, &HingeEvent::hinge)->time;
    };
    CHECK(time_of(1) == time_of(2));
  }
}

TEST_CASE(
    "every hold that fails is named; one that waits for a held hinge is not, unless it fails too") {
  Scene scene = latching_panel();
  for (int panel = 1; panel <= 2; ++panel) { // beside each other
    scene.bodies.push_back(scene.bodies[0]);
    Hinge hinge = scene.hinges[0];
    hinge.child = panel;
    scene.bodies[panel].name += std::to_string(panel), hinge.name += std::to_string(panel);
    hinge.release = Release{.event = Release::Event::released, .after = panel - 1};
    scene.hinges.push_back(hinge);
  }
  scene.hinges[0].release = Release{.time = 1};
  const auto named = [&](bool first, bool second, bool third) {
    scene.hinges[0].release->fails = first, scene.hinges[1].release->fails = second;
    scene.hinges[2].release->fails = third;
    return Deployment().run(scene, within(1e-8, 30), latches_only).never_released;
  };
  using Hinges = std::vector<int>;
  CHECK(named(false, false, false).empty());
  CHECK(named(true, false, false) == Hinges{0});
  CHECK(named(true, true, false) == Hinges{0, 1});
  CHECK(named(true, false, true) == Hinges{0, 2});
  CHECK(named(false, true, false) == Hinges{1});
  CHECK(named(false, true, true) == Hinges{1, 2});
  CHECK(named(false, false, true) == Hinges{2});
}

TEST_CASE("a hold lets go its delay after its event: a time, the start, or another's release") {
  Scene scene = latching_panel();
  scene.bodies.push_back(scene.bodies[0]);
  Hinge other = scene.hinges[0];
  scene.bodies[1].name = "other", other.name = "other", other.child = 1; // beside the first
  other.release = Release{.event = Release::Event::released, .after = 0, .delay = 0.5};
  scene.hinges.push_back(other);
  const auto times = [&] {
    std::vector<double> of_hinge(2, 0);
    for (const HingeEvent& event : Deployment().run(scene, within(1e-8, 30), latches_only).releases)
      of_hinge[event.hinge] = event.time;
    return of_hinge;
  };
  using Times = std::vector<double>;
  scene.hinges[0].release = Release{};
  CHECK(times() == Times{0, 0.5}); // the first is let go at the start
  scene.hinges[0].release = Release{.time = 0.5, .delay = 0.25};
  CHECK(times() == Times{0.75, 1.25});
  scene.hinges[0].release = Release{.time = 0, .delay = 0.25};
  CHECK(times() == Times{0.25, 0.75});
}
