#include "montecarlo/model/campaign/dispersion.hpp"
#include "montecarlo/model/campaign/distribution_json.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

constexpr const char* law = R"("distribution": {"type": "constant", "value": 1})";

struct ReadDispersions {
  Dispersions dispersions;
  std::string problems;
};

ReadDispersions read_list(const Json& list) {
  const Scene scene = read_scene(test::small_scene());
  ReadDispersions reading;
  reading.problems = test::problems_of(
      list, [&](const JsonCursor& at) { reading.dispersions = read_dispersions(at, &scene, ""); });
  return reading;
}

/// A dispersion named `name` with a constant law and these other members.
Json dispersion(const std::string& name, const std::string& members) {
  return parse_json("{\"name\": \"" + name + "\", " + law + ", " + members + "}");
}

std::string list_problems(const std::vector<Json>& list) { return read_list(Json(list)).problems; }

} // namespace

TEST_CASE("`to` is one draw for all of its targets", "[dispersion]") {
  const Scene scene = read_scene(test::small_scene());
  const auto [dispersions, problems] = read_list(Json::array(
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
  const auto [dispersions, problems] = read_list(
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

TEST_CASE("An `each` of several paths has one draw for what they match of one thing",
          "[dispersion]") {
  const Scene scene = read_scene(test::small_scene());
  const auto [dispersions, problems] = read_list(Json::array({dispersion(
      "lot",
      R"("apply": "scale", "each": ["hinges.*.spring.scale", "hinges.r*t.latch.stiffness"])")}));
  CHECK(problems.empty());
  REQUIRE(dispersions.list.size() == 2);
  CHECK(dispersions.list[0].name == "lot.root");
  CHECK(paths_of(scene, dispersions.list[0].targets) ==
        std::vector<std::string>{"hinges.root.spring.scale", "hinges.root.latch.stiffness"});
  CHECK(dispersions.list[1].name == "lot.mid");
  CHECK(paths_of(scene, dispersions.list[1].targets) ==
        std::vector<std::string>{"hinges.mid.spring.scale"});
}

namespace {

constexpr const char* temperature = R"({ "name": "temperature",
  "distribution": { "type": "normal", "mean": 20, "std": 5 },
  "through": [ { "to": ["hinges.*.spring.scale"], "apply": "scale",
                 "table": { "at": [-100, 20, 60], "value": [3, 1, 0.8] } },
               { "to": ["hinges.root.friction.coulomb"], "apply": "add",
                 "table": { "at": [-100, 60], "value": ["300 N*mm", 0] } } ] })";

} // namespace

TEST_CASE("`through` is one draw for several effects, each by a table of its own", "[dispersion]") {
  const Scene scene = read_scene(test::small_scene());
  const auto [dispersions, problems] = read_list(Json::array({parse_json(temperature)}));
  CHECK(problems.empty());
  REQUIRE(dispersions.list.size() == 1);
  const Dispersion& draw = dispersions.list[0];
  CHECK(draw.name == "temperature");
  CHECK(draw.targets.empty());
  REQUIRE(draw.through.size() == 2);
  CHECK(draw.through[0].apply == Apply::scale);
  CHECK(paths_of(scene, draw.through[0].targets) ==
        std::vector<std::string>{"hinges.root.spring.scale", "hinges.mid.spring.scale"});
  CHECK(draw.through[0].table.knots() == std::vector<double>{-100, 20, 60});
  CHECK(draw.through[1].apply == Apply::add);
  CHECK(draw.through[1].table.pieces()[1].c[0] == 0.3); // SI
  const Json& resolved = dispersions.resolved[0]["through"];
  CHECK(resolved[1]["table"].dump() == R"({"at":[-100.0,60.0],"value":[0.3,0.0]})");
  CHECK(read_list(dispersions.resolved).dispersions.resolved == dispersions.resolved);
}

TEST_CASE("Each fault of a `through` is told", "[dispersion]") {
  struct Case {
    const char *pointer, *value, *message;
  };
  const auto [pointer, value, message] = GENERATE(values<Case>(
      {{"/through", "3",
        "/0/through: found 3, expected an array of what the draw drives, at least one"},
       {"/through/0", "3",
        "/0/through/0: found 3, expected what the draw drives: an object with to, apply and table"},
       {"/through/0/to/0", "\"hinges.*.sprng.scale\"",
        "/0/through/0/to/0: found string \"hinges.*.sprng.scale\", expected the path of a "
        "parameter "
        "(did you mean \"hinges.*.spring.scale\"?)"},
       {"/through/0/table", "[1]",
        "/0/through/0/table: found an array of 1, expected a table: an object with at and value"},
       {"/through/0/table/at", "[20]",
        "/0/through/0/table/at: found an array of 1, expected an array of 2 to 1000 numbers, "
        "ascending"},
       {"/through/0/table/at/2", "20",
        "/0/through/0/table/at/2: found 20, expected more than 20, the one before"},
       {"/through/0/table/value", "[1, 2]",
        "/0/through/0/table/value: found an array of 2, expected as many numbers as there are "
        "draws: "
        "3"},
       {"/through/0/table/value", "[1, 2, \"3 N\"]",
        "/0/through/0/table/value/2: found string \"3 N\", expected a number"},
       {"/through/1/table/value", "[1, \"3 N\"]",
        "/0/through/1/table/value/1: found string \"3 N\", expected a number, N·m, or a string of "
        "a "
        "number and its unit: \"N*m\", \"N*mm\", \"in*lbf\", \"in*ozf\" or \"ft*lbf\""},
       {"/through/0/table/at", "[0, 4e-320, 1]",
        "/0/through/0/table: found a curve too steep for numbers, expected draws further apart, or "
        "smaller values"}}));
  CAPTURE(pointer, value);
  CHECK(
      test::facts_of(list_problems({test::spoil(parse_json(temperature), {pointer, value, ""})})) ==
      test::facts_of(message));
}

TEST_CASE("Parameters that several draws change are told, with the order", "[dispersion]") {
  const Scene scene = read_scene(test::small_scene());
  const auto [dispersions, problems] = read_list(
      Json::array({parse_json(temperature),
                   dispersion("s", R"("apply": "scale", "each": "hinges.*.spring.scale")"),
                   dispersion("m", R"("apply": "set", "to": ["hinges.root.spring.torque_stowed"])"),
                   dispersion("f", R"("apply": "add", "to": ["hinges.root.friction.coulomb"])")}));
  CHECK(problems.empty());
  const auto shared = shared_targets(dispersions.list, scene);
  REQUIRE(shared.size() == 3);
  CHECK(shared[0].paths == std::vector<std::string>{"hinges.root.spring.scale"});
  CHECK(shared[0].draws == std::vector<std::string>{"temperature scales", "s.root scales"});
  CHECK(shared[1].draws == std::vector<std::string>{"temperature scales", "s.mid scales"});
  CHECK(shared[2].paths == std::vector<std::string>{"hinges.root.friction.coulomb"});
  CHECK(shared[2].draws == std::vector<std::string>{"temperature adds", "f adds"});
}

TEST_CASE("The resolved list is not expanded, and its laws are in full", "[dispersion]") {
  const Json list =
      Json::array({dispersion("m", R"("apply": "set", "each": "bodies.*.mass")"),
                   dispersion("r", R"("apply": "add", "to": ["hinges.root.initial_rate"])")});
  CHECK(read_list(list).dispersions.resolved.dump() ==
        R"([{"name":"m","distribution":{"type":"constant","value":1.0},"apply":"set",)"
        R"("each":"bodies.*.mass"},{"name":"r","distribution":{"type":"constant","value":1.0},)"
        R"("apply":"add","to":["hinges.root.initial_rate"]}])");
}

TEST_CASE("Numbers of a law that sets or adds may have the unit of their target", "[dispersion]") {
  const auto law_of = [](const char* json) {
    const auto [dispersions, problems] = read_list(Json::array({parse_json(json)}));
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
        "/0/distribution/shape: found string \"2 kg\", expected a number, > 0 and ≤ 1e6"},
       {R"({"name": "m", "apply": "set", "each": "bodies.*.mass",
            "distribution": {"type": "constant", "value": "2 m"}})",
        "/0/distribution/value: found string \"2 m\", expected a number, kg, or a string of a "
        "number and its unit: \"kg\", \"g\", \"lb\", \"lbm\" or \"slug\""}}));
  CHECK(test::facts_of(list_problems({parse_json(json)})) == test::facts_of(message));
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
        "/0: found neither \"to\" nor \"each\" nor \"through\", expected one of them\n"
        "/0/too: found the unknown key \"too\", expected \"name\", \"rows\", \"distribution\", "
        "\"to\", \"each\", \"through\" or \"apply\" (did you mean \"to\"?)"}}));
  CHECK(test::facts_of(list_problems({parse_json(json)})) == test::facts_of(message));
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
       {R"("to": ["bodies.inner.mass"], "each": "bodies.*.mass", "through": [{}])",
        "/0/apply: found string \"scale\", expected no apply beside a \"through\": each of its "
        "tables "
        "has its own\n"
        "/0/through/0/to: found nothing, expected an array of at least one parameter's path\n"
        "/0/through/0/apply: found nothing, expected \"set\", \"scale\" or \"add\"\n"
        "/0/through/0/table: found nothing, expected a table: an object with at and value\n"
        "/0: found both \"to\" and \"each\" and \"through\", expected one of them"},
       {R"("each": [])",
        "/0/each: found an array of 0, expected a path, or an array of at least one"},
       {R"("each": ["bodies.*.mass", "hinges.root.spring.scale", "hinges.*.spring.scale"])",
        "/0/each/1: found string \"hinges.root.spring.scale\" beside parameters of another kind of "
        "thing, expected parameters of bodies alone, of hinges or of synchronisations: they share "
        "one draw for each\n"
        "/0/each/2: found string \"hinges.*.spring.scale\" beside parameters of another kind of "
        "thing, expected parameters of bodies alone, of hinges or of synchronisations: they share "
        "one draw for each"},
       {R"("each": ["bodies.*.mass", "bodies.in*.mass"])",
        "/0/each/1: found bodies.inner.mass a second time, expected each parameter once"},
       {R"("each": "base.mass")",
        "/0/each: found string \"base.mass\", expected a base whose motion is \"free\""}}));
  CHECK(test::facts_of(list_problems({dispersion(
            "m", R"("apply": "scale", )" + std::string(targets))})) == test::facts_of(message));
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
        list_problems({dispersion(name, rest)}),
        Catch::StartsWith("/0/name: found string \"") &&
            Catch::EndsWith("expected a string, not empty, without commas, quotes and control "
                            "characters"));
  for (const std::string name :
       {"run", "status", "latch_order", "reason", "deployed", "deployment_time", "root.latch_time",
        "root.latch_rate", "mid.peak_moment", "mid.peak_force", "root.rate_at.mid"})
    CHECK(list_problems({dispersion(name, rest)}) ==
          "/0/name: found \"" + name +
              "\", the name of a column of the results, expected another name");
  for (const char* name : {"spring", "root.spring", "Masse ü", "run 2", "a.b.c"})
    CHECK(list_problems({dispersion(name, rest)}).empty());
}

