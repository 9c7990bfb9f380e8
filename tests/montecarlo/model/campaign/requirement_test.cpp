#include "montecarlo/model/campaign/requirement.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

const std::vector<std::string> columns{"root.peak_moment", "root.latch_rate", "deployment_time"};
const std::vector<std::string> all_columns{"root.peak_moment", "root.latch_rate", "root.peak_force",
                                           "deployment_time"};

std::vector<Requirement> read_list_of_requirements(const Json& document) {
  std::vector<Requirement> requirements;
  CHECK(test::problems_of(document, [&](const JsonCursor& at) {
          read_requirements(at, &columns, all_columns, requirements);
        }).empty());
  return requirements;
}

Json two() {
  return parse_json(R"([
    { "output": "root.peak_moment", "max": 400, "probability": 0.9973, "confidence": 0.9 },
    { "name": "M-12", "output": "root.latch_rate", "min": -1.5, "probability": 0.99,
      "confidence": 0.95 } ])");
}

} // namespace

TEST_CASE("Requirements are read, written in full and said in words", "[requirement]") {
  const std::vector<Requirement> requirements = read_list_of_requirements(two());
  REQUIRE(requirements.size() == 2);
  CHECK((requirements[0].max == 400 && !requirements[0].min));
  CHECK((requirements[1].min == -1.5 && requirements[1].confidence == 0.95));
  CHECK(write_requirements(requirements) == two());
  CHECK(to_string(requirements[0]) == "root.peak_moment ≤ 400 N·m, 99.73 % at 90 %");
  CHECK(to_string(requirements[1]) == "M-12: root.latch_rate ≥ -1.5 rad/s, 99 % at 95 %");
  const Json degrees = parse_json(
      R"([{ "output": "root.latch_rate", "max": "8 deg/s", "probability": 0.99, "confidence": 0.9 }])");
  CHECK(to_string(read_list_of_requirements(degrees)[0]) ==
        "root.latch_rate ≤ 8 deg/s, 99 % at 90 %");
  const Json deployed =
      parse_json(R"([{ "output": "deployed", "probability": 0.999, "confidence": 0.9 }])");
  CHECK(to_string(read_list_of_requirements(deployed)[0]) == "deployed, 99.9 % at 90 %");
  CHECK(write_requirements(read_list_of_requirements(deployed)) == deployed);
}

TEST_CASE("A requirement may have an identifier, a source and a rationale", "[requirement]") {
  Json given = two();
  given[0].update({{"id", "SYS-4"}, {"source", "ICD 3.2"}, {"rationale", "root fitting"}});
  const std::vector<Requirement> requirements = read_list_of_requirements(given);
  CHECK(requirements[0].id == "SYS-4");
  CHECK(requirements[0].source == "ICD 3.2");
  CHECK(requirements[0].rationale == "root fitting");
  CHECK(write_requirements(requirements) == given);
  given[1]["id"] = "SYS-4";
  std::vector<Requirement> repeated;
  CHECK(test::problems_of(given, [&](const JsonCursor& at) {
          read_requirements(at, &columns, all_columns, repeated);
        }) == "/1/id: found string \"SYS-4\" a second time, expected an identifier of its own");
  Json named = two();
  named[0]["name"] = named[1]["name"] = "T-1";
  CHECK_THAT(test::problems_of(named,
                               [&](const JsonCursor& at) {
                                 read_requirements(at, &columns, all_columns, repeated);
                               }),
             Catch::StartsWith("/1/name: found \"T-1\" a second time"));
}

TEST_CASE("A requirement that is stated twice is told with both places", "[requirement]") {
  const auto problems = [](const Json& given) {
    std::vector<Requirement> read;
    return test::problems_of(
        given, [&](const JsonCursor& at) { read_requirements(at, &columns, all_columns, read); });
  };
  Json given = two();
  given.push_back(given[1]);
  given[2].erase("name");
  CHECK(problems(given) ==
        "/2: found the requirement of /1 a second time, expected each requirement once");
  Json other = given;
  other[2]["confidence"] = 0.9;
  CHECK(problems(other).empty());
  other = given, other[2]["group"] = "loads";
  CHECK(problems(other).empty());
  other = given, other[2]["min"] = -1.6;
  CHECK(problems(other).empty());
}

TEST_CASE("A limit may have its unit", "[requirement]") {
  const Json given = parse_json(R"([
    { "output": "root.peak_moment", "max": "4 kN*m", "probability": 0.99, "confidence": 0.9 },
    { "output": "deployment_time", "min": "0.5 min", "probability": 0.99, "confidence": 0.9 }])");
  const std::vector<Requirement> requirements = read_list_of_requirements(given);
  CHECK(requirements[0].max == 4000);
  CHECK(requirements[1].min == 30);
  CHECK(write_requirements(requirements)[0]["max"] == 4000);
}

