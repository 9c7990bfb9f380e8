#include "montecarlo/model/scene_file/describe_scene.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

std::string spoilt_hinge(const test::Spoiled& change) {
  return test::message_of([&] { return read_scene(test::spoil(test::real_scene(), change)); });
}

Hinge hinge_with(const char* pointer, const char* value) {
  return read_scene(test::spoil(test::real_scene(), {pointer, value, ""})).hinges[0];
}

} // namespace

TEST_CASE("What real hinges have is read", "[hinge_json]") {
  const Scene scene = read_scene(test::real_scene());
  const Hinge& root = scene.hinges[0];
  CHECK(root.friction.scale == 1.5);
  REQUIRE(root.damper);
  CHECK(root.damper->law == DamperLaw::power);
  CHECK(root.damper->coefficient == 3);
  CHECK(root.damper->exponent == 0.45);
  CHECK(root.damper->regularization_rate == 1e-5);
  CHECK(root.damper->window == std::array{1.0, 0.25});
  CHECK(root.damper->scale == 0.7);
  REQUIRE(root.stop);
  CHECK(root.stop->stiffness == 500);
  CHECK(root.stop->dissipation == 0.2);
  CHECK(root.stop->gap == 0.01);
  CHECK(root.latch->backlash == 0.002);
  REQUIRE(scene.hinges[1].damper);
  CHECK(scene.hinges[1].damper->law == DamperLaw::eddy_current);
  CHECK(scene.hinges[1].damper->peak_torque == 2);
  CHECK(scene.hinges[1].damper->peak_rate == 4);
  CHECK_FALSE(scene.hinges[1].damper->window);
  CHECK(scene.hinges[1].damper->scale == 1);
  CHECK_FALSE(scene.hinges[1].stop);
}

TEST_CASE("What a damper or a stop does not name has its default", "[hinge_json]") {
  const auto power =
      hinge_with("/hinges/0/damper", R"({"law": "power", "coefficient": 1, "exponent": 0.5})");
  CHECK(power.damper->regularization_rate == 1e-6);
  CHECK(hinge_with("/hinges/0/damper", R"({"law": "viscous", "coefficient": 2})")
            .damper->coefficient == 2);
  const auto stop = hinge_with("/hinges/0/stop", R"({"stiffness": 9})").stop;
  CHECK(stop->dissipation == 0);
  CHECK(stop->gap == 0);
}

TEST_CASE("Every dimensional number of a hinge may have its unit", "[hinge_json]") {
  Json document = test::real_scene();
  Json& hinge = document["hinges"][0];
  hinge["parent_point"] = {"350 mm", 0};
  hinge["angle"] = {{"stowed", "90 deg"}, {"latched", "0 deg"}};
  hinge["initial_rate"] = "-2 deg/s";
  hinge["friction"] = {{"coulomb", "1 in*lbf"}, {"viscous", "1 N*mm*s/rad"}};
  hinge["damper"] =
      parse_json(R"({"law": "power", "coefficient": "2 N*m*(s/rad)^0.45", "exponent": 0.45,
    "regularization_rate": "1 mrad/s", "window": ["90 deg", "1 mrad"]})");
  hinge["stop"] = {{"stiffness", "1 kN*m/rad"}, {"dissipation", "2 s/rad"}, {"gap", "5 mrad"}};
  hinge["latch"] = {{"stiffness", "1 N*mm/rad"}, {"damping", "1 N*m/rpm"}, {"backlash", "180 deg"}};
  const Hinge read = read_scene(document).hinges[0];
  CHECK(read.parent_point.x() == 0.35);
  CHECK(read.stowed == 1.5707963267948966);
  CHECK(read.initial_rate == -0.03490658503988659);
  CHECK(read.friction.coulomb == 0.1129848290276167);
  CHECK(read.friction.viscous == 0.001);
  CHECK(read.damper->coefficient == 2);
  CHECK(read.damper->regularization_rate == 0.001);
  CHECK(read.damper->window == std::array{1.5707963267948966, 0.001});
  CHECK(read.stop->stiffness == 1000);
  CHECK(read.stop->dissipation == 2);
  CHECK(read.stop->gap == 0.005);
  CHECK(read.latch->stiffness == 0.001);
  CHECK(read.latch->damping == Approx(60 / 6.283185307179586).epsilon(1e-15));
  CHECK(read.latch->backlash == 3.141592653589793);
}

