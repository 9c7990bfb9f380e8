#include "core/deployment.hpp"
#include "montecarlo/model/scene_file/mirror.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/model/scene_file/scene_parameter.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

using namespace wingspread;

namespace {

/// The real scene as the right wing of a free spacecraft, and its mirror image.
Json two_wings() {
  Json scene = test::real_scene();
  for (const char* list : {"bodies", "hinges", "synchronisations"})
    for (Json& owner : scene[list]) owner["name"] = "R_" + owner["name"].get<std::string>();
  for (Json& hinge : scene["hinges"]) {
    for (const char* end : {"parent", "child"})
      if (hinge[end] != "base") hinge[end] = "R_" + hinge[end].get<std::string>();
  }
  for (Json& loop : scene["synchronisations"])
    for (Json& name : loop["between"]) name = "R_" + name.get<std::string>();
  scene["hinges"][0]["parent_point"] = {1, 0.2};
  scene["base"] = parse_json(R"({ "motion": "free", "mass": 100, "inertia": 30 })");
  scene["environment"] = parse_json(R"({ "gravity": [0, 0], "air_density": 1.2 })");
  scene["mirror"] = parse_json(R"({ "of": "R_*", "as": "L_*" })");
  return scene;
}

std::string spoilt(const test::Spoiled& change) {
  return test::message_of([&] { return read_scene(test::spoil(two_wings(), change)); });
}

} // namespace

TEST_CASE("A mirrored wing has x and all angles of the other sign", "[mirror]") {
  const Scene scene = read_scene(two_wings());
  REQUIRE(scene.bodies.size() == 4);
  REQUIRE(scene.hinges.size() == 4);
  REQUIRE(scene.synchronisations.size() == 4);
  const Hinge &right = scene.hinges[0], &left = scene.hinges[2];
  CHECK(left.name == "L_root");
  CHECK(left.parent == base_index);
  CHECK(scene.bodies[left.child].name == "L_inner");
  CHECK(scene.bodies[scene.hinges[3].parent].name == "L_inner");
  CHECK(left.parent_point == Eigen::Vector2d(-1, 0.2));
  CHECK(left.child_point == Eigen::Vector2d(0.5, 0.02));
  CHECK(left.stowed == -1.5);
  CHECK(left.latched == 0);
  CHECK(left.initial_rate == 0.1);
  CHECK(left.spring.table->angle() == std::vector<double>{-1.5, -0.8, 0});
  CHECK(left.spring.table->stowing() == right.spring.table->stowing());
  CHECK(left.spring.scale == right.spring.scale);
  CHECK(left.harness.table->angle() == std::vector<double>{-1.6, -1, -0.2, 0.1});
  CHECK(left.damper->window == std::array{-1.0, -0.25});
  CHECK(scene.bodies[2].plate->from == Eigen::Vector2d(0.5, 0.01));
  CHECK(scene.bodies[2].mass == scene.bodies[0].mass);
  CHECK(scene.synchronisations[3].name == "L_cam");
  CHECK(scene.synchronisations[3].first == 3);
  CHECK(scene.synchronisations[3].second == 2);
  CHECK(scene.synchronisations[3].travel == scene.synchronisations[1].travel);
}

TEST_CASE("A mirrored scene is written whole, without the key", "[mirror]") {
  const Scene scene = read_scene(two_wings());
  const Json written = write_scene(scene);
  CHECK_FALSE(written.contains("mirror"));
  CHECK(write_scene(read_scene(written)) == written);
  CHECK(resolve(scene, "hinges.L_*.spring.scale").matches.size() == 2);
  CHECK(resolve(scene, "hinges.L_root.damper.window.0").matches.size() == 1);
}

TEST_CASE("Symmetric wings released at once do not turn the base", "[mirror]") {
  const Scene scene = read_scene(two_wings());
  Integration how;
  how.t_end = 8;
  Goal goal;
  goal.to_t_end = true;
  const Outcome out = Deployment().run(scene, how, goal);
  REQUIRE(out.status != Status::failed);
  CHECK(out.latches.size() >= 2);
  CHECK(out.base_peaks->angle < 1e-12);
  CHECK(out.base_peaks->rate < 1e-12);
  CHECK(std::abs(out.final.base_position.x()) < 1e-12);
  for (const std::size_t h : {0U, 1U})
    CHECK(std::abs(out.final.angles[h] + out.final.angles[h + 2]) < 1e-12);
  Scene uneven = scene;
  uneven.bodies[2].mass *= 1.01;
  CHECK(Deployment().run(uneven, how, goal).base_peaks->angle > 1e-5);
}

