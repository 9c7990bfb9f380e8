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

TEST_CASE("numbers of bodies and of the base that no wing has are told", "[warnings]") {
  const auto with_plate = [](double drag, double damping) {
    return places([=](Json& scene) {
      scene["bodies"][1]["plate"] = {
          {"from", {-0.5, 0}}, {"to", {0.5, 0}}, {"width", 2}, {"drag_coefficient", drag}};
      scene["bodies"][1]["flexible"] = {
          {"joints", 2}, {"frequency", 5}, {"damping_ratio", damping}};
    });
  };
  CHECK(with_plate(2, 0.02).empty());
  CHECK(with_plate(130, 0.02) == Places{"/bodies/1/plate/drag_coefficient"});
  CHECK(with_plate(2, 2) == Places{"/bodies/1/flexible/damping_ratio"});
  const auto in_air = [](double density) {
    return places([=](Json& scene) {
      scene["environment"]["air_density"] = density;
      scene["bodies"][1]["plate"] = {
          {"from", {-0.5, 0}}, {"to", {0.5, 0}}, {"width", 2}, {"drag_coefficient", 2}};
    });
  };
  CHECK(in_air(1.3).empty());
  CHECK(in_air(1180) == Places{"/environment/air_density"});
  const auto on_base = [](const char* key, const Json& value) {
    return places([&](Json& scene) { scene["base"] = {{"motion", "prescribed"}, {key, value}}; });
  };
  CHECK(on_base("rate", 6).empty());
  CHECK(on_base("rate", -180) == Places{"/base/rate"});
  CHECK(on_base("acceleration", {0, -20}).empty());
  CHECK(on_base("acceleration", {0, -50}) == Places{"/base/acceleration"});
  const auto by_table = [&](double scale, double rate, double push) {
    return on_base("table", {{"time", {0, 1}},
                             {"rate", {0, rate}},
                             {"acceleration", {{0, 0}, {push, 0}}},
                             {"scale", scale}});
  };
  CHECK(by_table(1, 6, 20).empty());
  CHECK(by_table(-2, 6, 10) == Places{"/base/table/rate"});
  CHECK(by_table(2, 1, 20) == Places{"/base/table/acceleration"});
}

TEST_CASE("numbers of latches, stops, dampers and loops that no wing has are told", "[warnings]") {
  const auto with = [](const char* part, const Json& value) {
    return places([&](Json& scene) { scene["hinges"][0][part] = value; });
  };
  const auto latch = [&](const char* key, double value) {
    Json json{{"stiffness", 1e4}, {key, value}};
    if (!json.contains("dissipation")) json["damping"] = 100;
    return with("latch", json);
  };
  CHECK(latch("capture_rate", 19).empty());
  CHECK(latch("capture_rate", 40) == Places{"/hinges/0/latch/capture_rate"});
  CHECK(latch("dissipation", 2).empty());
  CHECK(latch("dissipation", 1e4) == Places{"/hinges/0/latch/dissipation"});
  const auto eddy = [&](double rate) {
    return with("damper", {{"law", "eddy_current"}, {"peak_torque", 2}, {"peak_rate", rate}});
  };
  CHECK(eddy(4).empty());
  CHECK(eddy(120) == Places{"/hinges/0/damper/peak_rate"});
  const auto stop_in_backlash = [](double gap) {
    return places([=](Json& scene) {
      scene["hinges"][0]["latch"]["backlash"] = 0.05;
      scene["hinges"][0]["stop"] = {{"side", "latched"}, {"stiffness", 100}, {"gap", gap}};
    });
  };
  CHECK(stop_in_backlash(0.026).empty());
  CHECK(stop_in_backlash(0.009) == Places{"/hinges/0/stop"});
  const auto loop = [](double stiffness, double damping) {
    return places([=](Json& scene) {
      scene["synchronisations"] = Json::array({{{"name", "loop"},
                                                {"between", {"root", "mid"}},
                                                {"ratio", 2},
                                                {"stiffness", stiffness},
                                                {"damping", damping}}});
    });
  };
  CHECK(loop(100, 0).empty());
  CHECK(loop(0, 1) == Places{"/synchronisations/0/stiffness"});
  CHECK(loop(0, 0) == Places{"/synchronisations/0/stiffness"});
  const auto friction = [&](const Json& value) { return with("friction", value); };
  CHECK(friction({{"model", "exact"}, {"coulomb", 0.1}}).empty());
  CHECK(friction({{"coulomb", 0.1}, {"regularization_rate", 2e-3}}).empty());
  CHECK(friction({{"model", "exact"}, {"coulomb", 0.1}, {"regularization_rate", 2e-3}}) ==
        Places{"/hinges/0/friction/regularization_rate"});
}

TEST_CASE("a latch that gives way to its spring is told", "[warnings]") {
  const auto with_stiffness = [](double k) { // of 1.4 N·m less 0.2 N·m
    return places([=](Json& scene) { scene["hinges"][0]["latch"]["stiffness"] = k; });
  };
  CHECK(with_stiffness(2.41).empty());
  CHECK(with_stiffness(2.39) == Places{"/hinges/0/latch/stiffness"});
  CHECK(with_stiffness(0).empty()); // that is told beside the torques
}

TEST_CASE("a nominal wing that arrives too fast, or too slowly for its friction, is told",
          "[warnings]") {
  const auto told = [&](double rate, const std::function<void(Scene&)>& change = {}) {
    Scene scene = read_scene(small_scene());
    if (change) change(scene);
    Outcome nominal;
    nominal.latches = {{0, 1.0, {rate, 99}}};
    InputWarnings warnings({"wing.json"});
    check_arrival(scene, nominal, warnings);
    return warnings.list().empty() ? std::string() : warnings.list()[0].pointer;
  };
  CHECK(told(-19).empty());
  CHECK(told(-21) == "/hinges/0/latch");
  const std::string slip = "/hinges/0/friction/regularization_rate"; // 0.002 rad/s
  CHECK(told(-0.0041).empty());
  CHECK(told(-0.0039) == slip);
  CHECK(told(-0.0039, [](Scene& scene) { scene.hinges[0].friction.coulomb = 0; }).empty());
  CHECK(told(-0.0039, [](Scene& scene) {
          scene.hinges[0].friction.model = FrictionModel::exact;
        }).empty());
}