TEST_CASE("Each fault of what acts across a hinge is told", "[hinge_json]") {
  const test::Spoiled change = GENERATE(values<test::Spoiled>(
      {{"/hinges/0/friction/scale", "-1", "/hinges/0/friction/scale: found -1, expected >= 0"},
       {"/hinges/0/friction/scale", "\"1 m\"",
        "/hinges/0/friction/scale: found string \"1 m\", expected a number, ≥ 0"},
       {"/hinges/0/damper", "3",
        "/hinges/0/damper: found 3, expected an object with the damper's law"},
       {"/hinges/0/damper/law", "",
        "/hinges/0/damper/law: found nothing, expected \"viscous\", \"power\" or \"eddy_current\""},
       {"/hinges/0/damper/law", "\"fluid\"",
        "/hinges/0/damper/law: found string \"fluid\", expected \"viscous\", \"power\" or "
        "\"eddy_current\""},
       {"/hinges/0/damper", R"({"law": "viscous", "coefficient": 1, "exponent": 2})",
        "/hinges/0/damper/exponent: found the unknown key \"exponent\", expected \"law\", "
        "\"coefficient\", \"window\" or \"scale\""},
       {"/hinges/0/damper", R"({"law": "viscous"})",
        "/hinges/0/damper/coefficient: found nothing, expected a number, N·m·s/rad, ≥ 0"},
       {"/hinges/0/damper/coefficient", "-3",
        "/hinges/0/damper/coefficient: found -3, expected >= 0"},
       {"/hinges/0/damper/coefficient", "\"3 N*m\"",
        "/hinges/0/damper/coefficient: found string \"3 N*m\", expected a number, "
        "N·m·(s/rad)^0.45, ≥ 0, or a string of a number and its unit: \"N·m·(s/rad)^0.45\", "
        "or another one made of deg, °, rev"},
       {"/hinges/0/damper/exponent", "0", "/hinges/0/damper/exponent: found 0, expected > 0"},
       {"/hinges/0/damper/exponent", "",
        "/hinges/0/damper/exponent: found nothing, expected a number, > 0"},
       {"/hinges/0/damper/regularization_rate", "0",
        "/hinges/0/damper/regularization_rate: found 0, expected > 0"},
       {"/hinges/0/damper/regularization_rate", "1e-200",
        "/hinges/0/damper/regularization_rate: found 1e-200, expected >= 1e-150"},
       {"/hinges/0/damper/window", "[1]",
        "/hinges/0/damper/window: found an array of 1, expected an array of 2 numbers, rad"},
       {"/hinges/0/damper/window", "[1, 1]",
        "/hinges/0/damper/window/1: found 1, expected different from damper.window.0"},
       {"/hinges/0/damper/scale", "-0.5", "/hinges/0/damper/scale: found -0.5, expected >= 0"},
       {"/hinges/1/damper/peak_torque", "-2",
        "/hinges/1/damper/peak_torque: found -2, expected >= 0"},
       {"/hinges/1/damper/peak_rate", "0", "/hinges/1/damper/peak_rate: found 0, expected > 0"},
       {"/hinges/1/damper/peak_rate", "",
        "/hinges/1/damper/peak_rate: found nothing, expected a number, rad/s, > 0"},
       {"/hinges/1/damper/coefficient", "1",
        "/hinges/1/damper/coefficient: found the unknown key \"coefficient\", expected \"law\", "
        "\"peak_torque\", \"peak_rate\", \"window\" or \"scale\""},
       {"/hinges/0/stop", "1",
        "/hinges/0/stop: found 1, expected an object with the stop's stiffness and dissipation"},
       {"/hinges/0/stop/stiffness", "",
        "/hinges/0/stop/stiffness: found nothing, expected a number, N·m/rad, ≥ 0"},
       {"/hinges/0/stop/stiffness", "-1", "/hinges/0/stop/stiffness: found -1, expected >= 0"},
       {"/hinges/0/stop/dissipation", "-1", "/hinges/0/stop/dissipation: found -1, expected >= 0"},
       {"/hinges/0/stop/gap", "-1", "/hinges/0/stop/gap: found -1, expected >= 0"},
       {"/hinges/0/stop/damping", "1",
        "/hinges/0/stop/damping: found the unknown key \"damping\", expected \"side\", "
        "\"stiffness\", "
        "\"dissipation\" or \"gap\""},
       {"/hinges/0/latch/backlash", "-1", "/hinges/0/latch/backlash: found -1, expected >= 0"},
       {"/hinges/0/latch/dissipation", "0.5",
        "/hinges/0/latch/damping: found 100, expected no damping beside \"dissipation\": a latch "
        "has one of the two"},
       {"/hinges/0/latch", R"({"stiffness": 1, "dissipation": -1})",
        "/hinges/0/latch/dissipation: found -1, expected >= 0"}}));
  CAPTURE(change.pointer, change.value);
  CHECK(test::facts_of(spoilt_hinge(change)) == test::facts_of(change.message));
}