TEST_CASE("Each fault of a requirement is told", "[requirement]") {
  const test::Spoiled change = GENERATE(values<test::Spoiled>(
      {{"", "{}", "found an object, expected an array of requirements"},
       {"/0", "1", "/0: found 1, expected a requirement: an object"},
       {"/0/output", "", "/0/output: found nothing, expected a string, an output or \"deployed\""},
       {"/0/output", "\"root.peak_momnt\"",
        "/0/output: found string \"root.peak_momnt\", expected an output of the campaign, or "
        "\"deployed\" (did you mean \"root.peak_moment\"?)"},
       {"/0/output", "\"root.peak_force\"",
        "/0/output: found string \"root.peak_force\", expected an output that the campaign asks "
        "for (\"peak_force\" is not in its \"outputs\")"},
       {"/0/output", "\"deployed\"",
        "/0: found a limit, expected neither max nor min: a run has deployed or has not"},
       {"/0/max", "",
        "/0: found neither max nor min, expected one of them (for both, two "
        "requirements)"},
       {"/0/min", "1",
        "/0: found both max and min, expected one of them (for both, two "
        "requirements)"},
       {"/0/max", "\"400\"",
        "/0/max: found string \"400\", expected a number, N·m, or a string of a number and its "
        "unit: \"N*m\", \"N*mm\", \"in*lbf\", \"in*ozf\" or \"ft*lbf\""},
       {"/0/max", "[400]", "/0/max: found an array of 1, expected a number, in the output's unit"},
       {"/0/probability", "1", "/0/probability: found 1, expected a number, > 0 and < 1"},
       {"/0/probability", "", "/0/probability: found nothing, expected a number, > 0 and < 1"},
       {"/1/confidence", "90", "/1/confidence: found 90, expected a number, > 0 and < 1"},
       {"/1/name", "\"\"",
        "/1/name: found string \"\", expected a string, not empty, without control characters"},
       {"/1/minimum", "1",
        "/1/minimum: found the unknown key \"minimum\", expected \"name\", \"output\", \"max\", "
        "\"min\", \"abs\", \"group\", \"id\", \"source\", \"rationale\", \"probability\" or "
        "\"confidence\""},
       {"/1/abs", "1", "/1/abs: found 1, expected true or false"},
       {"/0/group", "\"\"",
        "/0/group: found string \"\", expected a string, not empty, without control characters"}}));
  CAPTURE(change.pointer, change.value);
  std::vector<Requirement> requirements;
  CHECK(test::facts_of(test::problems_of(test::spoil(two(), change), [&](const JsonCursor& at) {
          read_requirements(at, &columns, all_columns, requirements);
        })) == test::facts_of(change.message));
}

TEST_CASE("Without a scene no output is missed", "[requirement]") {
  std::vector<Requirement> requirements;
  CHECK(test::problems_of(two(), [&](const JsonCursor& at) {
          read_requirements(at, nullptr, {}, requirements);
        }).empty());
}

TEST_CASE("A limit may be on the magnitude, and requirements may share a confidence",
          "[requirement]") {
  Json document = two();
  document[1] = parse_json(R"({ "output": "root.latch_rate", "max": 1.5, "abs": true,
                                "probability": 0.99, "confidence": 0.9, "group": "A" })");
  document[0]["group"] = "A";
  document.push_back(
      parse_json(R"({ "output": "deployed", "probability": 0.99, "confidence": 0.95 })"));
  const std::vector<Requirement> requirements = read_list_of_requirements(document);
  CHECK((requirements[1].absolute && requirements[1].group == "A"));
  CHECK(write_requirements(requirements) == document);
  CHECK(to_string(requirements[1]) == "|root.latch_rate| ≤ 1.5 rad/s, 99 % at 90 % in group A");
  CHECK(confidence_alone(requirements, requirements[0]) ==
        Approx(0.95).epsilon(1e-15));                             // 1 − 0.1/2
  CHECK(confidence_alone(requirements, requirements[2]) == 0.95); // alone
}

TEST_CASE("A group has one confidence, and deployment no magnitude", "[requirement]") {
  Json document = two();
  document[0]["group"] = document[1]["group"] = "loads";
  document.push_back(parse_json(
      R"({ "output": "deployed", "abs": true, "probability": 0.99, "confidence": 0.95 })"));
  std::vector<Requirement> requirements;
  const std::string problems = test::problems_of(document, [&](const JsonCursor& at) {
    read_requirements(at, &columns, all_columns, requirements);
  });
  CHECK_THAT(problems, Catch::Contains("/2/abs: found true") && Catch::Contains("a limit"));
  CHECK_THAT(problems, Catch::Contains("/1/confidence: found 0.95, expected 0.9") &&
                           Catch::Contains("\"loads\""));
}

TEST_CASE("A limit on a time beyond the end of every run is refused", "[requirement]") {
  Json document = two();
  document[0]["output"] = "deployment_time";
  const double t_end = GENERATE(399.5, 400.); // s
  const std::vector<Requirement> requirements = read_list_of_requirements(document);
  const std::string problems = test::problems_of(
      document, [&](const JsonCursor& at) { refuse_late_limits(at, requirements, t_end); });
  if (t_end == 400)
    CHECK(problems.empty());
  else
    CHECK_THAT(problems,
               Catch::StartsWith("/0/max: found 400") && Catch::Contains("t_end, 399.5 s"));
}

