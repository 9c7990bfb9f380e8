#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"
#include "montecarlo/model/schema/schema.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <map>
#include <random>
#include <set>
#include <sstream>

using namespace wingspread;

namespace {

Scene scene_with(const char* pointer, const char* value) {
  return read_scene(test::spoil(test::small_scene(), {pointer, value, ""}));
}

constexpr const char* free_base = R"({"motion": "free", "mass": 1, "inertia": 2,
  "position": [3, 4], "velocity": [5, 6], "angle": 7, "rate": 8})";
constexpr const char* prescribed_base = R"({"motion": "prescribed", "acceleration": [1, 2],
  "angular_acceleration": 3, "angle": 4, "rate": 5})";

} // namespace

TEST_CASE("A path leads to its parameter", "[parameter]") {
  struct Case {
    const char* path;
    double value;
    const char* unit;
  };
  const Scene scene = scene_with("/base", "{\"motion\": \"fixed\"}");
  const auto [path, value, unit] =
      GENERATE(values<Case>({{"bodies.inner.mass", 10, "kg"},
                             {"bodies.outer.inertia", 0.25, "kg·m²"},
                             {"hinges.mid.parent_point.0", 0.5, "m"},
                             {"hinges.mid.parent_point.1", -0.02, "m"},
                             {"hinges.root.child_point.0", -0.5, "m"},
                             {"hinges.root.child_point.1", 0.02, "m"},
                             {"hinges.root.angle.stowed", 1.5, "rad"},
                             {"hinges.mid.angle.latched", 0, "rad"},
                             {"hinges.root.initial_rate", -0.1, "rad/s"},
                             {"hinges.root.spring.torque_stowed", 2, "N·m"},
                             {"hinges.root.spring.torque_latched", 1.4, "N·m"},
                             {"hinges.root.harness.torque_stowed", 0.1, "N·m"},
                             {"hinges.root.harness.torque_latched", 0.2, "N·m"},
                             {"hinges.root.friction.coulomb", 0.1, "N·m"},
                             {"hinges.root.friction.viscous", 0.01, "N·m·s/rad"},
                             {"hinges.root.friction.regularization_rate", 0.002, "rad/s"},
                             {"hinges.root.latch.stiffness", 10000, "N·m/rad"},
                             {"hinges.root.latch.damping", 100, "N·m·s/rad"}}));
  CAPTURE(path);
  const ParameterMatches found = resolve(scene, path);
  REQUIRE(found.matches.size() == 1);
  CHECK(found.expected.empty());
  CHECK(found.matches[0].parameter.in(scene) == value);
  CHECK(path_of(scene, found.matches[0].parameter) == path);
  CHECK(unit_of(found.matches[0].parameter) == unit);
}

TEST_CASE("A path leads to every parameter of a real hinge", "[parameter]") {
  struct Case {
    const char* path;
    double value;
    const char* unit;
  };
  const Scene scene = read_scene(test::real_scene());
  const auto [path, value, unit] =
      GENERATE(values<Case>({{"hinges.root.spring.scale", 1.1, ""},
                             {"hinges.root.spring.offset", -0.05, "N·m"},
                             {"hinges.root.harness.scale", 0.9, ""},
                             {"hinges.mid.harness.offset", 0, "N·m"},
                             {"hinges.root.friction.scale", 1.5, ""},
                             {"hinges.root.damper.coefficient", 3, "N·m·(s/rad)^p"},
                             {"hinges.root.damper.exponent", 0.45, ""},
                             {"hinges.root.damper.regularization_rate", 1e-5, "rad/s"},
                             {"hinges.mid.damper.peak_torque", 2, "N·m"},
                             {"hinges.mid.damper.peak_rate", 4, "rad/s"},
                             {"hinges.root.damper.window.0", 1, "rad"},
                             {"hinges.root.damper.window.1", 0.25, "rad"},
                             {"hinges.root.damper.scale", 0.7, ""},
                             {"hinges.root.stop.stiffness", 500, "N·m/rad"},
                             {"hinges.root.stop.dissipation", 0.2, "s/rad"},
                             {"hinges.root.stop.gap", 0.01, "rad"},
                             {"hinges.root.latch.backlash", 0.002, "rad"},
                             {"synchronisations.loop.ratio", 2, ""},
                             {"synchronisations.loop.stiffness", 300, "N·m/rad"},
                             {"synchronisations.cam.damping", 0, "N·m·s/rad"},
                             {"synchronisations.loop.preload", 8, "N·m"},
                             {"environment.gravity.0", 0.1, "m/s²"},
                             {"environment.gravity.1", -9.81, "m/s²"},
                             {"environment.air_density", 1.2, "kg/m³"},
                             {"bodies.inner.plate.width", 2, "m"},
                             {"bodies.inner.plate.drag_coefficient", 1.9, ""}}));
  CAPTURE(path);
  const ParameterMatches found = resolve(scene, path);
  REQUIRE(found.matches.size() == 1);
  CHECK(found.matches[0].parameter.in(scene) == value);
  CHECK(path_of(scene, found.matches[0].parameter) == path);
  CHECK(unit_of(found.matches[0].parameter) == unit);
}

