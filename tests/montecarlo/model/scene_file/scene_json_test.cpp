#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

std::string spoilt_small_scene(const test::Spoiled& change) {
  return test::message_of([&] { return read_scene(test::spoil(test::small_scene(), change)); });
}

} // namespace

TEST_CASE("A scene is read with all of its parameters", "[scene_json]") {
  const Scene scene = read_scene(test::small_scene());
  CHECK(scene.name == "small");
  CHECK(scene.base.motion == BaseMotion::fixed);
  REQUIRE(scene.bodies.size() == 2);
  CHECK(scene.bodies[1].name == "outer");
  CHECK(scene.bodies[1].mass == 8);
  CHECK(scene.bodies[1].inertia == 0.25);
  REQUIRE(scene.hinges.size() == 2);
  const Hinge& root = scene.hinges[0];
  CHECK(root.name == "root");
  CHECK(root.parent == base_index);
  CHECK(root.child == 0);
  CHECK(root.parent_point == Eigen::Vector2d(0, 0));
  CHECK(root.child_point == Eigen::Vector2d(-0.5, 0.02));
  CHECK(root.stowed == 1.5);
  CHECK(root.latched == 0);
  CHECK(root.initial_rate == -0.1);
  CHECK(root.spring.torque_stowed == 2);
  CHECK(root.spring.torque_latched == 1.4);
  CHECK(root.harness.torque_stowed == 0.1);
  CHECK(root.harness.torque_latched == 0.2);
  CHECK(root.friction.coulomb == 0.1);
  CHECK(root.friction.viscous == 0.01);
  CHECK(root.friction.regularization_rate == 0.002);
  REQUIRE(root.latch);
  CHECK(root.latch->stiffness == 10000);
  CHECK(root.latch->damping == 100);
}

TEST_CASE("What a hinge does not name is zero, and it never latches", "[scene_json]") {
  const Hinge mid = read_scene(test::small_scene()).hinges[1];
  CHECK(mid.parent == 0);
  CHECK(mid.child == 1);
  CHECK(mid.initial_rate == 0);
  CHECK(mid.spring.torque_stowed == 0);
  CHECK(mid.harness.torque_latched == 0);
  CHECK(mid.friction.coulomb == 0);
  CHECK(mid.friction.viscous == 0);
  CHECK(mid.friction.regularization_rate == 1e-3);
  CHECK(mid.friction.model == FrictionModel::regularized);
  CHECK_FALSE(mid.friction.static_level);
  CHECK_FALSE(mid.latch);
}

TEST_CASE("The base takes the keys of its motion", "[scene_json]") {
  const auto read_base = [](const char* base) {
    return read_scene(test::spoil(test::small_scene(), {"/base", base, ""})).base;
  };
  const Base prescribed = read_base(R"({"motion": "prescribed", "acceleration": [1, 2],
    "angular_acceleration": 3, "angle": 4, "rate": 5})");
  CHECK(prescribed.motion == BaseMotion::prescribed);
  CHECK(prescribed.acceleration == Eigen::Vector2d(1, 2));
  CHECK(prescribed.angular_acceleration == 3);
  CHECK(prescribed.angle == 4);
  CHECK(prescribed.rate == 5);
  const Base free = read_base(R"({"motion": "free", "mass": 1, "inertia": 2, "position": [3, 4],
    "velocity": [5, 6], "angle": 7, "rate": 8})");
  CHECK(free.motion == BaseMotion::free);
  CHECK(free.mass == 1);
  CHECK(free.inertia == 2);
  CHECK(free.position == Eigen::Vector2d(3, 4));
  CHECK(free.velocity == Eigen::Vector2d(5, 6));
  CHECK(free.angle == 7);
  CHECK(free.rate == 8);
  CHECK_NOTHROW(read_base(R"({"motion": "prescribed"})"));
  CHECK_NOTHROW(read_base(R"({"motion": "free", "mass": 1, "inertia": 2})"));
}

