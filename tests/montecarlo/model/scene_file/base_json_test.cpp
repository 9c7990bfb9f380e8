// A base's table of time, from JSON and back. The rest of a base stands in scene_json_test.cpp.
#include "montecarlo/model/scene_file/base_json.hpp"
#include "montecarlo/model/scene_file/describe_scene.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

Json driven_scene() {
  return test::spoil(test::small_scene(), {"/base", R"({ "motion": "prescribed", "angle": 0.5,
    "table": { "time": [0, 1.5, 4], "acceleration": [[0, 1], [2, 3], [0, 0.5]],
               "rate": [0, 0.25, 0.125], "scale": 1.5 }, "interpolation": "linear" })",
                                           ""});
}

std::string spoilt_scene(const test::Spoiled& change) {
  return test::message_of([&] { return read_scene(test::spoil(driven_scene(), change)); });
}

} // namespace

TEST_CASE("A base's table of time is read, and written as it was given", "[base_json]") {
  const Scene scene = read_scene(driven_scene());
  REQUIRE(scene.base.table);
  const BaseTable& table = *scene.base.table;
  CHECK(table.columns().time == std::vector<double>{0, 1.5, 4});
  REQUIRE(table.columns().acceleration.size() == 3);
  CHECK(table.columns().acceleration[1] == Eigen::Vector2d(2, 3));
  CHECK(table.columns().rate == std::vector<double>{0, 0.25, 0.125});
  CHECK(table.columns().angular_acceleration.empty());
  CHECK(table.interpolation() == Interpolation::linear);
  CHECK(scene.base.table_scale == 1.5);
  CHECK(table.pieces()[2].turning[0] == -0.05);
  const Json written = write_scene(scene);
  CHECK(written["base"].dump() ==
        R"({"motion":"prescribed","table":{"time":[0.0,1.5,4.0],)"
        R"("acceleration":[[0.0,1.0],[2.0,3.0],[0.0,0.5]],"rate":[0.0,0.25,0.125],"scale":1.5},)"
        R"("interpolation":"linear","angle":0.5})");
  CHECK(write_scene(read_scene(written)) == written);
  for (const double scale : {-0.5, 0.0, 0.5, 1.0}) {
    Scene scaled = scene;
    scaled.base.table_scale = scale;
    CHECK(read_scene(write_scene(scaled)).base.table_scale == scale);
  }
}

TEST_CASE("What a base's table does not give stands beside it", "[base_json]") {
  const char* base = R"({ "motion": "prescribed", "acceleration": [1, 2], "rate": 0.1,
    "table": { "time": ["0 s", "1 min"], "angular_acceleration": [0, "90 deg/s^2"] } })";
  const Scene scene = read_scene(test::spoil(test::small_scene(), {"/base", base, ""}));
  CHECK(scene.base.acceleration == Eigen::Vector2d(1, 2));
  CHECK(scene.base.rate == 0.1);
  CHECK(scene.base.table->interpolation() == Interpolation::monotone);
  CHECK(scene.base.table->columns().time == std::vector<double>{0, 60});
  CHECK(scene.base.table->columns().angular_acceleration[1] == 1.5707963267948966);
  CHECK(write_scene(scene)["base"].dump() ==
        R"({"motion":"prescribed","acceleration":[1.0,2.0],)"
        R"("table":{"time":[0.0,60.0],"angular_acceleration":[0.0,1.5707963267948966]},)"
        R"("interpolation":"monotone","angle":0.0,"rate":0.1})");
}