TEST_CASE("a damper's coefficient has the unit of its law, also where a star finds both laws",
          "[parameter]") {
  Scene scene = read_scene(test::real_scene());
  scene.hinges[1].damper = Damper{};
  scene.hinges[1].damper->law = DamperLaw::viscous;
  scene.hinges[1].damper->coefficient = 0.25;
  const ParameterMatches found = resolve(scene, "hinges.*.damper.coefficient");
  REQUIRE(found.matches.size() == 2);
  CHECK(unit_of(found.matches[0].parameter) == "N·m·(s/rad)^p");
  CHECK(unit_of(found.matches[1].parameter) == "N·m·s/rad");
  CHECK(found.matches[1].parameter.in(scene) == 0.25);
  CHECK(path_of(scene, found.matches[1].parameter) == "hinges.mid.damper.coefficient");
}

TEST_CASE("the path of a stop at the wrong side names the stop of the other side", "[parameter]") {
  Scene scene = read_scene(test::small_scene());
  scene.hinges[0].far_stop = Stop{};
  scene.hinges[1].stop = Stop{};
  const std::string root = "hinges." + scene.hinges[0].name, mid = "hinges." + scene.hinges[1].name;
  const auto expected = [&](const std::string& path) { return resolve(scene, path).expected; };
  CHECK(expected(root + ".far_stop.gap").empty());
  CHECK(expected(root + ".stop.gap") ==
        "a hinge that has a stop at its stowed side (did you mean \"" + root + ".far_stop.gap\"?)");
  CHECK(expected(mid + ".far_stop.stiffness") ==
        "a hinge that has a stop at its latched side (did you mean \"" + mid +
            ".stop.stiffness\"?)");
  CHECK(expected("hinges.*.stop.gap").empty()); // one hinge has it
  scene.hinges[1].stop.reset();
  CHECK(expected("hinges.*.stop.gap") == "a hinge that has a stop at its stowed side (did you mean "
                                         "\"hinges.*.far_stop.gap\"?)");
  CHECK(expected(mid + ".stop.gap") == "a hinge that has a stop at its stowed side");
}

TEST_CASE("A real hinge has no parameters but its own", "[parameter]") {
  struct Case {
    const char *path, *expected;
  };
  const Scene scene = read_scene(test::real_scene());
  const auto [path, expected] = GENERATE(values<Case>(
      {{"hinges.root.spring.torque_stowed",
        "a hinge whose spring has no table (scale and offset disperse one)"},
       {"hinges.root.harness.torque_latched",
        "a hinge whose harness has no table (scale and offset disperse one)"},
       {"hinges.mid.damper.coefficient", "a hinge with a viscous or a power-law damper"},
       {"hinges.mid.damper.exponent", "a hinge with a power-law damper"},
       {"hinges.root.damper.peak_torque", "a hinge with an eddy-current damper"},
       {"hinges.mid.damper.window.1", "a hinge whose damper has a window"},
       {"hinges.mid.stop.gap", "a hinge that has a stop at its stowed side"},
       {"hinges.mid.latch.backlash", "a hinge that has a latch"},
       {"hinges.root.latch.dissipation", "a hinge whose latch has a dissipation"},
       {"bodies.outer.plate.width", "a body that has a plate"},
       {"synchronisations.cam.ratio", "a synchronisation whose ratio is a number"},
       {"synchronisations.cam.preload", "a synchronisation that has a preload"},
       {"synchronisations.lop.stiffness",
        "the path of a parameter (did you mean \"synchronisations.loop.stiffness\"?)"},
       {"environment.gravity",
        "the path of a parameter (did you mean \"environment.gravity.0\"?)"}}));
  CAPTURE(path);
  const ParameterMatches found = resolve(scene, path);
  CHECK(found.matches.empty());
  CHECK(found.expected == expected);
}