TEST_CASE("Each fault of a scene is told with place, found and expected", "[scene_json]") {
  const test::Spoiled change = GENERATE(values<test::Spoiled>(
      {{"", "[]", "found an array of 0, expected a scene: an object"},
       {"/name", "",
        "/name: found nothing, expected a string, the scene's name, not empty, without control "
        "characters"},
       {"/name", "\"\"",
        "/name: found string \"\", expected a string, the scene's name, not empty, without control "
        "characters"},
       {"/name", R"("a\u001b[31mb")",
        "/name: found string \"a\\u001b[31mb\", expected a string, the scene's name, not empty, "
        "without control "
        "characters"},
       {"/bodies/0/name", R"("a\u009bb")",
        "/bodies/0/name: found string \"a\xC2\x9B"
        "b\", expected a name, not empty, without . * / , \" > and control characters\n"
        "/hinges/0/child: found string \"inner\", expected a body's name\n"
        "/hinges/1/parent: found string \"inner\", expected \"base\" or a body's name"},
       {"/hinge", "1",
        "/hinge: found the unknown key \"hinge\", expected \"name\", \"base\", \"bodies\", "
        "\"hinges\", \"synchronisations\", \"environment\", \"mirror\" or \"$schema\" (did you "
        "mean "
        "\"hinges\"?)"},
       {"/base", "", "/base: found nothing, expected an object with the base's motion"},
       {"/base", "\"fixed\"",
        "/base: found string \"fixed\", expected an object with the base's motion"},
       {"/base/motion", "",
        "/base/motion: found nothing, expected \"fixed\", \"prescribed\" or \"free\""},
       {"/base/motion", "\"fixd\"",
        "/base/motion: found string \"fixd\", expected \"fixed\", \"prescribed\" or \"free\" (did "
        "you mean \"fixed\"?)"},
       {"/base/mass", "5", "/base/mass: found the unknown key \"mass\", expected \"motion\""},
       {"/base", R"({"motion": "free", "inertia": -2})",
        "/base/mass: found nothing, expected a number, kg, > 0\n"
        "/base/inertia: found -2, expected > 0"},
       {"/base", R"({"motion": "free", "mass": 1, "inertia": 2, "acceleration": [0, 0]})",
        "/base/acceleration: found the unknown key \"acceleration\", expected \"motion\", "
        "\"mass\", "
        "\"inertia\", \"position\", \"velocity\", \"angle\" or \"rate\""},
       {"/base", R"({"motion": "prescribed", "acceleration": [0]})",
        "/base/acceleration: found an array of 1, expected an array of 2 numbers, m/s²"},
       {"/bodies", "", "/bodies: found nothing, expected an array of at least one body"},
       {"/bodies", "[]", "/bodies: found an array of 0, expected an array of at least one body"},
       {"/hinges", "{}", "/hinges: found an object, expected an array of at least one hinge"},
       {"/bodies/0/mass", "\"10\"",
        "/bodies/0/mass: found string \"10\", expected a number, kg, > 0, or a string of a number "
        "and its unit: \"kg\", \"g\", \"lb\", \"lbm\" or \"slug\""},
       {"/bodies/0/mass", "0", "/bodies/0/mass: found 0, expected > 0"},
       {"/bodies/0/inertia", "", "/bodies/0/inertia: found nothing, expected a number, kg·m², > 0"},
       {"/bodies/0/lenght", "1",
        "/bodies/0/lenght: found the unknown key \"lenght\", expected \"name\", "
        "\"mass\", \"inertia\", \"plate\" or \"flexible\""},
       {"/hinges/0/child_point", "[1, null]",
        "/hinges/0/child_point/1: found null, expected a number, m"},
       {"/hinges/1/parent_point", "",
        "/hinges/1/parent_point: found nothing, expected an array of 2 numbers, m"},
       {"/hinges/0/angle", "",
        "/hinges/0/angle: found nothing, expected an object with the stowed and the latched angle"},
       {"/hinges/1/angle/stowed", "",
        "/hinges/1/angle/stowed: found nothing, expected a number, rad"},
       {"/hinges/1/angle/stowed", "0",
        "/hinges/1/angle/latched: found 0, expected different from angle.stowed"},
       {"/hinges/0/initial_rate", "true",
        "/hinges/0/initial_rate: found true, expected a number, rad/s"},
       {"/hinges/0/spring", "2",
        "/hinges/0/spring: found 2, expected an object with torque_stowed and torque_latched, a "
        "table, or a torque test"},
       {"/hinges/0/spring/torque_latched", "",
        "/hinges/0/spring/torque_latched: found nothing, expected a number, N·m"},
       {"/hinges/0/harness/torque_stow", "1",
        "/hinges/0/harness/torque_stow: found the unknown key \"torque_stow\", expected "
        "\"torque_stowed\", \"torque_latched\", \"table\", \"interpolation\", \"scale\" or "
        "\"offset\" (did you mean \"torque_stowed\"?)"},
       {"/hinges/0/friction", "0.1",
        "/hinges/0/friction: found 0.1, expected an object with the friction's parameters"},
       {"/hinges/0/friction/coulomb", "-0.1",
        "/hinges/0/friction/coulomb: found -0.1, expected >= 0"},
       {"/hinges/0/friction/regularization_rate", "0",
        "/hinges/0/friction/regularization_rate: found 0, expected > 0"},
       {"/hinges/0/friction/model", "\"dry\"",
        "/hinges/0/friction/model: found string \"dry\", expected \"regularized\" or \"exact\""},
       {"/hinges/0/friction/static", "0.2",
        "/hinges/0/friction/static: found 0.2, expected no static level with the regularized model "
        "(\"model\": \"exact\" has one)"},
       {"/hinges/0/friction", R"({"model": "dry", "static": 0.25})",
        "/hinges/0/friction/model: found string \"dry\", expected \"regularized\" or \"exact\""},
       {"/hinges/0/friction", R"({"model": "exact", "coulomb": 0.5, "static": 0.25})",
        "/hinges/0/friction/static: found 0.25, expected >= friction.coulomb"},
       {"/hinges/0/latch", "true",
        "/hinges/0/latch: found true, expected an object with the latch's stiffness, and its "
        "damping or "
        "dissipation"},
       {"/hinges/0/latch/damping", "",
        "/hinges/0/latch/damping: found nothing, expected a number, N·m·s/rad, ≥ 0, or "
        "\"dissipation\" in its place"},
       {"/hinges/0/latch/stiffness", "-1", "/hinges/0/latch/stiffness: found -1, expected >= 0"}}));
  CAPTURE(change.pointer, change.value);
  CHECK(test::facts_of(spoilt_small_scene(change)) == test::facts_of(change.message));
}

TEST_CASE("All faults of a scene are told together, under the name of its file", "[scene_json]") {
  Json document = test::small_scene();
  document["bodies"][1]["mass"] = -1;
  document["hinges"][0]["parent"] = "outr";
  document["hinges"][0].erase("angle");
  CHECK(
      test::message_of([&] { return read_scene(document, "s.json"); }) ==
      "s.json: /hinges/0/angle: found nothing, expected an object with the stowed and the latched "
      "angle\n"
      "s.json: /bodies/1/mass: found -1, expected > 0\n"
      "s.json: /hinges/0/parent: found string \"outr\", expected \"base\" or a body's name (did "
      "you "
      "mean \"outer\"?)");
}

TEST_CASE("A scene that is written reads back to itself, for every motion", "[scene_json]") {
  const char* base =
      GENERATE(R"({"motion": "fixed"})",
               R"({"motion": "prescribed", "acceleration": [0.1, -0.3], "rate": 1e-9})",
               R"({"motion": "free", "mass": 333.3, "inertia": 0.1, "angle": 2})");
  const char* friction = GENERATE(R"({"coulomb": 0.3})", R"({"model": "exact", "static": 0.7})");
  Json document = test::spoil(test::small_scene(), {"/base", base, ""});
  document = test::spoil(document, {"/hinges/1/friction", friction, ""});
  const Json written = write_scene(read_scene(document));
  CHECK(write_scene(read_scene(written)) == written);
  CHECK(written["bodies"] == document["bodies"]);
  const std::string stated = written.dump(); // every number that the document has, to the last bit
  for (const Json& hinge : document["hinges"].flatten())
    CHECK(stated.find(hinge.dump()) != std::string::npos);
}

TEST_CASE("A written scene states every default", "[scene_json]") {
  CHECK(write_scene(read_scene(test::small_scene()))["hinges"][1].dump() ==
        R"({"name":"mid","parent":"inner","child":"outer","parent_point":[0.5,-0.02],)"
        R"("child_point":[-0.5,-0.02],"angle":{"stowed":-3.0,"latched":0.0},"initial_rate":0.0,)"
        R"("spring":{"torque_stowed":0.0,"torque_latched":0.0},)"
        R"("harness":{"torque_stowed":0.0,"torque_latched":0.0},)"
        R"("friction":{"model":"regularized","coulomb":0.0,"viscous":0.0,)"
        R"("regularization_rate":0.001}})");
  const Json exact =
      test::spoil(test::small_scene(), {"/hinges/1/friction", R"({"model": "exact"})", ""});
  CHECK(write_scene(read_scene(exact))["hinges"][1]["friction"].dump() ==
        R"({"model":"exact","coulomb":0.0,"viscous":0.0})");
  const Json free = test::spoil(test::small_scene(),
                                {"/base", R"({"motion": "free", "mass": 1, "inertia": 2})", ""});
  CHECK(write_scene(read_scene(free))["base"].dump() ==
        R"({"motion":"free","mass":1.0,"inertia":2.0,"position":[0.0,0.0],"velocity":[0.0,0.0],)"
        R"("angle":0.0,"rate":0.0})");
}

TEST_CASE("Plates and surroundings are read, and written where there are any", "[scene_json]") {
  const Scene scene = read_scene(test::real_scene());
  REQUIRE(scene.bodies[0].plate);
  CHECK(scene.bodies[0].plate->from == Eigen::Vector2d(-0.5, 0.01));
  CHECK(scene.bodies[0].plate->to == Eigen::Vector2d(0.5, 0.01));
  CHECK(scene.bodies[0].plate->width == 2);
  CHECK(scene.bodies[0].plate->drag_coefficient == 1.9);
  CHECK_FALSE(scene.bodies[1].plate);
  CHECK(scene.environment.gravity == Eigen::Vector2d(0.1, -9.81));
  CHECK(scene.environment.air_density == 1.2);
  const Json written = write_scene(scene);
  CHECK(written["bodies"][0]["plate"].dump() ==
        R"({"from":[-0.5,0.01],"to":[0.5,0.01],"width":2.0,"drag_coefficient":1.9})");
  CHECK(written["environment"].dump() == R"({"gravity":[0.1,-9.81],"air_density":1.2})");
  CHECK_FALSE(write_scene(read_scene(test::small_scene())).contains("environment"));
}

TEST_CASE("A scene of real hinges that is written reads back to itself", "[scene_json]") {
  const Json written = write_scene(read_scene(test::real_scene()));
  CHECK(write_scene(read_scene(written)) == written);
  const Json before = test::real_scene();
  for (const char* key : {"bodies", "synchronisations", "environment"})
    for (const Json& value : before[key].flatten()) // every number and word, to the last bit
      CHECK(written[key].dump().find(value.dump()) != std::string::npos);
}

TEST_CASE("Numbers of bodies, base and surroundings may have their units", "[scene_json]") {
  Json document = test::real_scene();
  document["bodies"][0]["mass"] = "10 lb";
  document["bodies"][0]["inertia"] = "1e6 kg*mm^2";
  document["bodies"][0]["plate"]["width"] = "6 ft";
  document["environment"] = {{"gravity", {0, "-1 g"}}, {"air_density", "1200 g/m^3"}};
  document["base"] = parse_json(R"({"motion": "free", "mass": "1 kg", "inertia": "2 kg*m^2",
    "position": ["1 in", 0], "velocity": [0, "1 mm/s"], "angle": "90 deg", "rate": "60 rpm"})");
  const Scene scene = read_scene(document);
  CHECK(scene.bodies[0].mass == 4.5359237);
  CHECK(scene.bodies[0].inertia == 1);
  CHECK(scene.bodies[0].plate->width == 1.8288);
  CHECK(scene.environment.gravity.y() == -9.80665);
  CHECK(scene.environment.air_density == 1.2);
  CHECK(scene.base.position.x() == 0.0254);
  CHECK(scene.base.velocity.y() == 0.001);
  CHECK(scene.base.angle == 1.5707963267948966);
  CHECK(scene.base.rate == 6.283185307179586);
  CHECK(write_scene(scene)["bodies"][0]["mass"] == 4.5359237); // SI in what is written
}

