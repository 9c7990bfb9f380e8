#include "montecarlo/model/scene_file/describe_scene.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <numbers>
#include <regex>

using namespace wingspread;

TEST_CASE("A scene is described part by part", "[describe]") {
  CHECK(
      describe(read_scene(test::small_scene())) ==
      "scene small\n"
      "  base: fixed\n"
      "  2 bodies\n"
      "    inner: mass 10 kg, inertia 0.5 kg·m²\n"
      "    outer: mass 8 kg, inertia 0.25 kg·m²\n"
      "  2 hinges\n"
      "    root: base to inner, 85.94 to 0 deg, from -0.1 rad/s; spring 2 to 1.4 N·m; harness 0.1 "
      "to "
      "0.2 N·m; friction 0.1 N·m, 0.01 N·m·s/rad, regularized at 0.002 rad/s; latch 10000 N·m/rad, "
      "100 N·m·s/rad\n"
      "    mid: inner to outer, -171.9 to 0 deg; no latch\n");
}

TEST_CASE("A base is described by its motion, and friction by its model", "[describe]") {
  Json document = test::spoil(test::small_scene(),
                              {"/hinges/1/friction", R"({"model": "exact", "coulomb": 0.5})", ""});
  document["base"] = {{"motion", "free"}, {"mass", 100}, {"inertia", 20}};
  CHECK_THAT(
      describe(read_scene(document)),
      Catch::Contains("base: free, mass 100 kg, inertia 20 kg·m², position (0, 0) m, velocity "
                      "(0, 0) m/s, angle 0 deg, rate 0 rad/s\n") &&
          Catch::Contains("friction 0.5 N·m, 0 N·m·s/rad, exact, static 0.5 N·m; no latch"));
  document["base"] = {{"motion", "prescribed"}, {"rate", 0.5}};
  CHECK_THAT(describe(read_scene(document)),
             Catch::Contains("base: prescribed, acceleration (0, 0) m/s², angular acceleration 0 "
                             "rad/s², angle 0 deg, rate 0.5 rad/s\n"));
}

TEST_CASE("What real hinges have is described", "[describe]") {
  CHECK(
      describe(read_scene(test::real_scene())) ==
      "scene small\n"
      "  base: fixed\n"
      "  2 bodies\n"
      "    inner: mass 10 kg, inertia 0.5 kg·m²; plate from (-0.5, 0.01) to (0.5, 0.01) m, 2 m "
      "wide, drag coefficient 1.9\n"
      "    outer: mass 8 kg, inertia 0.25 kg·m²\n"
      "  2 hinges\n"
      "    root: base to inner, 85.94 to 0 deg, from -0.1 rad/s; spring measured both ways at 3 "
      "angles from 85.94 to 0 deg, linear, times 1.1, plus -0.05 N·m, its hysteresis as friction, "
      "times 1.5 (friction.scale); harness by a table at 4 angles from 91.67 to -5.73 deg, "
      "monotone, "
      "times 0.9; friction 0.1 N·m, 0.01 N·m·s/rad, "
      "regularized at 0.002 rad/s, times 1.5; damper 3 N·m·(s/rad)^0.45, linear below 1e-05 "
      "rad/s, times 0.7, between 57.3 and 14.32 deg; stop 500 N·m/rad, 0.2 s/rad, gap 0.573 deg; "
      "latch "
      "10000 N·m/rad, 100 N·m·s/rad, backlash 0.1146 deg in all (±0.0573)\n"
      "    mid: inner to outer, -171.9 to 0 deg; spring 1 to 0.5 N·m, plus 0.125 N·m; damper of "
      "eddy "
      "currents, 2 N·m at 4 rad/s; no latch\n"
      "  2 synchronisations\n"
      "    loop: root to mid, ratio 2; 300 N·m/rad, 0.5 N·m·s/rad, preload 8 N·m\n"
      "    cam: mid to root, by a table of 3 travels; 100 N·m/rad, 0 N·m·s/rad, never slack\n"
      "  gravity: (0.1, -9.81) m/s²\n"
      "  air: 1.2 kg/m³\n");
}

