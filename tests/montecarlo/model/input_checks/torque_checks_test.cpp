#include "montecarlo/model/input_checks/torque_checks.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <functional>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// What is said of the springs where the second hinge's spring, harness and friction are given.
std::vector<std::string> told(const char* spring, const char* harness, double coulomb,
                              bool coupled = false) {
  Json document = small_scene();
  Json& hinge = document["hinges"][1];
  hinge["spring"] = parse_json(spring), hinge["harness"] = parse_json(harness);
  hinge["friction"] = {{"coulomb", coulomb}, {"viscous", 0}, {"regularization_rate", 0.002}};
  if (coupled)
    document["synchronisations"] = parse_json(R"([ { "name": "loop", "between": ["root", "mid"],
      "ratio": 2, "stiffness": 300, "damping": 0.5, "preload": 8 } ])");
  InputWarnings warnings({"wing.json", ""});
  check_torques(read_scene(document), warnings);
  std::vector<std::string> of_torques;
  for (const InputWarning& warning : warnings.list())
    if (warning.pointer.ends_with("/spring")) of_torques.push_back(to_string(warning));
  return of_torques;
}

} // namespace

TEST_CASE("a torque that does not deploy is named once, by its cause") {
  const char* const deploys = R"({"torque_stowed": 1, "torque_latched": 0.5})";
  const char* const none = R"({"torque_stowed": 0, "torque_latched": 0})";
  CHECK(told(deploys, none, 0.4).empty());
  CHECK(told(none, none, 0).empty());
  const auto pushes = told(R"({"torque_stowed": 1, "torque_latched": -0.5})", none, 0.4);
  REQUIRE(pushes.size() == 1);
  CHECK_THAT(pushes[0], Catch::Contains("-0.5 N·m") && Catch::Contains("pushes away"));
  // a drive of two hinges lacks torque by that spring alone
  const auto drive = told(R"({"torque_stowed": -5, "torque_latched": -5})", none, 0.4, true);
  REQUIRE(drive.size() == 1);
  CHECK_THAT(drive[0], Catch::Contains("/hinges/1/spring") && Catch::Contains("pushes away"));
  const auto weak = told(none, R"({"torque_stowed": 5, "torque_latched": 5})", 0.4, true);
  REQUIRE(weak.size() == 1);
  CHECK_THAT(weak[0], Catch::Contains("a net static torque of") && Catch::Contains("mid"));
  for (const auto& lacking : {told(deploys, none, 0.6), told(deploys, deploys, 0.1)}) {
    REQUIRE(lacking.size() == 1);
    CHECK_THAT(lacking[0], Catch::Contains("a net static torque of -0.1 N·m"));
  }
}

// -0.02094 N·m by SciPy's PchipInterpolator, between eighths of the pieces, at whose ends it is 0.0037 N·m or more.
TEST_CASE("a net torque that is least between eighths of a table's piece is found") {
  const auto lacking =
      told(R"({ "table": { "angle": [-3, -2.43, 0], "torque": [5.32, 1.18, 3.86] } })",
           R"({ "table": { "angle": [-3, -1.02, 0], "torque": [2.28, 0.33, 1.61] } })", 0);
  REQUIRE(lacking.size() == 1);
  CHECK_THAT(lacking[0], Catch::Contains("a net static torque of -0.02094 N·m at -2.46"));
}

TEST_CASE("the net torque of a hinge with a motor names it") {
  Json document = small_scene();
  document["hinges"][0]["spring"] = parse_json(R"({"torque_stowed": 0.1, "torque_latched": 0.1})");
  document["hinges"][0]["harness"] = parse_json(R"({"torque_stowed": 5, "torque_latched": 5})");
  document["hinges"][0]["motor"] =
      parse_json(R"({ "rate": -0.1, "torque_limit": 1, "gain": 100 })");
  InputWarnings warnings({"wing.json", ""});
  check_torques(read_scene(document), warnings);
  const auto list = warnings.list();
  const auto of_motor = std::ranges::find(list, "/hinges/0/spring", &InputWarning::pointer);
  REQUIRE(of_motor != list.end());
  CHECK_THAT(of_motor->found, Catch::Contains("spring and motor less harness"));
}

TEST_CASE("a wing that nothing moves is told") {
  const auto is_told = [](const std::function<void(Json&)>& change) {
    Json document = small_scene();
    for (Json& hinge : document["hinges"]) {
      hinge["spring"] = parse_json(R"({"torque_stowed": 0, "torque_latched": 0})");
      for (const char* term : {"harness", "friction", "initial_rate"}) hinge.erase(term);
    }
    change(document);
    InputWarnings warnings({"wing.json", ""});
    check_torques(read_scene(document), warnings);
    return std::ranges::any_of(warnings.list(), [](const InputWarning& warning) {
      return warning.pointer == "/hinges" &&
             warning.usual.find("nothing moves") != std::string::npos;
    });
  };
  CHECK(is_told([](Json&) {}));
  CHECK_FALSE(is_told([](Json& document) { document["hinges"][1]["initial_rate"] = 0.1; }));
  CHECK_FALSE(is_told([](Json& document) {
    document["hinges"][1]["spring"] = parse_json(R"({"torque_stowed": 0, "torque_latched": 0.1})");
  }));
  CHECK_FALSE(is_told([](Json& document) { document["environment"]["gravity"] = {0, -1}; }));
}

TEST_CASE("a wing that its torques hold in balance at the start, without friction, is warned of") {
  const auto told_balanced = [](const std::function<void(Json&)>& change) {
    Json document = small_scene();
    for (Json& hinge : document["hinges"]) {
      hinge["spring"] = parse_json(R"({"torque_stowed": 2, "torque_latched": 1.4})");
      hinge["harness"] = parse_json(R"({"torque_stowed": 2, "torque_latched": 0})");
      hinge.erase("friction"), hinge.erase("initial_rate");
    }
    change(document);
    InputWarnings warnings({"wing.json", ""});
    check_torques(read_scene(document), warnings);
    return std::ranges::any_of(warnings.list(), [](const InputWarning& warning) {
      return warning.pointer == "/hinges" && warning.found.find("cancel") != std::string::npos;
    });
  };
  CHECK(told_balanced([](Json&) {}));
  CHECK(told_balanced([](Json& wing) { // a hinge without any torque moves nothing
    for (const char* law : {"spring", "harness"})
      wing["hinges"][1][law] = parse_json(R"({"torque_stowed": 0, "torque_latched": 0})");
  }));
  CHECK_FALSE(
      told_balanced([](Json& wing) { wing["hinges"][0]["spring"]["torque_stowed"] = 2.001; }));
  CHECK_FALSE(told_balanced([](Json& wing) { wing["hinges"][1]["initial_rate"] = 0.1; }));
  CHECK_FALSE(told_balanced([](Json& wing) {
    wing["hinges"][0]["friction"] = {
        {"coulomb", 0.1}, {"viscous", 0}, {"regularization_rate", 0.002}};
  }));
  CHECK_FALSE(told_balanced([](Json& wing) { wing["environment"]["gravity"] = {0, -1}; }));
}
