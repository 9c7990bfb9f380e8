#include "montecarlo/campaign/dispersion.hpp"
#include "montecarlo/campaign/distribution_json.hpp"
#include "montecarlo/scene_file/scene_json.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

constexpr const char* law = R"("distribution": {"type": "constant", "value": 1})";

struct Reading {
  Dispersions dispersions;
  std::string problems;
};

Reading read(const Json& list) {
  const Scene scene = read_scene(test::small_scene());
  Reading reading;
  reading.problems = test::problems_of(
      list, [&](const JsonCursor& at) { reading.dispersions = read_dispersions(at, &scene, ""); });
  return reading;
}

/// A dispersion named `name` with a constant law and these other members.
Json dispersion(const std::string& name, const std::string& members) {
  return parse_json("{\"name\": \"" + name + "\", " + law + ", " + members + "}");
}

std::string problems(const std::vector<Json>& list) { return read(Json(list)).problems; }

} // namespace

TEST_CASE("`to` is one draw for all of its targets", "[dispersion]") {
  const Scene scene = read_scene(test::small_scene());
  const auto [dispersions, problems] = read(Json::array(
      {dispersion("m", R"("apply": "scale", "to": ["bodies.*.mass", "bodies.outer.inertia"])")}));
  CHECK(problems.empty());
  REQUIRE(dispersions.list.size() == 1);
  CHECK(dispersions.list[0].name == "m");
  CHECK(dispersions.list[0].apply == Apply::scale);
  std::vector<std::string> paths;
  for (const SceneParameter& target : dispersions.list[0].targets)
    paths.push_back(path_of(scene, target));
  CHECK(paths ==
        std::vector<std::string>{"bodies.inner.mass", "bodies.outer.mass", "bodies.outer.inertia"});
}

TEST_CASE("`each` is a draw of its own per match, named after it", "[dispersion]") {
  const Scene scene = read_scene(test::small_scene());
  const auto [dispersions, problems] = read(
      Json::array({dispersion("m", R"("apply": "set", "each": "bodies.*.mass")"),
                   dispersion("m.x", R"("apply": "add", "each": "hinges.root.initial_rate")")}));
  CHECK(problems.empty());
  REQUIRE(dispersions.list.size() == 3);
  CHECK(dispersions.list[0].name == "m.inner");
  CHECK(dispersions.list[1].name == "m.outer");
  CHECK(dispersions.list[2].name == "m.x.root");
  REQUIRE(dispersions.list[1].targets.size() == 1);
  CHECK(path_of(scene, dispersions.list[1].targets[0]) == "bodies.outer.mass");
}

TEST_CASE("The resolved list is not expanded, and its laws are in full", "[dispersion]") {
  const Json list =
      Json::array({dispersion("m", R"("apply": "set", "each": "bodies.*.mass")"),
                   dispersion("r", R"("apply": "add", "to": ["hinges.root.initial_rate"])")});
  CHECK(read(list).dispersions.resolved.dump() ==
        R"([{"name":"m","distribution":{"type":"constant","value":1.0},"apply":"set",)"
        R"("each":"bodies.*.mass"},{"name":"r","distribution":{"type":"constant","value":1.0},)"
        R"("apply":"add","to":["hinges.root.initial_rate"]}])");
}

TEST_CASE("Numbers of a law that sets or adds may have the unit of their target", "[dispersion]") {
  const auto law_of = [](const char* json) {
    const auto [dispersions, problems] = read(Json::array({parse_json(json)}));
    CHECK(problems.empty());
    CHECK(dispersions.resolved[0]["distribution"] ==
          write_distribution(dispersions.list[0].distribution)); // SI
    return dispersions.list[0].distribution;
  };
  const auto angle = law_of(
      R"({"name": "a", "apply": "set", "to": ["hinges.root.angle.stowed"], "distribution":
          {"type": "normal", "mean": "90 deg", "std": "5 mrad", "truncate": {"lower": "45 deg", "upper": 2}}})");
  CHECK(std::get<Normal>(angle.law).mean == 1.5707963267948966);
  CHECK(std::get<Normal>(angle.law).std == 0.005);
  CHECK(angle.truncate->lower == 0.7853981633974483);
  CHECK(angle.truncate->upper == 2);
  const auto mass = law_of(R"({"name": "m", "apply": "add", "each": "bodies.*.mass", "distribution":
          {"type": "discrete", "values": ["10 lb", 3], "weights": [1, 1]}})");
  CHECK(std::get<Discrete>(mass.law).values == std::vector<double>{4.5359237, 3});
}