TEST_CASE("Each fault of plates and surroundings is told", "[scene_json]") {
  const test::Spoiled change = GENERATE(values<test::Spoiled>(
      {{"/environment", "3",
        "/environment: found 3, expected an object with gravity and air_density"},
       {"/environment/gravity", "9.81",
        "/environment/gravity: found 9.81, expected an array of 2 numbers, m/s²"},
       {"/environment/gravity/0", "\"1 m\"",
        "/environment/gravity/0: found string \"1 m\", expected a number, m/s², or a string of a "
        "number and its unit: \"m/s^2\", \"g\", \"in/s^2\" or \"ft/s^2\""},
       {"/environment/air_density", "-1", "/environment/air_density: found -1, expected >= 0"},
       {"/environment/air", "1",
        "/environment/air: found the unknown key \"air\", expected \"gravity\" or "
        "\"air_density\""},
       {"/bodies/0/plate", "2",
        "/bodies/0/plate: found 2, expected an object with the plate's edges, width and "
        "drag_coefficient"},
       {"/bodies/0/plate/from", "",
        "/bodies/0/plate/from: found nothing, expected an array of 2 numbers, m"},
       {"/bodies/0/plate/to", "[-0.5, 0.01]",
        "/bodies/0/plate/to: found an array of 2, expected another point than plate.from"},
       {"/bodies/0/plate/width", "-1", "/bodies/0/plate/width: found -1, expected >= 0"},
       {"/bodies/0/plate/drag_coefficient", "-1",
        "/bodies/0/plate/drag_coefficient: found -1, expected >= 0"},
       {"/bodies/0/plate/drag", "1",
        "/bodies/0/plate/drag: found the unknown key \"drag\", expected \"from\", \"to\", "
        "\"width\" or \"drag_coefficient\""}}));
  CAPTURE(change.pointer, change.value);
  CHECK(test::facts_of(test::message_of([&] {
          return read_scene(test::spoil(test::real_scene(), change));
        })) == test::facts_of(change.message));
}

