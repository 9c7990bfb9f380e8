// Holds, latches that may miss or let go, and stops at both sides: read, written and refused.
#include "montecarlo/model/scene_file/describe_scene.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

Json panel_with(const char* pointer, const char* value) {
  return test::spoil(parse_json_file(test::three_panel_file()), {pointer, value, ""});
}

Scene life_with(const char* pointer, const char* value) {
  return read_scene(panel_with(pointer, value));
}

/// "POINTER: found …, expected …" of the only problem.
Problem problem_with(const char* pointer, const char* value) {
  try {
    (void)life_with(pointer, value);
  } catch (const SpecError& error) {
    REQUIRE(error.problems().size() == 1);
    return error.problems().front();
  }
  FAIL("no problem");
  return {};
}

void check_refused(const char* pointer, const char* value, const char* at, const char* expected) {
  const Problem problem = problem_with(pointer, value);
  CAPTURE(pointer, value, problem.expected);
  CHECK(problem.pointer == at);
  CHECK(problem.expected.find(expected) != std::string::npos);
}

} // namespace

TEST_CASE("A release at a time, or after an event of another hinge") {
  const Hinge timed =
      life_with("/hinges/2/release", R"({"time": "500 ms", "delay": 2, "fails": 1})").hinges[2];
  REQUIRE(timed.release);
  CHECK(timed.release->event == Release::Event::time);
  CHECK(timed.release->time == 0.5);
  CHECK(timed.release->delay == 2);
  CHECK(timed.release->fails == 1);
  const auto read = [](const char* event) {
    const std::string text = std::string(R"({"after": "root", "event": )") + event + "}";
    return *life_with("/hinges/2/release", text.c_str()).hinges[2].release;
  };
  CHECK(read("\"latched\"").event == Release::Event::latched);
  CHECK(read("\"latched\"").after == 0);
  CHECK(read("\"latched\"").delay == 0);
  CHECK(read(R"({"angle": "45 deg"})").event == Release::Event::passed);
  CHECK(read(R"({"angle": "45 deg"})").angle == 0.7853981633974483);
}

TEST_CASE("Releases that cannot be meant are refused with their place") {
  const char* at = "/hinges/2/release";
  check_refused(at, R"({"delay": 1})", "/hinges/2/release/time", "after");
  check_refused(at, R"({"after": "root"})", "/hinges/2/release/event", "latched");
  check_refused(at, R"({"after": "rot", "event": "latched"})", "/hinges/2/release/after", "root");
  check_refused(at, R"({"after": "tip", "event": "latched"})", "/hinges/2/release/after",
                "another hinge");
  check_refused(at, R"({"after": "root", "event": "released"})", "/hinges/2/release/after",
                "has a release");
  check_refused(at, R"({"after": "root", "event": "opened"})", "/hinges/2/release/event",
                "released");
  check_refused(at, R"({"after": "root", "event": {"angle": -1}})", "/hinges/2/release/event/angle",
                "> 0");
  check_refused(at, R"({"time": -1})", "/hinges/2/release/time", ">= 0");
  check_refused(at, R"({"time": 1, "fails": 0.5})", "/hinges/2/release/fails", "0 or 1");
  Json moving = panel_with(at, R"({"time": 1})");
  moving["hinges"][2]["initial_rate"] = 0.1;
  CHECK_THROWS_AS(read_scene(moving), SpecError);
}

TEST_CASE("A stop at the stowed side, at the latched side, or at both") {
  const char* at = "/hinges/1/stop";
  const Hinge far =
      life_with(at, R"({"side": "latched", "stiffness": 9, "gap": "1 mrad"})").hinges[1];
  CHECK_FALSE(far.stop);
  REQUIRE(far.far_stop);
  CHECK(far.far_stop->gap == 0.001);
  const char* two = R"([{"side": "latched", "stiffness": 9}, {"side": "stowed", "stiffness": 8}])";
  const Scene both = life_with(at, two);
  CHECK(both.hinges[1].stop->stiffness == 8);
  CHECK(both.hinges[1].far_stop->stiffness == 9);
  check_refused(at, R"([{"stiffness": 9}, {"stiffness": 9}])", "/hinges/1/stop/1", "each side");
  check_refused(at, "[]", at, "two");
  check_refused(at, R"([{"stiffness": 9}, {"side": "latched", "stiffness": 9, "gap": -1}])",
                "/hinges/1/stop/1/gap", ">= 0");
  check_refused(at, R"({"stiffness": -1})", "/hinges/1/stop/stiffness", ">= 0");
}