TEST_CASE("No two draws share a name, expanded ones included", "[dispersion]") {
  CHECK(
      list_problems({dispersion("m.outer", R"("apply": "scale", "to": ["bodies.inner.inertia"])"),
                     dispersion("m", R"("apply": "scale", "each": "bodies.*.mass")")}) ==
      "/1/name: found \"m.outer\", the name of another dispersion too, expected a name of its own");
}

TEST_CASE("no two entries share a name, whatever each draws", "[dispersion]") {
  const Json to = dispersion("m", R"("apply": "scale", "to": ["bodies.inner.inertia"])");
  const Json each = dispersion("m", R"("apply": "scale", "each": "bodies.*.mass")");
  const Json other = dispersion("m", R"("apply": "scale", "each": "hinges.*.spring.scale")");
  Json rows{{"name", "m"}};
  rows["rows"] = parse_json(R"({ "values": { "x": [1, 2] }, "apply": "scale",
                                 "columns": { "x": ["bodies.inner.mass"] } })");
  const std::vector<Json> all{to, each, other, rows};
  for (const Json& first : all)
    for (const Json& second : all) {
      CAPTURE(first.dump(), second.dump());
      CHECK_THAT(list_problems({first, second}),
                 Catch::Contains("/1/name: found \"m\", the name of another dispersion too"));
    }
}

