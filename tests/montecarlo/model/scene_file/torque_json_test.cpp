#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

std::string spoilt_torque(const test::Spoiled& change) {
  return test::message_of([&] { return read_scene(test::spoil(test::real_scene(), change)); });
}

const std::vector<double> stowed_to_latched{1.5, 0.8, 0};

} // namespace

TEST_CASE("A torque test both ways is read with its scale and offset", "[torque_json]") {
  const HingeTorque spring = read_scene(test::real_scene()).hinges[0].spring;
  REQUIRE(spring.table);
  CHECK(spring.table->angle() == stowed_to_latched);
  CHECK(spring.table->deploying() == std::vector<double>{1.9, 1.5, 1.2});
  CHECK(spring.table->stowing() == std::vector<double>{2.1, 1.9, 1.5});
  CHECK(spring.table->interpolation() == Interpolation::linear);
  CHECK(spring.scale == 1.1);
  CHECK(spring.offset == -0.05);
}

TEST_CASE("A table is read, monotone where it does not say", "[torque_json]") {
  const HingeTorque harness = read_scene(test::real_scene()).hinges[0].harness;
  REQUIRE(harness.table);
  CHECK_FALSE(harness.table->both_ways());
  CHECK(harness.table->angle() == std::vector<double>{1.6, 1, 0.2, -0.1});
  CHECK(harness.table->deploying() == std::vector<double>{0.1, 0.3, 0.2, 0.2});
  CHECK(harness.table->interpolation() == Interpolation::monotone);
  CHECK(harness.scale == 0.9);
  CHECK(harness.offset == 0);
}

TEST_CASE("Numbers of a table may have units of their own", "[torque_json]") {
  const Scene scene = read_scene(test::spoil(
      test::real_scene(), {"/hinges/1/spring", R"({ "table": { "angle": ["-180 deg", "-90 deg", 0],
                                           "torque": ["100 N*mm", "12 in*lbf", "0 N*m"] } })",
                           ""}));
  const TorqueTable& table = *scene.hinges[1].spring.table;
  CHECK(table.angle() == std::vector<double>{-3.141592653589793, -1.5707963267948966, 0});
  CHECK(table.deploying() == std::vector<double>{0.1, 1.3558179483314004, 0});
}

TEST_CASE("Each fault of a torque is told with place, found and expected", "[torque_json]") {
  const test::Spoiled change = GENERATE(values<test::Spoiled>(
      {{"/hinges/0/spring", "2",
        "/hinges/0/spring: found 2, expected an object with torque_stowed and torque_latched, a "
        "table, or a torque test"},
       {"/hinges/0/harness", "[]",
        "/hinges/0/harness: found an array of 0, expected an object with torque_stowed and "
        "torque_latched, or a table"},
       {"/hinges/0/spring", R"({"scale": 2})",
        "/hinges/0/spring/torque_stowed: found nothing, expected a number, N·m\n"
        "/hinges/0/spring/torque_latched: found nothing, expected a number, N·m"},
       {"/hinges/0/spring/torque_stowed", "2",
        "/hinges/0/spring/torque_stowed: found 2, expected no torque_stowed beside a torque test"},
       {"/hinges/0/harness/torque_latched", "3",
        "/hinges/0/harness/torque_latched: found 3, expected no torque_latched beside a table"},
       {"/hinges/0/spring/table", R"({"angle": [1.5, 0], "torque": [1, 1]})",
        "/hinges/0/spring/measured: found an object, expected no measured beside a table"},
       {"/hinges/0/harness/measured", "{}",
        "/hinges/0/harness/measured: found the unknown key \"measured\", expected "
        "\"torque_stowed\", \"torque_latched\", \"table\", \"interpolation\", \"scale\" or "
        "\"offset\""},
       {"/hinges/1/spring/interpolation", "\"linear\"",
        "/hinges/1/spring/interpolation: found string \"linear\", expected no interpolation "
        "without a table"},
       {"/hinges/0/spring/interpolation", "\"cubic\"",
        "/hinges/0/spring/interpolation: found string \"cubic\", expected \"monotone\" or "
        "\"linear\""},
       {"/hinges/0/spring/scale", "\"1\"",
        "/hinges/0/spring/scale: found string \"1\", expected a number"},
       {"/hinges/0/spring/offset", "null",
        "/hinges/0/spring/offset: found null, expected a number, N·m"},
       {"/hinges/0/harness/table", "[1, 2]",
        "/hinges/0/harness/table: found an array of 2, expected a table: an object with angle and "
        "torque, unless \"interpolation\" is \"linear\""},
       {"/hinges/0/harness/table/angle", "",
        "/hinges/0/harness/table/angle: found nothing, expected an array of 2 to 1000 numbers, "
        "rad"},
       {"/hinges/0/harness/table/torque", "",
        "/hinges/0/harness/table/torque: found nothing, expected an array of 2 to 1000 numbers, "
        "N·m"},
       {"/hinges/0/harness/table/torques", "[1]",
        "/hinges/0/harness/table/torques: found the unknown key \"torques\", expected \"angle\" or "
        "\"torque\" (did you mean \"torque\"?)"},
       {"/hinges/0/harness/table/angle", "[1.5]",
        "/hinges/0/harness/table/angle: found an array of 1, expected an array of 2 to 1000 "
        "numbers, rad"},
       {"/hinges/0/harness/table/angle/1", "\"1 m\"",
        "/hinges/0/harness/table/angle/1: found string \"1 m\", expected a number, rad, or a "
        "string of a number and its unit: \"rad\", \"mrad\", \"deg\", \"°\" or \"rev\""},
       {"/hinges/0/harness/table/torque", "[1, 2, 3]",
        "/hinges/0/harness/table/torque: found an array of 3, expected as many numbers as there "
        "are angles: 4"},
       {"/hinges/0/harness/table/angle", "[1.6, 1, 1, -0.1]",
        "/hinges/0/harness/table/angle/2: found 1, expected less than 1, the angle before: from "
        "stowed towards latched"},
       {"/hinges/0/harness/table/angle", "[-0.1, 0.2, 1, 1.6]",
        "/hinges/0/harness/table/angle/1: found 0.2, expected less than -0.1, the angle before: "
        "from stowed towards latched"},
       {"/hinges/1/spring", R"({"table": {"angle": [0, -3], "torque": [1, 2]}})",
        "/hinges/1/spring/table/angle/1: found -3, expected more than 0, the angle before: from "
        "stowed towards latched"},
       {"/hinges/0/harness/table", R"({"angle": [1e-320, 0], "torque": [1, 2]})",
        "/hinges/0/harness/table: found a curve too steep for numbers, expected angles further "
        "apart, or smaller torques"},
       {"/hinges/0/spring/measured", "7",
        "/hinges/0/spring/measured: found 7, expected a torque test: an object with angle, "
        "deploying and stowing (½ (stowing − deploying) is friction: friction.scale scales it, not "
        "the spring's scale)"},
       {"/hinges/0/spring/measured/stowing", "",
        "/hinges/0/spring/measured/stowing: found nothing, expected an array of 2 to 1000 numbers, "
        "N·m"},
       {"/hinges/0/spring/measured/stowing/1", "1.4",
        "/hinges/0/spring/measured/stowing/1: found 1.4, expected ≥ 1.5, the deploying torque at "
        "that angle"},
       {"/hinges/0/spring",
        R"({"measured": {"angle": [1.5, 1, 0.5, 0], "deploying": [0, 0, 1, 1], "stowing": [3, 0, 1, 9]}})",
        "/hinges/0/spring/measured: found a stowing curve that falls below the deploying one "
        "between 0.5 and 1 rad, expected one that nowhere does: more knots there, or "
        "\"interpolation\": \"linear\""}}));
  CAPTURE(change.pointer, change.value);
  CHECK(test::facts_of(spoilt_torque(change)) == test::facts_of(change.message));
}