TEST_CASE("A path into the base leads to what its motion has", "[parameter]") {
  struct Case {
    const char *base, *path;
    double value;
  };
  const auto [base, path, value] =
      GENERATE(values<Case>({{free_base, "base.mass", 1},
                             {free_base, "base.inertia", 2},
                             {free_base, "base.position.0", 3},
                             {free_base, "base.position.1", 4},
                             {free_base, "base.velocity.0", 5},
                             {free_base, "base.velocity.1", 6},
                             {free_base, "base.angle", 7},
                             {free_base, "base.rate", 8},
                             {prescribed_base, "base.acceleration.0", 1},
                             {prescribed_base, "base.acceleration.1", 2},
                             {prescribed_base, "base.angular_acceleration", 3},
                             {prescribed_base, "base.angle", 4},
                             {prescribed_base, "base.rate", 5}}));
  const Scene scene = scene_with("/base", base);
  const ParameterMatches found = resolve(scene, path);
  CAPTURE(path);
  REQUIRE(found.matches.size() == 1);
  CHECK(found.matches[0].name.empty());
  CHECK(found.matches[0].parameter.in(scene) == value);
  CHECK(path_of(scene, found.matches[0].parameter) == path);
}

TEST_CASE("Every parameter of a scene has a place of its own", "[parameter]") {
  Json document = test::spoil(GENERATE(true, false) ? test::real_scene() : test::small_scene(),
                              {"/base", GENERATE(free_base, prescribed_base), ""});
  document =
      test::spoil(document, {"/hinges/1/friction", R"({"model": "exact", "static": 1})", ""});
  Scene scene = read_scene(document);
  std::set<const double*> places;
  const std::vector<std::string> paths = parameter_paths(scene);
  for (const std::string& path : paths) {
    const ParameterMatches found = resolve(scene, path);
    REQUIRE(found.matches.size() == 1);
    double& parameter = found.matches[0].parameter.in(scene);
    parameter = static_cast<double>(places.size()) + 0.5;
    CHECK(found.matches[0].parameter.in(std::as_const(scene)) == parameter);
    places.insert(&parameter);
  }
  CHECK(places.size() == paths.size());
}

TEST_CASE("A parameter found in one scene is the same in its copies", "[parameter]") {
  const Scene scene = read_scene(test::small_scene());
  Scene copy = scene;
  resolve(scene, "bodies.outer.mass").matches[0].parameter.in(copy) = 77;
  CHECK(copy.bodies[1].mass == 77);
  CHECK(scene.bodies[1].mass == 8);
}

TEST_CASE("A star stands for every name that has the parameter", "[parameter]") {
  struct Case {
    const char* path;
    std::vector<std::string> names;
  };
  const Scene scene = scene_with("/hinges/1/friction", R"({"model": "exact", "static": 1})");
  const Case given = GENERATE(values<Case>({{"bodies.*.mass", {"inner", "outer"}},
                                            {"hinges.*.spring.torque_stowed", {"root", "mid"}},
                                            {"hinges.*.latch.damping", {"root"}},
                                            {"hinges.*.friction.static", {"mid"}},
                                            {"hinges.r*.spring.scale", {"root"}},
                                            {"hinges.*o*t.spring.scale", {"root"}},
                                            {"hinges.mid*.spring.scale", {"mid"}},
                                            {"hinges.**.spring.scale", {"root", "mid"}},
                                            {"bodies.*n*r.mass", {"inner"}},
                                            {"bodies.*nner*r.mass", {}},
                                            {"bodies.o.mass", {}}}));
  std::vector<std::string> names;
  for (const ParameterMatch& match : resolve(scene, given.path).matches)
    names.push_back(match.name);
  CHECK(names == given.names);
}

