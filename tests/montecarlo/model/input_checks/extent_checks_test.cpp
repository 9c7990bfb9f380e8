#include "montecarlo/model/input_checks/check_input.hpp"
#include "montecarlo/model/input_checks/extent_checks.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <functional>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// The pointers of the warnings of a small scene with a change; its first hinge turns from 1.5 to 0 rad.
std::vector<std::string> places(const std::function<void(Json&)>& change) {
  Json document = small_scene();
  change(document);
  InputWarnings warnings({"wing.json"});
  check_extents(read_scene(document), warnings);
  std::vector<std::string> found;
  for (const InputWarning& warning : warnings.list()) found.push_back(warning.pointer);
  return found;
}

using Places = std::vector<std::string>;

Json table(double from, double to) {
  return {{"table", {{"angle", {from, to}}, {"torque", {1.0, 1.0}}}}};
}

} // namespace

TEST_CASE("a table has to cover half of the travel, in either sense", "[warnings]") {
  for (const auto& [from, to, told] : {std::tuple{0.0, 1.5, false},
                                       {-1.0, 0.76, false},
                                       {0.74, 9.0, false},
                                       {0.8, 9.0, true},
                                       {0.2, 0.9, true},
                                       {2.0, 3.0, true}})
    for (const char* key : {"spring", "harness"}) {
      CAPTURE(from, to, key);
      const auto found = places([&](Json& scene) { scene["hinges"][0][key] = table(to, from); });
      CHECK(found == (told ? Places{std::string("/hinges/0/") + key + "/table/angle"} : Places{}));
    }
  const auto other_sense =
      places([](Json& scene) { scene["hinges"][1]["spring"] = table(-3, -1.6); });
  CHECK(other_sense == Places{"/hinges/1/spring/table/angle"});
  const auto enough = places([](Json& scene) { scene["hinges"][1]["spring"] = table(-3, -1.4); });
  CHECK(enough.empty());
}

TEST_CASE("a damper's window has to touch the travel", "[warnings]") {
  for (const auto& [from, to, told] :
       {std::tuple{1.0, 0.2, false}, {1.4, 3.0, false}, {1.6, 3.0, true}, {-0.1, -2.0, true}}) {
    CAPTURE(from, to);
    const auto found = places([&](Json& scene) {
      scene["hinges"][0]["damper"] = {
          {"law", "viscous"}, {"coefficient", 1}, {"window", {from, to}}};
    });
    CHECK(found == (told ? Places{"/hinges/0/damper/window"} : Places{}));
  }
}

TEST_CASE("rates, gravity and air that no wing has are told", "[warnings]") {
  const auto with_rate = [](double rate) {
    return places([=](Json& scene) { scene["hinges"][1]["initial_rate"] = rate; });
  };
  CHECK(with_rate(9.9).empty());
  CHECK(with_rate(-30) == Places{"/hinges/1/initial_rate"});
  const auto with_gravity = [](double g) {
    return places([=](Json& scene) { scene["environment"]["gravity"] = {0, -g}; });
  };
  CHECK(with_gravity(9.81).empty());
  CHECK(with_gravity(9810) == Places{"/environment/gravity"});
  const auto with_air = [](bool plate) {
    return places([=](Json& scene) {
      scene["environment"]["air_density"] = 1.2;
      if (plate)
        scene["bodies"][1]["plate"] = parse_json(
            R"({ "from": [-0.5, 0], "to": [0.5, 0], "width": 2, "drag_coefficient": 1.9 })");
    });
  };
  CHECK(with_air(true).empty());
  CHECK(with_air(false) == Places{"/environment/air_density"});
}

TEST_CASE("a latch that gives way to its spring is told", "[warnings]") {
  const auto with_stiffness = [](double k) { // of 1.4 N·m less 0.2 N·m
    return places([=](Json& scene) { scene["hinges"][0]["latch"]["stiffness"] = k; });
  };
  CHECK(with_stiffness(2.41).empty());
  CHECK(with_stiffness(2.39) == Places{"/hinges/0/latch/stiffness"});
  CHECK(with_stiffness(0).empty()); // that is told beside the torques
}

TEST_CASE("a nominal wing that arrives too fast is told", "[warnings]") {
  const auto told = [&](double rate) {
    Outcome nominal;
    nominal.latches = {{0, 1.0, {rate, 99}}};
    InputWarnings warnings({"wing.json"});
    check_arrival(nominal, warnings);
    return !warnings.list().empty() && warnings.list()[0].pointer == "/hinges/0/latch";
  };
  CHECK_FALSE(told(-19));
  CHECK(told(-21));
}

TEST_CASE("a mirrored copy's warning is its original's", "[warnings]") {
  Json document = small_scene();
  document["hinges"][1]["initial_rate"] = 30;
  for (Json& body : document["bodies"]) body["name"] = "R_" + body["name"].get<std::string>();
  for (Json& hinge : document["hinges"]) {
    hinge["name"] = "R_" + hinge["name"].get<std::string>();
    for (const char* end : {"parent", "child"})
      if (hinge[end] != "base") hinge[end] = "R_" + hinge[end].get<std::string>();
  }
  document["mirror"] = parse_json(R"({ "of": "R_*", "as": "L_*" })");
  const Folder folder;
  const std::string file = folder.write("wing.json", document.dump());
  const Scene scene = read_scene_file(file);
  REQUIRE(scene.hinges.size() == 4);
  long of_rate = 0;
  for (const InputWarning& warning : check_input(scene, Integration(), file)) {
    CHECK(warning.pointer.find("/hinges/2") == std::string::npos);
    CHECK(warning.pointer.find("/hinges/3") == std::string::npos);
    of_rate += warning.pointer == "/hinges/1/initial_rate";
  }
  CHECK(of_rate == 1);
}