TEST_CASE("What real hinges have is written in full", "[hinge_json]") {
  const Json written = write_scene(read_scene(test::real_scene()))["hinges"];
  CHECK(written[0]["friction"].dump() ==
        R"({"model":"regularized","coulomb":0.1,"viscous":0.01,"regularization_rate":0.002,)"
        R"("scale":1.5})");
  CHECK(written[0]["damper"].dump() ==
        R"({"law":"power","coefficient":3.0,"exponent":0.45,"regularization_rate":1e-05,)"
        R"("window":[1.0,0.25],"scale":0.7})");
  CHECK(written[0]["stop"].dump() == R"({"stiffness":500.0,"dissipation":0.2,"gap":0.01})");
  CHECK(written[0]["latch"].dump() == R"({"stiffness":10000.0,"damping":100.0,"backlash":0.002})");
  CHECK(written[1]["damper"].dump() ==
        R"({"law":"eddy_current","peak_torque":2.0,"peak_rate":4.0,"scale":1.0})");
}

TEST_CASE("A latch has a damping or a dissipation, as it is read, dispersed and written",
          "[hinge_json]") {
  Json document = test::real_scene();
  document["hinges"][0]["latch"] =
      parse_json(R"({"stiffness": 100, "dissipation": "0.5 s/rad", "backlash": 0.25})");
  Scene scene = read_scene(document);
  const Latch& latch = *scene.hinges[0].latch;
  CHECK((latch.dissipation == 0.5 && latch.damping == 0 && latch.backlash == 0.25));
  CHECK(write_scene(scene)["hinges"][0]["latch"].dump() ==
        R"({"stiffness":100.0,"dissipation":0.5,"backlash":0.25})");
  CHECK_THAT(describe(scene),
             Catch::Contains("latch 100 N·m/rad, dissipation 0.5 s/rad, backlash"));
  const ParameterMatches found = resolve(scene, "hinges.root.latch.dissipation");
  REQUIRE(found.matches.size() == 1);
  found.matches[0].parameter.in(scene) = 2;
  CHECK(scene.hinges[0].latch->dissipation == 2);
  CHECK(unit_of(found.matches[0].parameter) == "s/rad");
  CHECK(resolve(scene, "hinges.root.latch.damping").expected ==
        "a hinge whose latch has a damping");
  scene.hinges[0].latch->damping = 1;
  CHECK(unphysical(scene).at(0).path == "hinges.root.latch.damping");
}

namespace {

/// The real scene with its second hinge an elastic joint.
Json jointed_scene() {
  Json document = test::small_scene();
  Json& mid = document["hinges"][1];
  mid["angle"] = "10 deg";
  mid["joint"] = parse_json(R"({ "stiffness": "300 N*m/rad", "damping": 0.5 })");
  return document;
}

} // namespace

