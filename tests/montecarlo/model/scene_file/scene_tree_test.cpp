#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/model/scene_file/scene_tree.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

constexpr const char* plain =
    "expected a name, not empty, without . * / , \" > and control characters";

/// A scene of bodies a, b, c, … joined by hinges 0, 1, 2, …, given as "parent child".
Json tree(const std::string& bodies, const std::vector<std::string>& hinges) {
  Json document = test::small_scene();
  document["bodies"].clear();
  for (const char body : bodies)
    document["bodies"].push_back({{"name", std::string(1, body)}, {"mass", 1}, {"inertia", 1}});
  const Json pattern = document["hinges"][1];
  document["hinges"].clear();
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    const auto space = hinges[i].find(' ');
    document["hinges"].push_back(pattern);
    document["hinges"][i]["name"] = std::to_string(i);
    document["hinges"][i]["parent"] = hinges[i].substr(0, space);
    document["hinges"][i]["child"] = hinges[i].substr(space + 1);
  }
  return document;
}

std::string problems(const Json& document) {
  return test::message_of([&] { return read_scene(document); });
}

} // namespace

TEST_CASE("A name must be free of what has a meaning elsewhere", "[scene_tree]") {
  const char* name = GENERATE("", "a.b", "*", "a/b", "a,b", "a\\\"b", "a>b", "a\\nb", "a\\u007fb");
  const std::string json = std::string("\"") + name + "\"";
  CHECK_THAT(problems(test::spoil(test::small_scene(), {"/hinges/0/name", json.c_str(), ""})),
             Catch::StartsWith("/hinges/0/name: found string \"") && Catch::EndsWith(plain));
  CHECK_THAT(problems(test::spoil(test::small_scene(), {"/bodies/1/name", json.c_str(), ""})),
             Catch::StartsWith("/bodies/1/name: found string \"") && Catch::Contains(plain));
}

TEST_CASE("Any other character may stand in a name", "[scene_tree]") {
  CHECK(problems(test::spoil(test::small_scene(), {"/hinges/0/name", "\"Flügel +Y #1 ~\"", ""}))
            .empty());
}

TEST_CASE("Bodies have names of their own, and so have hinges", "[scene_tree]") {
  struct Case {
    const char *pointer, *name, *message;
  };
  const auto [pointer, name, message] = GENERATE(values<Case>(
      {{"/bodies/1/name", "\"inner\"",
        "/bodies/1/name: found string \"inner\", the name of /bodies/0 too, expected a name of its "
        "own"},
       {"/hinges/1/name", "\"root\"",
        "/hinges/1/name: found string \"root\", the name of /hinges/0 too, expected a name of its "
        "own"},
       {"/hinges/1/name", "7", "/hinges/1/name: found 7, expected a string, the hinge's name"}}));
  CHECK(test::facts_of(problems(test::spoil(test::small_scene(), {pointer, name, ""}))) ==
        test::facts_of(message));
  CHECK(problems(test::spoil(test::small_scene(), {"/hinges/0/name", "\"inner\"", ""})).empty());
}

TEST_CASE("No body and no hinge is called base", "[scene_tree]") {
  Json document = tree("a", {"base a"});
  document["bodies"][0]["name"] = document["hinges"][0]["child"] = "base";
  CHECK(problems(document) ==
        "/bodies/0/name: found string \"base\", expected another name: \"base\" is the base's");
  Json other = tree("a", {"base a"});
  other["hinges"][0]["name"] = "base"; // base.rate would be two outputs
  CHECK_THAT(problems(other),
             Catch::StartsWith("/hinges/0/name: found string \"base\", expected another"));
}

TEST_CASE("Hinges form a tree in whatever order", "[scene_tree]") {
  const Scene scene = read_scene(tree("abcd", {"c d", "base a", "a c", "a b"}));
  CHECK(scene.hinges[0].parent == 2);
  CHECK(scene.hinges[0].child == 3);
  CHECK(scene.hinges[1].parent == base_index);
  CHECK(outward_order(scene) == std::vector<int>{1, 2, 0, 3});
}

TEST_CASE("Whatever keeps hinges from being a tree is told", "[scene_tree]") {
  struct Case {
    const char* bodies;
    std::vector<std::string> hinges;
    const char* message;
  };
  const Case given = GENERATE(values<Case>(
      {{"ab",
        {"base a", "x b"},
        "/hinges/1/parent: found string \"x\", expected \"base\" or a body's name"},
       {"ab",
        {"bse a", "a b"},
        "/hinges/0/parent: found string \"bse\", expected \"base\" or a body's name (did you mean "
        "\"base\"?)"},
       {"ab",
        {"base a", "a panel"},
        "/hinges/1/child: found string \"panel\", expected a body's name"},
       {"a", {" a"}, "/hinges/0/parent: found string \"\", expected \"base\" or a body's name"},
       {"a", {"a base"}, "/hinges/0/child: found string \"base\", expected a body's name"},
       {"ab",
        {"base a", "a b", "base b"},
        "/hinges/2/child: found string \"b\", the child of hinge \"1\" too, expected a body that "
        "is the "
        "child of no other hinge"},
       {"abc",
        {"base a", "a b"},
        "/bodies/2: found \"c\", the child of no hinge, expected a body that is the child of one "
        "hinge"},
       {"abcd",
        {"base a", "d b", "b c", "c d"},
        "/hinges/3/parent: found a cycle of parents: d < c < b < d, expected hinges that form a "
        "tree "
        "rooted at base"},
       {"ab",
        {"base a", "b b"},
        "/hinges/1/parent: found a cycle of parents: b < b, expected hinges that form a tree "
        "rooted at "
        "base"},
       // The body hangs on the cycle and is no part of it.
       {"abc",
        {"b a", "c b", "b c"},
        "/hinges/1/parent: found a cycle of parents: b < c < b, expected hinges that form a tree "
        "rooted "
        "at base"}}));
  CAPTURE(given.bodies, given.hinges);
  CHECK(test::facts_of(problems(tree(given.bodies, given.hinges))) ==
        test::facts_of(given.message));
}