TEST_CASE("A path that leads nowhere tells what was probably meant", "[parameter]") {
  struct Case {
    const char *path, *expected;
  };
  const Scene scene = scene_with("/hinges/0/friction", R"({"model": "exact"})");
  const auto [path, expected] = GENERATE(values<Case>(
      {{"bodies.iner.mass", "the path of a parameter (did you mean \"bodies.inner.mass\"?)"},
       {"bodies.inner.maas", "the path of a parameter (did you mean \"bodies.inner.mass\"?)"},
       {"bodies.*.maas", "the path of a parameter (did you mean \"bodies.*.mass\"?)"},
       {"body.inner.mass", "the path of a parameter (did you mean \"bodies.inner.mass\"?)"},
       {"hinges.root.spring.torque_latch",
        "the path of a parameter (did you mean \"hinges.root.spring.torque_latched\"?)"},
       {"hinges.root.child_point",
        "the path of a parameter (did you mean \"hinges.root.child_point.0\"?)"},
       {"hinges.ot*.initial_rate",
        "the path of a parameter (did you mean \"hinges.root.initial_rate\"?)"},
       {"hinges.r*.initial_rat",
        "the path of a parameter (did you mean \"hinges.r*.initial_rate\"?)"},
       {"hinges.mid.latch.damping", "a hinge whose latch has a damping"},
       {"hinges.mid.friction.static", "a hinge whose friction has a static level"},
       {"hinges.root.friction.regularization_rate", "a hinge with the regularized friction model"},
       {"base.mass", "a base whose motion is \"free\""},
       {"base.acceleration.0",
        "a base whose motion is \"prescribed\", with no table of it (table.scale disperses one)"},
       {"base.angle", "a base that is not fixed"},
       {"base.rate", "a base that is not fixed, with no table of its rate"},
       {"", "the path of a parameter"},
       {"wings", "the path of a parameter"}}));
  CAPTURE(path);
  const ParameterMatches found = resolve(scene, path);
  CHECK(found.matches.empty());
  CHECK(found.expected == expected);
}

namespace {

/// Path tokens after the owner's name, "latch.stiffness"; empty for the names of owners that have none.
std::string field_of(const std::string& path) {
  const bool named = !path.starts_with("base.") && !path.starts_with("environment.");
  const std::size_t owner = path.find('.');
  return path.substr((named ? path.find('.', owner + 1) : owner) + 1);
}

/// Whether a value has a number at a field's place.
bool has_number(const Json& owner, const std::string& field) {
  const Json* place = &owner;
  std::istringstream tokens(field);
  for (std::string token; std::getline(tokens, token, '.');) {
    if (place->is_array() && std::stoul(token) < place->size())
      place = &(*place)[std::stoul(token)];
    else if (place->is_object() && place->contains(token))
      place = &(*place)[token];
    else
      return false;
  }
  return place->is_number();
}

} // namespace

TEST_CASE("A path leads to a number if and only if the scene's file has it there", "[parameter]") {
  std::map<std::string, std::set<std::string>>
      fields; // of each kind of owner, in all specimens together
  std::vector<Scene> scenes;
  for (const Json& document : scene_specimens()) {
    scenes.push_back(read_scene(document));
    for (const std::string& path : parameter_paths(scenes.back()))
      fields[path.substr(0, path.find('.'))].insert(field_of(path));
  }
  CHECK(fields["hinges"].size() > 40);
  int there = 0, lacking = 0;
  for (Scene& scene : scenes) {
    for (const std::string& path : parameter_paths(scene)) // a default is not written
      if (path.ends_with(".scale") || path.ends_with(".offset") || path.ends_with(".backlash"))
        resolve(scene, path).matches.at(0).parameter.in(scene) = 1.125;
    const Json written = write_scene(scene);
    for (const char* kind : {"bodies", "hinges", "synchronisations"})
      for (const Json& owner : written.value(kind, Json::array()))
        for (const std::string& field : fields[kind]) {
          if (field.find("stop.") != std::string::npos) continue; // stands by its side in the file
          const std::string path =
              std::string(kind) + '.' + owner["name"].get<std::string>() + '.' + field;
          const bool expected = has_number(owner, field);
          CAPTURE(scene.name, path);
          CHECK(resolve(scene, path).matches.empty() != expected);
          ++(expected ? there : lacking);
        }
  }
  CHECK((there > 200 && lacking > 100));
}

TEST_CASE("whatever the values of a scene's parameters, the scene that is written has them",
          "[parameter]") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> factor(0.9, 1.1);
  for (const Json& specimen : scene_specimens()) {
    Scene scene = read_scene(specimen);
    CAPTURE(scene.name);
    std::vector<SceneParameter> parameters;
    for (const std::string& path : parameter_paths(scene))
      for (const ParameterMatch& match : resolve(scene, path).matches)
        parameters.push_back(match.parameter);
    REQUIRE(parameters.size() > 5);
    for (const SceneParameter& parameter : parameters)
      if (!path_of(scene, parameter).ends_with(".fails")) parameter.in(scene) *= factor(random);
    const Scene again = read_scene(write_scene(scene));
    for (const SceneParameter& parameter : parameters) {
      CAPTURE(path_of(scene, parameter));
      CHECK(parameter.in(again) == parameter.in(std::as_const(scene)));
    }
  }
}