TEST_CASE("A written life is read back the same") {
  Json document =
      panel_with("/hinges/1/stop",
                 R"([{"side": "latched", "stiffness": 9, "dissipation": 0.1, "gap": 0.2},
                                 {"side": "stowed", "stiffness": 8}])");
  document["hinges"][0]["release"] = parse_json(R"({"time": 0.5})");
  document["hinges"][1]["release"] =
      parse_json(R"({"after": "root", "event": {"angle": 0.7}, "delay": 0.2})");
  document["hinges"][2]["release"] =
      parse_json(R"({"after": "mid", "event": "released", "fails": 1})");
  document["hinges"][2]["latch"]["capture_rate"] = "60 deg/s";
  document["hinges"][2]["latch"]["holding_moment"] = "12 N*m";
  document["hinges"][2]["stop"] = parse_json(R"({"side": "latched", "stiffness": 9})");
  const Scene scene = read_scene(document);
  const Json written = write_scene(scene);
  CHECK(written == write_scene(read_scene(written)));
  CHECK(scene.hinges[2].latch->holding_moment == 12);
  CHECK(scene.hinges[2].latch->capture_rate.value() == Approx(1.0471975511965976).epsilon(1e-15));
  const std::string text = describe(scene);
  for (const char* words :
       {"held until 0.5 s", "held until 0.2 s after root has turned by 40.11 deg",
        "held until mid is released, but never released (fails)", "engages up to 60 deg/s",
        "lets go of a load towards stowed from 12 N·m on",
        "stop beyond the latched angle 9 N·m/rad"})
    CHECK(text.find(words) != std::string::npos);
  Scene changed = scene;
  for (const char* path :
       {"hinges.root.release.time", "hinges.mid.release.event.angle", "hinges.mid.release.delay",
        "hinges.tip.release.fails", "hinges.tip.latch.capture_rate",
        "hinges.tip.latch.holding_moment", "hinges.mid.far_stop.stiffness",
        "hinges.mid.far_stop.dissipation", "hinges.mid.far_stop.gap"}) {
    const ParameterMatches found = resolve(scene, path);
    CAPTURE(path);
    REQUIRE(found.matches.size() == 1);
    found.matches[0].parameter.in(changed) += 0.5;
    CHECK(write_scene(changed) != written);
    found.matches[0].parameter.in(changed) -= 0.5;
  }
  for (const char* path : {"hinges.mid.release.time", "hinges.root.release.event.angle",
                           "hinges.root.latch.capture_rate", "hinges.root.far_stop.gap"})
    CHECK(resolve(scene, path).matches.empty());
}

TEST_CASE("A hold cannot wait for the angle of an elastic joint") {
  Json document = test::small_scene();
  Json& root = document["hinges"][0];
  root = {{"name", "root"},
          {"parent", "base"},
          {"child", root["child"]},
          {"parent_point", {0, 0}},
          {"child_point", {-0.5, 0}},
          {"angle", 0},
          {"joint", {{"stiffness", 100}, {"damping", 1}}}};
  document["hinges"][1]["release"] = parse_json(R"({"after": "root", "event": {"angle": 0.1}})");
  CHECK_THROWS_WITH(read_scene(document),
                    Catch::Contains("/hinges/1/release/after") && Catch::Contains("travels"));
}

TEST_CASE("a stop of a wrong type and one out of range are both told, each with its place") {
  for (const char* odd : {R"({"side": 5, "stiffness": 7})", "5", "null", R"("x")"})
    for (const char* side : {"stowed", "latched"}) {
      const Json document = panel_with(
          "/hinges/1/stop",
          (std::string("[") + odd + R"(, {"side": ")" + side + R"(", "stiffness": -1}])").c_str());
      const std::string message = test::message_of([&] { return read_scene(document); });
      CAPTURE(odd, side, message);
      CHECK_THAT(message, Catch::Contains("/hinges/1/stop/0"));
      CHECK(message.find("json.exception") == std::string::npos);
    }
}