TEST_CASE("Numbers without a dimension, or with several, have no unit", "[dispersion]") {
  struct Case {
    const char *json, *message;
  };
  const auto [json, message] = GENERATE(values<Case>(
      {{R"({"name": "m", "apply": "scale", "each": "bodies.*.mass",
            "distribution": {"type": "constant", "value": "2 kg"}})",
        "/0/distribution/value: found string \"2 kg\", expected a number"},
       {R"({"name": "m", "apply": "set", "to": ["bodies.inner.mass", "bodies.inner.inertia"],
            "distribution": {"type": "constant", "value": "2 kg"}})",
        "/0/distribution/value: found string \"2 kg\", expected a number"},
       {R"({"name": "m", "apply": "set", "each": "bodies.*.mass",
            "distribution": {"type": "gamma", "shape": "2 kg", "scale": "3 kg"}})",
        "/0/distribution/shape: found string \"2 kg\", expected a number, > 0"},
       {R"({"name": "m", "apply": "set", "each": "bodies.*.mass",
            "distribution": {"type": "constant", "value": "2 m"}})",
        "/0/distribution/value: found string \"2 m\", expected a number, kg, or a string of a "
        "number and its unit: \"kg\", \"g\" or \"lb\""}}));
  CHECK(problems({parse_json(json)}) == message);
}

TEST_CASE("Each fault of a dispersion is told", "[dispersion]") {
  struct Case {
    const char *json, *message;
  };
  const auto [json, message] = GENERATE(values<Case>(
      {{"3", "/0: found 3, expected a dispersion: an object"},
       {R"({"each": "bodies.*.mass"})",
        "/0/name: found nothing, expected a string, not empty, without commas, quotes and control "
        "characters\n"
        "/0/distribution: found nothing, expected a distribution: an object with its type\n"
        "/0/apply: found nothing, expected \"set\", \"scale\" or \"add\""},
       {R"({"name": "m", "distribution": {"type": "normal", "mean": 0, "std": 0}, "apply": "mul",
            "too": ["bodies.inner.mass"]})",
        "/0/distribution/std: found 0, expected > 0\n"
        "/0/apply: found string \"mul\", expected \"set\", \"scale\" or \"add\"\n"
        "/0: found neither \"to\" nor \"each\", expected one of them\n"
        "/0/too: found the unknown key \"too\", expected \"name\", \"distribution\", \"apply\", "
        "\"to\" or "
        "\"each\" (did you mean \"to\"?)"}}));
  CHECK(problems({parse_json(json)}) == message);
}

TEST_CASE("Each fault of a dispersion's targets is told", "[dispersion]") {
  struct Case {
    const char *targets, *message;
  };
  const auto [targets, message] = GENERATE(values<Case>(
      {{R"("to": ["bodies.inner.mass"], "each": "bodies.*.mass")",
        "/0: found both \"to\" and \"each\", expected one of them"},
       {R"("to": "bodies.inner.mass")", "/0/to: found string \"bodies.inner.mass\", expected an "
                                        "array of at least one parameter's path"},
       {R"("to": [])",
        "/0/to: found an array of 0, expected an array of at least one parameter's path"},
       {R"("to": ["bodies.*.mass", 3])",
        "/0/to/1: found 3, expected a string, the path of a parameter"},
       {R"("to": ["bodies.innr.mass"])", "/0/to/0: found string \"bodies.innr.mass\", expected the "
                                         "path of a parameter (did you mean "
                                         "\"bodies.inner.mass\"?)"},
       {R"("to": ["bodies.inner.mass", "bodies.*.mass"])",
        "/0/to/1: found bodies.inner.mass a second time, expected each parameter once"},
       {R"("each": ["bodies.*.mass"])",
        "/0/each: found an array of 1, expected a string, the path of a parameter"},
       {R"("each": "base.mass")",
        "/0/each: found string \"base.mass\", expected a base whose motion is \"free\""}}));
  CHECK(problems({dispersion("m", R"("apply": "scale", )" + std::string(targets))}) == message);
}