namespace {

/// Two hinges, of which only the first has a spring.
Scene sprung() {
  Scene scene;
  scene.hinges.resize(2);
  scene.hinges[0].name = "root", scene.hinges[1].name = "tip";
  scene.hinges[0].spring = {2, 1};
  return scene;
}

std::string margin_problems(const Json& document, std::vector<Requirement>& requirements) {
  const Scene scene = sprung();
  return test::problems_of(document, [&](const JsonCursor& at) {
    read_requirements(at, &columns, all_columns, requirements, &scene);
  });
}

} // namespace

TEST_CASE(
    "A static margin is required by its standard and its hinge, at least 0 if nothing is said",
    "[requirement]") {
  std::vector<Requirement> requirements;
  CHECK(margin_problems(parse_json(R"([
          { "motorization": "NASA", "probability": 0.99, "confidence": 0.9 },
          { "name": "M-1", "motorization": "ECSS", "hinge": "root", "min": 0.25, "group": "A",
            "probability": 0.9, "confidence": 0.9 } ])"),
                        requirements)
            .empty());
  REQUIRE(requirements.size() == 2);
  CHECK(to_string(requirements[0]) == "NASA margin of every hinge ≥ 0, 99 % at 90 %");
  CHECK(to_string(requirements[1]) == "M-1: ECSS margin of root ≥ 0.25, 90 % at 90 % in group A");
  CHECK(requirements[0].static_margin == RequiredMargin{MarginKind::nasa, "*"});
  CHECK(write_requirements(requirements) == parse_json(R"([
    { "motorization": "NASA", "hinge": "*", "min": 0.0, "probability": 0.99, "confidence": 0.9 },
    { "name": "M-1", "motorization": "ECSS", "hinge": "root", "min": 0.25,
      "probability": 0.9, "confidence": 0.9, "group": "A" } ])"));
  std::vector<Requirement> again;
  CHECK(margin_problems(write_requirements(requirements), again).empty());
  CHECK(write_requirements(again) == write_requirements(requirements));
}

TEST_CASE("Each fault of a required margin is told", "[requirement]") {
  std::vector<Requirement> requirements;
  CHECK(margin_problems(parse_json(R"([
          { "motorization": "MIL", "hinge": "tip", "probability": 0.99, "confidence": 0.9 },
          { "motorization": "AIAA", "hinge": 1, "max": 2, "probability": 0.9, "confidence": 0.9 },
          { "motorization": "GEVS", "hinge": "rot", "output": "deployed", "probability": 0.9,
            "confidence": 0.9 } ])"),
                        requirements) ==
        "/0/motorization: found string \"MIL\", expected \"ECSS\", \"NASA\", "
        "\"NASA_one_spring_out\", \"GEVS\" or \"AIAA\"\n"
        "/0/hinge: found string \"tip\", expected the name of a hinge with a spring, a motor or a "
        "latch, or "
        "\"*\" for all\n"
        "/1/hinge: found 1, expected a string, a hinge's name, or \"*\" for all\n"
        "/1/max: found the unknown key \"max\", expected \"name\", \"motorization\", \"hinge\", "
        "\"min\", \"group\", \"id\", \"source\", \"rationale\", \"probability\" or \"confidence\"\n"
        "/2/hinge: found string \"rot\", expected the name of a hinge with a spring, a motor or a "
        "latch, or "
        "\"*\" for all (did you mean \"root\"?)\n"
        "/2/output: found the unknown key \"output\", expected \"name\", \"motorization\", "
        "\"hinge\", \"min\", \"group\", \"id\", \"source\", \"rationale\", \"probability\" or "
        "\"confidence\"");
}

TEST_CASE("a run without a value ranks where it breaks the output's requirements",
          "[requirement]") {
  const auto rank = [](const char* list, const char* output = "root.latch_rate") {
    Json json = parse_json(list);
    for (Json& each : json) each["probability"] = each["confidence"] = 0.9;
    return missing_rank(read_list_of_requirements(json), output);
  };
  const char *least = R"([{ "output": "root.latch_rate", "min": 1 }])",
             *most = R"([{ "output": "root.latch_rate", "max": 1 }])",
             *both = R"([{ "output": "root.latch_rate", "max": 1 },
                         { "output": "root.latch_rate", "min": -1 }])",
             *magnitude = R"([{ "output": "root.latch_rate", "max": 1, "abs": true }])",
             *least_magnitude = R"([{ "output": "root.latch_rate", "min": 1, "abs": true }])",
             *no_sign = R"([{ "output": "root.peak_moment", "min": 1, "abs": true }])";
  CHECK(rank("[]") == MissingRank::above);
  CHECK(rank(least) == MissingRank::below);
  CHECK(rank(least, "root.peak_moment") == MissingRank::above); // another output's requirement
  CHECK(rank(most) == MissingRank::above);
  CHECK(rank(both) == MissingRank::either);
  CHECK(rank(magnitude) == MissingRank::either);       // a large rate of either sign breaks it
  CHECK(rank(least_magnitude) == MissingRank::either); // a small rate of either sign does
  CHECK(rank(no_sign, "root.peak_moment") == MissingRank::below);
}