TEST_CASE("No two draws share a random stream", "[dispersion]") {
  // A known collision of FNV-1a, 64 bits, which names the streams.
  CHECK(list_problems(
            {dispersion("8yn0iYCKYHlIj4-BwPqk", R"("apply": "scale", "to": ["bodies.inner.mass"])"),
             dispersion("GReLUrM4wMqfg9yzV3KQ",
                        R"("apply": "scale", "to": ["bodies.inner.mass"])")}) ==
        "/1/name: found \"GReLUrM4wMqfg9yzV3KQ\", which has the random stream of "
        "\"8yn0iYCKYHlIj4-BwPqk\", expected another name");
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
  CHECK(list_problems({of("a", first), of("b", second)}) ==
        (sound ? ""
               : "/1/apply: found \"set\" of bodies.inner.mass after \"a\" has changed it, "
                 "expected "
                 "\"set\" first: it overwrites earlier changes"));
}

TEST_CASE("Nor is one to a later table that sets its target", "[dispersion]") {
  Json draw = parse_json(temperature);
  draw["through"][0]["apply"] = "set";
  CHECK(list_problems(
            {dispersion("s", R"("apply": "scale", "to": ["hinges.mid.spring.scale"])"), draw}) ==
        "/1/through: found \"set\" of hinges.mid.spring.scale after \"s\" has changed it, "
        "expected \"set\" first: it overwrites earlier changes");
}

TEST_CASE("The list of dispersions is an array", "[dispersion]") {
  CHECK(test::facts_of(read_list(parse_json("{}")).problems) ==
        test::facts_of("found an object, expected an array of dispersions"));
}