TEST_CASE("A torque is described unless it is 0 along the whole travel", "[describe]") {
  const std::string none = R"({"torque_stowed": 0, "torque_latched": 0})";
  for (const std::string torque : {"spring", "harness"}) {
    const auto told = [&](const std::string& law) {
      Json document = test::small_scene();
      document["hinges"][1][torque] = parse_json(law);
      const std::string text = describe(read_scene(document));
      const std::string line = text.substr(text.find("    mid:"));
      return line.find(torque + ' ') != std::string::npos;
    };
    CAPTURE(torque);
    CHECK_FALSE(told(none));
    CHECK(told(R"({"torque_stowed": 0.5, "torque_latched": 0})"));
    CHECK(told(R"({"torque_stowed": 0, "torque_latched": 0.5})"));
    CHECK(told(R"({"torque_stowed": 0, "torque_latched": 0, "offset": 0.5})"));
  }
}

TEST_CASE("No number of a description has the digits of a conversion, and rates are as written",
          "[describe]") {
  for (Scene scene : {read_scene(test::small_scene()), read_scene(test::real_scene())}) {
    for (const std::string& path : parameter_paths(scene))
      for (const ParameterMatch& match : resolve(scene, path).matches)
        match.parameter.in(scene) /= 0.9;
    const std::string text = describe(scene);
    CAPTURE(text);
    CHECK(text.find("1.11") != std::string::npos);
    CHECK_FALSE(std::regex_search(text, std::regex("[0-9.]{12}")));
  }
  Scene scene = read_scene(test::real_scene());
  const double degree = std::numbers::pi / 180;
  scene.base.motion = BaseMotion::free;
  scene.base.rate = 3 * degree;
  scene.hinges[0].initial_rate = -4 * degree;
  scene.hinges[0].friction.regularization_rate = degree;
  scene.hinges[1].damper->peak_rate = 20 * degree;
  const std::string text = describe(scene);
  for (const char* part :
       {", rate 3 deg/s", ", from -4 deg/s", "regularized at 1 deg/s", "2 N·m at 20 deg/s"})
    CHECK_THAT(text, Catch::Contains(part));
}

TEST_CASE("Friction is described unless all its levels are 0", "[describe]") {
  const auto told = [](const char* friction) {
    Json document = test::small_scene();
    document["hinges"][1]["friction"] = parse_json(friction);
    const std::string text = describe(read_scene(document));
    const std::string line = text.substr(text.find("    mid:"));
    const std::size_t from = line.find("friction");
    return from == line.npos ? "" : line.substr(from, line.find("; ", from) - from);
  };
  CHECK(told(R"({ "coulomb": 0, "viscous": 0, "regularization_rate": 0.002 })").empty());
  CHECK(told(R"({ "model": "exact", "coulomb": 0, "static": 0 })").empty());
  CHECK(told(R"({ "coulomb": 0.5, "viscous": 0, "regularization_rate": 0.25 })") ==
        "friction 0.5 N·m, 0 N·m·s/rad, regularized at 0.25 rad/s");
  CHECK(told(R"({ "coulomb": 0, "viscous": 0.125, "regularization_rate": 0.25 })") ==
        "friction 0 N·m, 0.125 N·m·s/rad, regularized at 0.25 rad/s");
  CHECK(told(R"({ "model": "exact", "coulomb": 0, "viscous": 0.125 })") ==
        "friction 0 N·m, 0.125 N·m·s/rad, exact, static 0 N·m");
  CHECK(told(R"({ "model": "exact", "coulomb": 0, "static": 0.75 })") ==
        "friction 0 N·m, 0 N·m·s/rad, exact, static 0.75 N·m");
}
