#include "montecarlo/model/input_checks/life_checks.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace wingspread;

TEST_CASE("check says what an elastic hold that starts unstrained does to its moment",
          "[warnings]") {
  Scene scene = read_scene_file(test::three_panel_file());
  Hinge& root = scene.hinges[0];
  root.release.emplace().time = 1;
  const auto told = [&] {
    InputWarnings warnings(ScenePlace{"scene.json"});
    check_life(scene, Integration(), Outcome(), warnings);
    std::string text;
    for (const InputWarning& each : warnings.list())
      text += each.pointer + ": " + each.found + '\n';
    return text;
  };
  CHECK(told().empty()); // rigid
  root.hold = Hold{2000, 0};
  Goal goal;
  goal.to_t_end = true;
  Integration until_release;
  until_release.t_end = 0.9;
  Scene alone =
      scene; // the panels stay stowed, so that the hold rings about the root's spring alone
  for (Hinge& hinge : alone.hinges)
    if (&hinge != &alone.hinges[0]) hinge.release.emplace().time = 50;
  const double rung = Deployment().run(alone, until_release, goal).hold_moment[0].value;
  CHECK(rung == Approx(2 * root.spring.torque_stowed).epsilon(0.02));
  scene = alone;
  CHECK_THAT(told(), Catch::Contains("/hinges/0/hold: a hold that starts unstrained under 2 N·m") &&
                         Catch::Contains("root.hold_moment is up to twice that, 4 N·m"));
  for (Hinge& hinge : scene.hinges) hinge.spring = hinge.harness = {};
  CHECK(told().find("/hold") == std::string::npos); // nothing to bear
}

TEST_CASE("a release is warned of if its time and delay together reach t_end", "[warnings]") {
  Scene scene = read_scene_file(test::three_panel_file());
  Integration integration;
  integration.t_end = 10;
  for (const auto& [time, delay, late] : {std::tuple{9.5, 0.0, false},
                                          {9.5, 0.4, false},
                                          {9.5, 0.5, true},
                                          {2.0, 8.5, true},
                                          {10.0, 0.0, true}}) {
    CAPTURE(time, delay);
    Release& release = scene.hinges[1].release.emplace();
    release.time = time, release.delay = delay;
    InputWarnings warnings(ScenePlace{"scene.json"});
    check_life(scene, integration, Outcome(), warnings);
    REQUIRE(std::ssize(warnings.list()) == (late ? 1 : 0));
    if (late) CHECK(warnings.list().front().pointer == "/hinges/1/release/time");
  }
}

TEST_CASE("holds wait for themselves where no elastic one lets its hinge pass the angle",
          "[warnings]") {
  Scene scene = read_scene_file(test::three_panel_file());
  Release& first = scene.hinges[0].release.emplace();
  first.after = 1, first.event = Release::Event::passed, first.angle = 0.02;
  Release& second = scene.hinges[1].release.emplace();
  second.after = 0, second.event = Release::Event::latched;
  const auto cycles = [&] {
    InputWarnings warnings(ScenePlace{"scene.json"});
    check_life(scene, Integration(), Outcome(), warnings);
    return std::ranges::count_if(warnings.list(), [](const InputWarning& each) {
      return each.found.find("waits for itself") != std::string::npos;
    });
  };
  CHECK(cycles() == 2);
  scene.hinges[0].hold = Hold{3, 0}; // mid is held rigidly
  CHECK(cycles() == 2);
  scene.hinges[1].hold = Hold{3, 0};
  CHECK(cycles() == 0);
}

TEST_CASE("a hold waits for itself through a loop that ties the awaited hinge to it",
          "[warnings]") {
  Scene scene = read_scene_file(test::three_panel_file());
  Release& release = scene.hinges[2].release.emplace();
  release.after = 0, release.event = Release::Event::latched;
  Synchronisation loop;
  loop.name = "L1", loop.first = 2, loop.second = 0, loop.stiffness = 200;
  scene.synchronisations = {loop};
  Outcome nominal;
  const auto told = [&] {
    InputWarnings warnings(ScenePlace{"scene.json"});
    check_life(scene, Integration(), nominal, warnings);
    std::string found;
    for (const InputWarning& each : warnings.list())
      if (each.found.find("through a loop") != std::string::npos) found += to_string(each) + "\n";
    return found;
  };
  CHECK(told().empty()); // the nominal wing is released
  nominal.may_release_later = {2};
  CHECK_THAT(told(), Catch::Contains("/hinges/2/release/after") &&
                         Catch::Contains("tip waits for root, which L1 ties to tip"));
  scene.synchronisations[0].first = 0, scene.synchronisations[0].second = 2;
  CHECK_FALSE(told().empty());
  scene.synchronisations[0].second = 1; // another hinge, which is free
  CHECK(told().empty());
  Release& second = scene.hinges[1].release.emplace(); // … and now waits for the first
  second.after = 2, second.event = Release::Event::released;
  CHECK_THAT(told(),
             Catch::Contains("tip waits for root, which L1 ties to mid, mid waits for tip"));
  second.after = -1, second.event = Release::Event::time, second.time = 3;
  CHECK(told().empty());
  scene.synchronisations[0].second = 2;
  scene.hinges[2].hold = Hold{50, 0}; // an elastic hold lets the loop move
  CHECK(told().empty());
}

TEST_CASE("a hinge that latches before its elastic hold lets go is told", "[warnings]") {
  Scene scene = read_scene_file(test::three_panel_file());
  scene.hinges[1].release.emplace().time = 5;
  scene.hinges[1].hold = Hold{2000, 0};
  const auto told = [&](double latched, double released, std::vector<int> never = {}) {
    Outcome nominal;
    nominal.never_released = std::move(never);
    if (latched > 0) nominal.latches = {{1, latched, {0, 0, 0}}};
    if (released > 0) nominal.releases = {{1, released, 0}};
    InputWarnings warnings(ScenePlace{"scene.json"});
    check_life(scene, Integration(), nominal, warnings);
    return std::ranges::find(warnings.list(), "/hinges/1/hold/stiffness", &InputWarning::pointer) !=
           warnings.list().end();
  };
  CHECK(told(4, 5));
  CHECK(told(4, -1, {1}));
  CHECK_FALSE(told(4, -1, {0}));
  CHECK_FALSE(told(4, -1)); // its release was due at the start: it held nothing
  CHECK_FALSE(told(6, 5));
  CHECK_FALSE(told(-1, 5));
  scene.hinges[1].hold.reset();
  CHECK_FALSE(told(4, 5));
}