TEST_CASE("`each` needs a name to call its draws by", "[dispersion]") {
  const Scene scene = read_scene(test::spoil(
      test::small_scene(), {"/base", R"({"motion": "free", "mass": 1, "inertia": 1})", ""}));
  const Json list = Json::array({dispersion("m", R"("apply": "scale", "each": "base.mass")")});
  CHECK(test::problems_of(list,
                          [&](const JsonCursor& at) { (void)read_dispersions(at, &scene, ""); }) ==
        "/0/each: found string \"base.mass\", expected the path of a body's or a hinge's parameter "
        "(\"to\" takes the base's)");
}

TEST_CASE("Targets are not looked up in a scene that has problems of its own", "[dispersion]") {
  const Json list = Json::array({dispersion("m", R"("apply": "scale", "each": "no.such.path")")});
  CHECK(test::problems_of(list, [](const JsonCursor& at) {
          (void)read_dispersions(at, nullptr, "");
        }).empty());
}

TEST_CASE("A dispersion's name heads a column of its own", "[dispersion]") {
  const std::string rest = R"("apply": "scale", "to": ["bodies.inner.mass"])";
  for (const char* name : {"", "a,b", "a\\\"b", "a\\nb", "a\\rb"})
    CHECK_THAT(
        problems({dispersion(name, rest)}),
        Catch::StartsWith("/0/name: found string \"") &&
            Catch::EndsWith("expected a string, not empty, without commas, quotes and control "
                            "characters"));
  for (const std::string name :
       {"run", "status", "latch_order", "reason", "deployed", "deployment_time", "root.latch_time",
        "root.latch_rate", "mid.peak_moment", "mid.peak_force", "root.rate_at.mid"})
    CHECK(problems({dispersion(name, rest)}) ==
          "/0/name: found \"" + name +
              "\", the name of a column of the results, expected another name");
  for (const char* name : {"spring", "root.spring", "Masse ü", "run 2", "a.b.c"})
    CHECK(problems({dispersion(name, rest)}).empty());
}

TEST_CASE("No two draws share a name, expanded ones included", "[dispersion]") {
  CHECK(
      problems({dispersion("m.outer", R"("apply": "scale", "to": ["bodies.inner.inertia"])"),
                dispersion("m", R"("apply": "scale", "each": "bodies.*.mass")")}) ==
      "/1/name: found \"m.outer\", the name of another dispersion too, expected a name of its own");
}

TEST_CASE("No two draws share a random stream", "[dispersion]") {
  // A known collision of FNV-1a, 64 bits, which names the streams.
  CHECK(problems(
            {dispersion("8yn0iYCKYHlIj4-BwPqk", R"("apply": "scale", "to": ["bodies.inner.mass"])"),
             dispersion("GReLUrM4wMqfg9yzV3KQ",
                        R"("apply": "scale", "to": ["bodies.inner.mass"])")}) ==
        "/1/name: found \"GReLUrM4wMqfg9yzV3KQ\", whose random stream is that of "
        "\"8yn0iYCKYHlIj4-BwPqk\" too, expected another name");
}

TEST_CASE("A draw is not lost to a later one that sets its target", "[dispersion]") {
  struct Case {
    const char *first, *second;
    bool sound;
  };
  const auto [first, second, sound] = GENERATE(values<Case>({{"set", "scale", true},
                                                             {"set", "add", true},
                                                             {"scale", "scale", true},
                                                             {"scale", "add", true},
                                                             {"add", "scale", true},
                                                             {"add", "add", true},
                                                             {"set", "set", false},
                                                             {"scale", "set", false},
                                                             {"add", "set", false}}));
  const auto of = [](const char* name, const char* how) {
    return dispersion(name,
                      "\"apply\": \"" + std::string(how) + "\", \"to\": [\"bodies.inner.mass\"]");
  };
  CAPTURE(first, second);
  CHECK(problems({of("a", first), of("b", second)}) ==
        (sound ? ""
               : "/1/apply: found \"set\" of bodies.inner.mass, which \"a\" has written before, "
                 "expected "
                 "nothing before a \"set\", which would undo it"));
}

TEST_CASE("The list of dispersions is an array", "[dispersion]") {
  CHECK(read(parse_json("{}")).problems == "found an object, expected an array of dispersions");
}