namespace {

Json bending_scene() {
  Json document = test::real_scene();
  document["bodies"][0]["inertia"] = 0.9; // of a rod of 1 m and 10 kg: 0.83
  document["bodies"][0]["flexible"] =
      parse_json(R"({ "joints": 4, "bending_stiffness": "200 N*m^2", "damping_ratio": 0.01 })");
  return document;
}

} // namespace

TEST_CASE("A flexible body is read, written and described", "[scene_json]") {
  const Scene scene = read_scene(bending_scene());
  REQUIRE(scene.bodies[0].flexible);
  CHECK(scene.bodies[0].flexible->joints == 4);
  CHECK(scene.bodies[0].flexible->bending_stiffness == 200);
  CHECK_FALSE(scene.bodies[0].flexible->frequency);
  CHECK(scene.bodies[0].flexible->damping_ratio == 0.01);
  const Json written = write_scene(scene);
  CHECK(write_scene(read_scene(written)) == written);
  Json other = bending_scene();
  other["bodies"][0]["flexible"] =
      parse_json(R"({ "joints": 4, "frequency": "8000 mHz", "damping_ratio": 0 })");
  CHECK(read_scene(other).bodies[0].flexible->frequency == 8);
  CHECK(write_scene(read_scene(other))["bodies"][0]["flexible"]["frequency"] == 8);
}