TEST_CASE("A mirror that makes no second wing is refused", "[mirror]") {
  const auto [pointer, value, message] = GENERATE(values<test::Spoiled>({
      {"/mirror/of", R"("R_")",
       R"(/mirror/of: found string "R_", expected a name with one "*", as "R_*")"},
      {"/mirror/as", "", R"(/mirror/as: found nothing, expected a name with one "*", as "R_*")"},
      {"/mirror/of", R"("S_*")",
       R"(/mirror/of: found "S_*", the name of no hinge, expected a name with one "*", as "R_*")"},
      {"/mirror/as", R"("R_*")", ""},
      {"/hinges/1/name", R"("mid")", ""},
      {"/synchronisations/0/name", R"("loop")", ""},
      {"/mirror/by", R"("R_*")", ""},
  }));
  CAPTURE(pointer, value);
  const std::string said = spoilt({pointer, value, message});
  CHECK_FALSE(said.empty());
  CHECK_THAT(said, Catch::Contains("mirror") || Catch::Contains("between"));
  if (*message != '\0') CHECK(test::facts_of(said) == test::facts_of(message));
}

TEST_CASE("A synchronisation of a mirrored hinge with one that is not has no mirror image",
          "[mirror]") {
  Json json = two_wings();
  Json alone = json["bodies"][0];
  alone["name"] = "boom";
  Json hinge = json["hinges"][0];
  hinge["name"] = "boom_hinge", hinge["child"] = "boom";
  Json loop = json["synchronisations"][0];
  loop["name"] = "rod", loop["between"] = {"boom_hinge", "R_root"};
  json["bodies"].push_back(alone), json["hinges"].push_back(hinge);
  json["synchronisations"].push_back(loop);
  const Scene scene = read_scene(json);
  CHECK(std::ranges::count(scene.synchronisations, "rod", &Synchronisation::name) == 1);
  CHECK(scene.synchronisations.size() == 5);
}

TEST_CASE("A mirrored hold waits for the hinge of its own wing", "[mirror]") {
  Json json = two_wings();
  json["hinges"][1]["release"] = parse_json(R"({ "after": "R_root", "event": "latched" })");
  const Scene scene = read_scene(json);
  REQUIRE(scene.hinges.size() == 4);
  CHECK(scene.hinges[1].release->after == 0);
  REQUIRE(scene.hinges[3].name == "L_mid");
  CHECK(scene.hinges[3].release->after == 2);
}

TEST_CASE("A name of a copy is refused as such, and other unknown names are not", "[mirror]") {
  const auto expected = [](const char* pointer, const Json& value) {
    Json json = two_wings();
    json["hinges"][1]["release"] = parse_json(R"({ "after": "R_root", "event": "latched" })");
    json[Json::json_pointer(pointer)] = value;
    try {
      (void)read_scene(json);
    } catch (const SpecError& error) {
      return error.problems().front().expected;
    }
    return std::string();
  };
  for (const char* pointer : {"/hinges/1/release/after", "/hinges/1/parent"}) {
    CAPTURE(pointer);
    const bool hinge = std::string(pointer).ends_with("after");
    CHECK_THAT(expected(pointer, hinge ? "L_root" : "L_inner"),
               Catch::Contains("mirror") && Catch::Contains(hinge ? "R_root" : "R_inner"));
    CHECK_THAT(expected(pointer, "L_rot"), !Catch::Contains("copy")); // no R_rot
  }
}

TEST_CASE("A pattern covers the names that begin and end as it does, without an overlap",
          "[mirror]") {
  const std::vector<std::string> words = [] {
    std::vector<std::string> all{""};
    for (std::size_t k = 0; all[k].size() < 5; ++k)
      for (const char c : {'a', 'b'}) all.push_back(all[k] + c);
    return all;
  }();
  for (const std::string& head : words)
    for (const std::string& tail : words) {
      if (head.size() + tail.size() > 4) continue;
      const MirrorNames names{head + "*" + tail, "x*y"};
      std::map<std::string, std::string> copies;
      for (const std::string& middle : words) copies[head + middle + tail] = "x" + middle + "y";
      for (const std::string& name : words) {
        const auto copy = copies.find(name);
        CAPTURE(names.of, name);
        REQUIRE(names.covers(name) == (copy != copies.end()));
        if (copy != copies.end()) REQUIRE(names.copy_of(name) == copy->second);
      }
    }
}

TEST_CASE("copies have names that a scene may have: what is written can be read again",
          "[mirror]") {
  for (const char* as : {"L.*", "L>*", "L,*", "L/*", "L\"*", "L\n*"}) {
    CAPTURE(as);
    Json scene = two_wings();
    scene["mirror"]["as"] = as;
    CHECK_THAT(test::message_of([&] { return read_scene(scene); }),
               Catch::Contains("/mirror/as: found "));
  }
  Json scene = two_wings();
  scene["mirror"] = {{"of", "R_*"}, {"as", "*"}};
  CHECK(test::message_of([&] { return read_scene(scene); }).empty());
  for (const char* list : {"bodies", "hinges"})
    for (Json& owner : scene[list])
      for (const char* key : {"name", "child", "parent"})
        if (owner.contains(key) && owner[key] == "R_inner") owner[key] = "R_base";
  CHECK_THAT(test::message_of([&] { return read_scene(scene); }),
             Catch::Contains("makes \"base\""));
}