TEST_CASE("An elastic joint has one angle and no other law", "[hinge_json]") {
  const Scene scene = read_scene(jointed_scene());
  const Hinge& mid = scene.hinges[1];
  REQUIRE(mid.joint);
  CHECK(mid.joint->stiffness == 300);
  CHECK(mid.joint->damping == 0.5);
  CHECK(mid.stowed == mid.latched);
  CHECK(mid.stowed == Approx(0.17453292519943295));
  const Json written = write_scene(scene);
  CHECK(write_scene(read_scene(written)) == written);
  CHECK(written["hinges"][1].contains("joint"));
  CHECK_FALSE(written["hinges"][1].contains("spring"));
  CHECK_THAT(describe(scene), Catch::Contains("mid: inner to outer; elastic joint at"));
  CHECK(resolve(scene, "hinges.*.joint.stiffness").matches.size() == 1);
  CHECK(resolve(scene, "hinges.mid.angle").matches.size() == 1);
  CHECK(resolve(scene, "hinges.*.spring.scale").matches.size() == 1);
  CHECK(resolve(scene, "hinges.root.joint.damping").expected == "a hinge that is an elastic joint");
}

TEST_CASE("Stowed and latched angles of an elastic joint are refused for the joint",
          "[hinge_json]") {
  const Json two =
      test::spoil(jointed_scene(), {"/hinges/1/angle", R"({ "stowed": 1, "latched": 0 })", ""});
  CHECK_THAT(test::message_of([&] { return read_scene(two); }), Catch::Contains("elastic joint"));
}

TEST_CASE("What an elastic joint cannot have is refused", "[hinge_json]") {
  const auto [pointer, value, place] = GENERATE(values<test::Spoiled>({
      {"/hinges/1/spring", R"({ "torque_stowed": 1, "torque_latched": 1 })", "/hinges/1/spring"},
      {"/hinges/1/latch", R"({ "stiffness": 1, "damping": 1 })", "/hinges/1/latch"},
      {"/hinges/1/angle", R"({ "stowed": 1, "latched": 0 })", "/hinges/1/angle"},
      {"/hinges/1/angle", "", "/hinges/1/angle"},
      {"/hinges/1/joint/stiffness", "0", "/hinges/1/joint/stiffness"},
      {"/hinges/1/joint/damping", "-1", "/hinges/1/joint/damping"},
      {"/hinges/1/joint/stiffness", R"("3 N*m")", "/hinges/1/joint/stiffness"},
      {"/synchronisations",
       R"([{ "name": "loop", "between": ["root", "mid"], "ratio": 2, "stiffness": 300 }])",
       "/synchronisations/0/between/1"},
  }));
  CAPTURE(pointer, value);
  CHECK_THAT(test::message_of([&] {
               return read_scene(test::spoil(jointed_scene(), {pointer, value, ""}));
             }),
             Catch::StartsWith(std::string(place) + ": "));
}

TEST_CASE("A damper of any law keeps its window and its scale when its scene is written",
          "[hinge_json]") {
  for (const char* law : {R"({"law": "viscous", "coefficient": 3})",
                          R"({"law": "power", "coefficient": 3, "exponent": 0.5})",
                          R"({"law": "eddy_current", "peak_torque": 3, "peak_rate": 2})"})
    for (const char* key : {"", "window", "scale"}) {
      Json damper = parse_json(law);
      if (*key != '\0') damper[key] = key == std::string("window") ? Json({1.0, 0.25}) : Json(0.75);
      const Scene scene = read_scene(
          test::spoil(test::small_scene(), {"/hinges/0/damper", damper.dump().c_str(), ""}));
      const Json written = write_scene(scene);
      CAPTURE(damper.dump());
      for (const auto& [name, value] : damper.items())
        CHECK(written["hinges"][0]["damper"][name] == value);
      CHECK(written["hinges"][0]["damper"].contains("window") == damper.contains("window"));
      CHECK(write_scene(read_scene(written)) == written);
    }
}