TEST_CASE("What a flexible body cannot have is refused at its place", "[scene_json]") {
  const auto [pointer, value, place] = GENERATE(values<test::Spoiled>({
      {"/bodies/0/flexible/joints", "0", "/bodies/0/flexible/joints"},
      {"/bodies/0/flexible/joints", "33", "/bodies/0/flexible/joints"},
      {"/bodies/0/flexible/joints", "2.5", "/bodies/0/flexible/joints"},
      {"/bodies/0/flexible/frequency", "8", "/bodies/0/flexible/bending_stiffness"},
      {"/bodies/0/flexible/bending_stiffness", "", "/bodies/0/flexible/bending_stiffness"},
      {"/bodies/0/flexible/bending_stiffness", "-1", "/bodies/0/flexible/bending_stiffness"},
      {"/bodies/0/flexible/damping_ratio", "-1", "/bodies/0/flexible/damping_ratio"},
      {"/bodies/0/flexible/damping_ratio", "", "/bodies/0/flexible/damping_ratio"},
      {"/bodies/0/plate", "", "/bodies/0/flexible"},
      {"/bodies/0/inertia", "0.3", "/bodies/0/inertia"},
  }));
  CAPTURE(pointer, value);
  CHECK_THAT(test::message_of([&] {
               return read_scene(test::spoil(bending_scene(), {pointer, value, ""}));
             }),
             Catch::StartsWith(std::string(place) + ": "));
}

TEST_CASE("a fault of one element hides no fault of another, also of one whose number begins alike",
          "[scene_json]") {
  Json scene = test::small_scene();
  const Json inner = scene["bodies"][0];
  for (int k = 2; k < 25; ++k) {
    scene["bodies"].push_back(scene["bodies"][1]);
    scene["bodies"].back()["name"] = "more_" + std::to_string(k);
  }
  const std::size_t count = scene["bodies"].size();
  for (std::size_t first = 0; first < count; ++first)
    for (std::size_t second = 0; second < count; ++second) {
      if (first == second) continue;
      Json spoiled = scene;
      spoiled["bodies"][first] = 3;
      spoiled["bodies"][second]["mass"] = -1;
      const std::string told = test::message_of([&] { return read_scene(spoiled); });
      CAPTURE(first, second);
      CHECK_THAT(told,
                 Catch::Contains("/bodies/" + std::to_string(first) + ": found 3") &&
                     Catch::Contains("/bodies/" + std::to_string(second) + "/mass: found -1"));
    }
}