TEST_CASE("Angles of a table run either way where the hinge's are not known", "[torque_json]") {
  CHECK(spoilt_torque({"/hinges/0/angle/latched", "null", ""}) ==
        "/hinges/0/angle/latched: found null, expected a number, rad, different from stowed");
}

TEST_CASE("A table has at most 1000 knots", "[torque_json]") {
  const auto table = [](int knots) {
    Json document = test::real_scene();
    Json& harness = document["hinges"][0]["harness"]["table"];
    harness["angle"] = harness["torque"] = Json::array();
    for (int i = 0; i < knots; ++i) {
      harness["angle"].push_back(-i);
      harness["torque"].push_back(1);
    }
    return test::message_of([&] { return read_scene(document); });
  };
  CHECK(table(1000).empty());
  CHECK(table(1001) ==
        "/hinges/0/harness/table/angle: found an array of 1001, expected an array of 2 "
        "to 1000 numbers, rad");
}

TEST_CASE("A torque is written as it was given", "[torque_json]") {
  const Json written = write_scene(read_scene(test::real_scene()))["hinges"];
  CHECK(written[0]["spring"].dump() ==
        R"({"measured":{"angle":[1.5,0.8,0.0],"deploying":[1.9,1.5,1.2],"stowing":[2.1,1.9,1.5]},)"
        R"("interpolation":"linear","scale":1.1,"offset":-0.05})");
  CHECK(written[0]["harness"].dump() ==
        R"({"table":{"angle":[1.6,1.0,0.2,-0.1],"torque":[0.1,0.3,0.2,0.2]},)"
        R"("interpolation":"monotone","scale":0.9})");
  CHECK(written[1]["spring"].dump() ==
        R"({"torque_stowed":1.0,"torque_latched":0.5,"offset":0.125})");
}

TEST_CASE("A table beside an angle that is missing is not held against a sense that nobody gave",
          "[torque_json]") {
  Json document = test::real_scene(); // it goes down, and would go up to an angle of 0
  Json& hinge = document["hinges"][1];
  hinge["spring"] = parse_json(R"({ "table": { "angle": [-3, -4, -5], "torque": [2, 1.5, 1] } })");
  hinge["angle"]["latched"] = -5;
  CHECK(test::message_of([&] { return read_scene(document); }).empty());
  for (const char* missing : {"stowed", "latched"}) {
    Json spoilt = document;
    spoilt["hinges"][1]["angle"].erase(missing);
    const std::string message = test::message_of([&] { return read_scene(spoilt); });
    CAPTURE(message);
    CHECK(message.starts_with(std::string("/hinges/1/angle/") + missing + ": "));
    CHECK(message.find('\n') == std::string::npos);
  }
}
