// Motors: read, written, refused, described and dispersed.
#include "montecarlo/model/scene_file/describe_scene.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace wingspread;

namespace {

constexpr const char* at = "/hinges/0/motor";
constexpr const char* steady = R"({"rate": "2 deg/s", "gain": "40 N*m*s/rad", "torque_limit": 5})";
constexpr const char* by_table =
    R"({"rate": {"table": {"time": [0, "500 ms", 2], "rate": [0, 0.1, "2 deg/s"]},
  "interpolation": "linear", "scale": 1.5}, "gain": 40, "torque_limit": 5})";

Json panel_with(const char* motor) {
  return test::spoil(parse_json_file(test::three_panel_file()), {at, motor, ""});
}

Motor motor_of(const char* text) { return *read_scene(panel_with(text)).hinges[0].motor; }

void check_refused(const char* motor, const std::string& place, const char* expected) {
  CAPTURE(motor);
  try {
    (void)read_scene(panel_with(motor));
    FAIL("no problem");
  } catch (const SpecError& error) {
    REQUIRE(error.problems().size() == 1);
    CHECK(error.problems().front().pointer == at + place);
    CAPTURE(error.problems().front().expected);
    CHECK(error.problems().front().expected.find(expected) != std::string::npos);
  }
}

} // namespace

TEST_CASE("A motor's rate is a number or a table of time since the release") {
  const Motor motor = motor_of(steady);
  CHECK(motor.rate == Approx(0.03490658503988659).epsilon(1e-15));
  CHECK(motor.gain == 40);
  CHECK(motor.torque_limit == 5);
  CHECK(!motor.table);
  const Motor table = motor_of(by_table);
  REQUIRE(table.table);
  CHECK(table.time == std::vector<double>{0, 0.5, 2});
  CHECK(table.table->value_at(0.25) == 0.05);
  CHECK(table.interpolation == Interpolation::linear);
  CHECK(table.scale == 1.5);
}

TEST_CASE("A motor is written as it is read") {
  for (const char* text : {steady, by_table}) {
    const Json written = write_scene(read_scene(panel_with(text)));
    CHECK(write_scene(read_scene(written)) == written);
    CHECK(written["hinges"][0].contains("motor"));
    CHECK(!written["hinges"][1].contains("motor"));
  }
}

TEST_CASE("Motors that cannot be meant are refused with their place") {
  check_refused(R"({"gain": 1, "torque_limit": 1})", "/rate", "table");
  check_refused(R"({"rate": 1, "torque_limit": 1})", "/gain", "N·m·s/rad");
  check_refused(R"({"rate": 1, "gain": 1})", "/torque_limit", "N·m");
  check_refused(R"({"rate": "2 deg", "gain": 1, "torque_limit": 1})", "/rate", "rad/s");
  check_refused(R"({"rate": 1, "gain": -1, "torque_limit": 1})", "/gain", "0");
  check_refused(R"({"rate": 1, "gain": 1, "torque_limit": -1})", "/torque_limit", "0");
  check_refused(R"({"rate": 1, "gain": 1, "torque_limit": 1, "stiffness": 3})", "/stiffness", "");
  check_refused(R"({"rate": {"scale": 2}, "gain": 1, "torque_limit": 1})", "/rate/table", "time");
  check_refused(
      R"({"rate": {"table": {"time": [0, 0], "rate": [1, 2]}}, "gain": 1, "torque_limit": 1})",
      "/rate/table/time/1", "more than");
  check_refused(
      R"({"rate": {"table": {"time": [0, 1], "rate": [1]}}, "gain": 1, "torque_limit": 1})",
      "/rate/table/rate", "2");
  check_refused(
      R"({"rate": {"table": {"time": [0, 1e-320], "rate": [0, 1]}}, "gain": 1, "torque_limit": 1})",
      "/rate/table", "further apart");
}

TEST_CASE("An elastic joint has no motor") {
  Json scene = panel_with(steady);
  Json& hinge = scene["hinges"][0];
  for (const char* key : {"spring", "harness", "friction", "latch"}) hinge.erase(key);
  hinge["angle"] = 0, hinge["joint"] = {{"stiffness", 100}};
  CHECK_THROWS_WITH(read_scene(scene), Catch::Contains("motor") && Catch::Contains("joint"));
}

TEST_CASE("Paths name a motor's numbers, and check describes it") {
  Scene scene = read_scene(panel_with(steady)), tabled = read_scene(panel_with(by_table));
  const auto has = [](const Scene& of, const char* path) {
    return std::ranges::count(parameter_paths(of), path) == 1;
  };
  for (const char* path : {"hinges.root.motor.gain", "hinges.root.motor.torque_limit"})
    CHECK((has(scene, path) && has(tabled, path)));
  CHECK((has(scene, "hinges.root.motor.rate") && !has(tabled, "hinges.root.motor.rate")));
  CHECK(
      (!has(scene, "hinges.root.motor.rate.scale") && has(tabled, "hinges.root.motor.rate.scale")));
  CHECK(resolve(tabled, "hinges.root.motor.rate").expected.find("rate.scale") != std::string::npos);
  resolve(scene, "hinges.root.motor.rate").matches.front().parameter.in(scene) = 0.2;
  CHECK(scene.hinges[0].motor->rate == 0.2);
  CHECK(describe(scene).find("; motor at 0.2 rad/s, 40 N·m·s/rad up to 5 N·m") !=
        std::string::npos);
  CHECK(
      describe(tabled).find("; motor by a table of 3 times from 0 to 2 s, linear, times 1.5, 40") !=
      std::string::npos);
}