TEST_CASE("Each fault of a base's table is told", "[base_json]") {
  const test::Spoiled change = GENERATE(values<test::Spoiled>(
      {{"/base/table", "[1]",
        "/base/table: found an array of 1, expected a table: an object with time and "
        "acceleration, angular_acceleration or rate"},
       {"/base/table", R"({"time": [0, 1]})",
        "/base/table: found an object, expected a table: an object with time and acceleration, "
        "angular_acceleration or rate"},
       {"/base/table/time", "",
        "/base/table/time: found nothing, expected an array of 2 to 1000 numbers, s"},
       {"/base/table/time", "[1]",
        "/base/table/time: found an array of 1, expected an array of 2 to 1000 numbers, s"},
       {"/base/table/time", "[0, 2, 2]",
        "/base/table/time/2: found 2, expected more than 2, the time before"},
       {"/base/table/time/1", "\"1 m\"",
        "/base/table/time/1: found string \"1 m\", expected a number, s, or a string of a number "
        "and its unit: \"s\", \"ms\", \"min\" or \"h\""},
       {"/base/table/rate", "[0, 1]",
        "/base/table/rate: found an array of 2, expected as many numbers as there are times: 3"},
       {"/base/table/acceleration", "[[0, 1], [2, 3]]",
        "/base/table/acceleration: found an array of 2, expected an array of 3 accelerations, as "
        "many as there are times: each an array of 2 numbers, m/s²"},
       {"/base/table/acceleration/1", "[2]",
        "/base/table/acceleration/1: found an array of 1, expected an array of 2 numbers, m/s²"},
       {"/base/table/angular_acceleration", "[0, 1, 2]",
        "/base/table/rate: found an array of 3, expected no rate beside angular_acceleration: it "
        "is its integral"},
       {"/base/table/scale", "\"1\"", "/base/table/scale: found string \"1\", expected a number"},
       {"/base/table/times", "1",
        "/base/table/times: found the unknown key \"times\", expected \"time\", \"acceleration\", "
        "\"angular_acceleration\", \"rate\" or \"scale\" (did you mean \"time\"?)"},
       {"/base/table/time/1", "1e-320",
        "/base/table: found a curve too steep for numbers, expected times further apart, or a "
        "smaller motion"},
       {"/base/acceleration", "[0, 0]",
        "/base/acceleration: found an array of 2, expected no acceleration beside a table of "
        "acceleration"},
       {"/base/rate", "0", "/base/rate: found 0, expected no rate beside a table of rate"},
       {"/base/angular_acceleration", "0",
        "/base/angular_acceleration: found 0, expected no angular_acceleration beside a table of "
        "rate"},
       {"/base/table", "",
        "/base/interpolation: found string \"linear\", expected no interpolation without a table"},
       {"/base/interpolation", "\"cubic\"",
        "/base/interpolation: found string \"cubic\", expected \"monotone\" or \"linear\""},
       {"/base/motion", "\"fixed\"",
        "/base/angle: found the unknown key \"angle\", expected \"motion\"\n"
        "/base/table: found the unknown key \"table\", expected \"motion\"\n"
        "/base/interpolation: found the unknown key \"interpolation\", expected \"motion\""}}));
  CAPTURE(change.pointer, change.value);
  CHECK(test::facts_of(spoilt_scene(change)) == test::facts_of(change.message));
}

TEST_CASE("A base's table is dispersed by its scale, and by no number that it gives",
          "[base_json]") {
  const Scene scene = read_scene(driven_scene());
  const ParameterMatches scale = resolve(scene, "base.table.scale");
  REQUIRE(scale.matches.size() == 1);
  CHECK(scale.matches[0].parameter.in(scene) == 1.5);
  for (const char* path : {"base.acceleration.0", "base.angular_acceleration"}) {
    CAPTURE(path);
    CHECK(resolve(scene, path).expected ==
          "a base whose motion is \"prescribed\", with no table of it (table.scale disperses one)");
  }
  CHECK(resolve(scene, "base.rate").expected ==
        "a base that is not fixed, with no table of its rate");
  CHECK(resolve(read_scene(test::small_scene()), "base.table.scale").expected ==
        "a base whose motion is prescribed by a table");
}

TEST_CASE("A base's table is described", "[base_json]") {
  CHECK_THAT(describe(read_scene(driven_scene())),
             Catch::Contains("base: prescribed, acceleration and rate by a table of 3 times from 0 "
                             "to 4 s, linear, times 1.5, angle 28.65 deg\n"));
  Json document = driven_scene();
  document["base"]["table"].erase("acceleration");
  document["base"]["table"].erase("scale");
  CHECK_THAT(describe(read_scene(document)),
             Catch::Contains("base: prescribed, acceleration (0, 0) m/s², rate by a table of 3 "
                             "times from 0 to 4 s, linear, angle 28.65 deg\n"));
  document["base"].erase("interpolation");
  document["base"]["table"].erase("rate");
  document["base"]["table"]["angular_acceleration"] = {0, 1, 0};
  CHECK_THAT(describe(read_scene(document)),
             Catch::Contains("acceleration (0, 0) m/s², angular acceleration by a table of 3 times "
                             "from 0 to 4 s, monotone, angle 28.65 deg, rate 0 rad/s\n"));
}
