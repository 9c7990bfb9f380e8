#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/describe.hpp"
#include "montecarlo/model/campaign/overrides.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/montecarlo/margin_support.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

Json small_margin() {
  return parse_json(
      R"({ "scale": ["hinges.*.spring.torque_stowed", "hinges.root.spring.torque_latched"],
                         "range": [0.5, 2] })");
}

Campaign read_margin(const Json& margin) {
  Json campaign = test::small_campaign();
  campaign["margin"] = margin;
  return read_campaign(campaign.dump(), "");
}

std::string margin_problems(const test::Spoiled& change) {
  return test::message_of([&] { return read_margin(test::spoil(small_margin(), change)); });
}

} // namespace

TEST_CASE("A margin is read with its defaults, and written in full", "[margin]") {
  const Campaign campaign = read_margin(small_margin());
  const MarginSpec& margin = campaign.margin.value();
  REQUIRE(margin.scaled.size() == 3);
  CHECK(path_of(campaign.scene, margin.scaled[2]) == "hinges.root.spring.torque_latched");
  CHECK((margin.lower == 0.5 && margin.upper == 2));
  CHECK((margin.mode == MarginMode::joint && margin.points == 13 && margin.edge_tolerance == 0.01));
  CHECK((margin.nominal && !margin.one_spring_out && campaign.motorization.springs_per_hinge == 2));
  CHECK(campaign.resolved["margin"] == parse_json(R"({
    "scale": ["hinges.root.spring.torque_stowed", "hinges.mid.spring.torque_stowed",
              "hinges.root.spring.torque_latched"],
    "range": [0.5, 2.0], "widest": [0.0625, 16.0], "mode": "joint", "points": 13, "tolerance": 0.01, "cases": ["nominal"],
    "springs_per_hinge": 2,
    "motorization": {
      "ecss": { "basis": "theoretical", "inertia": 1.1, "spring": 1.2, "motor": 1.5,
                "friction": 3.0, "hysteresis": 3.0, "harness": 3.0, "adhesion": 3.0,
                "motorization": 2.0, "acceleration": 1.25, "available": 0.8 },
      "nasa": { "basis": "analysis", "fixed": 1.5, "variable": 3.0 },
      "gevs": { "phase": "critical_design", "known": 1.5, "variable": 3.0 },
      "aiaa": { "phase": "critical_design", "known": 1.5, "variable": 3.0 },
      "torques": {
        "root": { "inertia": 0.0, "motor": 0.0, "hysteresis": 0.0, "adhesion": 0.0,
                  "acceleration": 0.0, "delivered": 0.0 },
        "mid": { "inertia": 0.0, "motor": 0.0, "hysteresis": 0.0, "adhesion": 0.0,
                 "acceleration": 0.0, "delivered": 0.0 } },
      "rates": { "root": 0.0, "mid": 0.0 },
      "points": 21 } })"));
  CHECK(read_campaign(campaign.resolved.dump(), "").resolved == campaign.resolved);
  CHECK_THAT(describe(campaign),
             Catch::EndsWith("margin: hinges.root.spring.torque_stowed, "
                             "hinges.mid.spring.torque_stowed, hinges.root.spring.torque_latched "
                             "scaled by 0.5 to 2, all together, no spring lost\n"));
}

// NASA-STD-5017B: the factors fall with what is known of the torques.
TEST_CASE("NASA's factors are those of their basis", "[margin]") {
  for (const auto& [basis, fixed, variable] : {std::tuple{"analysis", 1.5, 3.0},
                                               {"development_test", 1.35, 2.5},
                                               {"acceptance", 1.25, 2.0}}) {
    CAPTURE(basis);
    Json margin = small_margin();
    margin["motorization"]["nasa"]["basis"] = basis;
    const NasaFactors nasa = read_margin(margin).motorization.nasa;
    CHECK((nasa.fixed == fixed && nasa.variable == variable));
  }
}

TEST_CASE("A campaign without a margin is the one that it was", "[margin]") {
  CHECK_FALSE(read_campaign(test::small_campaign().dump(), "").resolved.contains("margin"));
}

TEST_CASE("What a margin sets otherwise is read too", "[margin]") {
  Json json = small_margin();
  json.update(parse_json(R"({
    "mode": "each", "points": 2, "widest": [0.5, 3], "tolerance": 0.001, "cases": ["one_spring_out"],
    "springs_per_hinge": 4,
    "motorization": { "ecss": { "friction": 2, "basis": "measured" }, "points": 5,
                      "nasa": { "basis": "development_test", "variable": 2.2 },
                      "gevs": { "variable": 2.5, "phase": "test" },
                      "aiaa": { "phase": "preliminary_design", "known": 1.25 },
                      "torques": { "mid": { "hysteresis": "250 N*mm" } },
                      "rates": { "mid": "180 deg/s" } } })"));
  const Campaign campaign = read_margin(json);
  const MarginSpec& margin = *campaign.margin;
  CHECK((margin.lowest == 0.5 && margin.highest == 3));
  CHECK((margin.mode == MarginMode::each && !margin.nominal && margin.one_spring_out));
  const StaticMarginSpec& factors = campaign.motorization;
  CHECK(factors.springs_per_hinge == 4);
  CHECK((factors.gevs.known == 1.5 && factors.gevs.variable == 2.5));
  CHECK((factors.aiaa.known == 1.25 && factors.aiaa.variable == 4));
  CHECK((factors.rates[0] == 0 && factors.rates[1] == Approx(3.14159265358979)));
  CHECK((factors.ecss.friction == 2 && factors.ecss.harness == 1.5 && factors.ecss.motor == 1.2));
  CHECK((factors.nasa.fixed == 1.35 && factors.nasa.variable == 2.2));
  CHECK((factors.torques[0].hysteresis == 0 && factors.torques[1].hysteresis == 0.25));
  CHECK(read_campaign(campaign.resolved.dump(), "").resolved == campaign.resolved);
  CHECK_THAT(describe(campaign), Catch::Contains("hinge by hinge, with a spring lost"));
}

TEST_CASE("Each fault of a margin is told", "[margin]") {
  const test::Spoiled change = GENERATE(values<test::Spoiled>(
      {{"", "3", "/margin: found 3, expected what to size: an object"},
       {"/scale", "", "/margin/scale: found nothing, expected the paths of the parameters to size"},
       {"/scale", "[]",
        "/margin/scale: found an array of 0, expected an array of at least one parameter's path"},
       {"/scale/1", "\"hinges.root.spring.torque\"",
        "/margin/scale/1: found string \"hinges.root.spring.torque\", expected the path of a "
        "parameter (did you mean \"hinges.root.spring.scale\"?)"},
       {"/scale/1", "\"hinges.mid.spring.torque_stowed\"",
        "/margin/scale/1: found hinges.mid.spring.torque_stowed a second time, expected each "
        "parameter once"},
       {"/range", "",
        "/margin/range: found nothing, expected two numbers > 0, the first below the "
        "second"},
       {"/range", "[2, 0.5]",
        "/margin/range: found 2 and 0.5, expected two numbers > 0, the first below the "
        "second"},
       {"/range", "[0, 1]",
        "/margin/range: found 0 and 1, expected two numbers > 0, the first below the "
        "second"},
       {"/range", "[1]",
        "/margin/range: found an array of 1, expected two numbers > 0, the first "
        "below the second"},
       {"/widest", "[0.6, 16]",
        "/margin/widest: found 0.6 and 16, expected an array of two numbers > 0, about "
        "\"range\""},
       {"/widest", "[0.5]",
        "/margin/widest: found an array of 1, expected an array of two numbers > 0, about "
        "\"range\""},
       {"/mode", "\"both\"", "/margin/mode: found string \"both\", expected \"joint\" or \"each\""},
       {"/points", "1", "/margin/points: found 1, expected an integer from 2 to 1000"},
       {"/tolerance", "0", "/margin/tolerance: found 0, expected a number, > 0 and < 1"},
       {"/cases", "[]",
        "/margin/cases: found an array of 0, expected an array of \"nominal\" or "
        "\"one_spring_out\""},
       {"/cases", R"(["nominal", "nominal"])",
        "/margin/cases/1: found string \"nominal\" a second time, expected each case once"},
       {"/springs_per_hinge", "1", "/margin/springs_per_hinge: found 1, expected an integer, ≥ 2"},
       {"/steps", "9",
        "/margin/steps: found the unknown key \"steps\", expected \"scale\", \"range\", "
        "\"widest\", "
        "\"mode\", \"points\", \"tolerance\", \"cases\", \"springs_per_hinge\" or "
        "\"motorization\""},
       {"/motorization", R"({"ecss": {"friction": 0}})",
        "/margin/motorization/ecss/friction: found 0, expected a factor: a number, > 0"},
       {"/motorization", R"({"nasa": {"basis": "guess"}})",
        "/margin/motorization/nasa/basis: found string \"guess\", expected \"analysis\", "
        "\"development_test\" or \"acceptance\""},
       {"/motorization", R"({"torques": {"rot": {}}})",
        "/margin/motorization/torques/rot: found the unknown key \"rot\", expected \"root\" or "
        "\"mid\" (did you mean \"root\"?)"},
       {"/motorization", R"({"torques": {"mid": {"friction": 1}}})",
        "/margin/motorization/torques/mid/friction: found the unknown key \"friction\", expected "
        "\"inertia\", \"motor\", \"hysteresis\", \"adhesion\", \"acceleration\" or \"delivered\""},
       {"/motorization", R"({"torques": {"mid": {"adhesion": -1}}})",
        "/margin/motorization/torques/mid/adhesion: found -1, expected a number, N·m, ≥ 0"},
       {"/motorization", R"({"gevs": {"phase": "late"}})",
        "/margin/motorization/gevs/phase: found string \"late\", expected \"preliminary_design\", "
        "\"critical_design\" or \"test\""},
       {"/motorization", R"({"aiaa": {"known": -1}})",
        "/margin/motorization/aiaa/known: found -1, expected a factor: a number, > 0"},
       {"/motorization", R"({"rates": {"mid": -1}})",
        "/margin/motorization/rates/mid: found -1, expected a number, rad/s, ≥ 0"},
       {"/motorization", R"({"points": 1})",
        "/margin/motorization/points: found 1, expected an integer from 2 to 1000"}}));
  CAPTURE(change.pointer, change.value);
  CHECK(test::facts_of(margin_problems(change)) == test::facts_of(change.message));
}

TEST_CASE("the numbers of a margin study are accepted up to their limits, and no further",
          "[margin]") {
  const auto check = [](const char* pointer, const char* good, const char* bad) {
    CAPTURE(pointer, good, bad);
    CHECK(margin_problems({pointer, good, ""}).empty());
    CHECK_THAT(margin_problems({pointer, bad, ""}), Catch::StartsWith("/margin/"));
  };
  check("/points", "2", "1");
  check("/points", "1000", "1001");
  check("/tolerance", "1e-9", "0");
  check("/tolerance", "0.99", "1");
  check("/springs_per_hinge", "2", "1");
  check("/motorization", R"({"points": 2})", R"({"points": 1})");
  check("/motorization", R"({"points": 1000})", R"({"points": 1001})");
  check("/motorization", R"({"rates": {"mid": 0}})", R"({"rates": {"mid": -1e-9}})");
  check("/motorization", R"({"nasa": {"variable": 1e-9}})", R"({"nasa": {"variable": 0}})");
}

TEST_CASE("What does not go with the sized parameters is refused", "[margin]") {
  Json json = small_margin();
  json["scale"] = {"bodies.*.mass"};
  json["mode"] = "each";
  json["cases"] = {"nominal", "one_spring_out"};
  CHECK(test::message_of([&] { return read_margin(json); }) ==
        "/margin/mode: found \"each\" with a parameter that is not a hinge's, expected parameters "
        "of hinges\n"
        "/margin/cases: found \"one_spring_out\" with no spring's torque in \"scale\", expected a "
        "spring that can be lost");
}

TEST_CASE("A spring is lost as a whole, its offset too", "[margin]") {
  const Scene scene = read_scene(test::real_scene()); // root's is measured, mid's is linear
  const auto paths = [&](int hinge) { return paths_of(scene, spring_torques(scene, hinge)); };
  CHECK(paths(0) ==
        std::vector<std::string>{"hinges.root.spring.scale", "hinges.root.spring.offset"});
  CHECK(paths(1) == std::vector<std::string>{"hinges.mid.spring.torque_stowed",
                                             "hinges.mid.spring.torque_latched",
                                             "hinges.mid.spring.offset"});
  const auto sizes = [&](const char* path, int hinge) {
    const SceneParameter parameter = resolve(scene, path).matches.at(0).parameter;
    return sizes_spring({&parameter, 1}, scene, hinge);
  };
  CHECK(sizes("hinges.root.spring.scale", 0));
  CHECK(sizes("hinges.mid.spring.scale", 1));
  CHECK(sizes("hinges.mid.spring.torque_latched", 1));
  CHECK_FALSE(sizes("hinges.mid.spring.scale", 0));
  CHECK_FALSE(sizes("hinges.root.spring.offset", 0));
  CHECK_FALSE(sizes("synchronisations.loop.stiffness", 0));
}

TEST_CASE("How static margins are judged may stand in the campaign itself, once", "[margin]") {
  Json json = test::small_campaign();
  json["motorization"] = parse_json(R"({ "nasa": { "variable": 2.5 }, "springs_per_hinge": 3 })");
  const Campaign campaign = read_campaign(json.dump(), "");
  CHECK(
      (campaign.motorization.nasa.variable == 2.5 && campaign.motorization.springs_per_hinge == 3));
  CHECK(campaign.resolved["motorization"]["nasa"]["variable"] == 2.5);
  CHECK(campaign.resolved["motorization"]["springs_per_hinge"] == 3);
  CHECK(read_campaign(campaign.resolved.dump(), "").resolved == campaign.resolved);
  json["motorization"] = parse_json(R"({ "nasa": { "variable": 3 } })"); // the standard's
  CHECK_FALSE(read_campaign(json.dump(), "").resolved.contains("motorization"));
  json["motorization"]["nasa"]["variable"] = 2.5;
  json["margin"] = small_margin(); // goes by it
  const Json resolved = read_campaign(json.dump(), "").resolved;
  CHECK(resolved["margin"]["motorization"]["nasa"]["variable"] == 2.5);
  CHECK_FALSE(resolved.contains("motorization"));
  json["margin"]["motorization"] = Json::object();
  CHECK(test::message_of([&] { return read_campaign(json.dump(), ""); }) ==
        "/margin/motorization: found \"motorization\" a second time, expected the key once: here "
        "or in "
        "the campaign");
}

TEST_CASE("where --scale names no spring, the campaign's case of a lost spring is left out",
          "[margin]") {
  Json json = test::one_panel_margin(10);
  json["margin"]["cases"] = {"nominal", "one_spring_out"};
  const auto with = [&](const std::vector<std::string>& scale) {
    Campaign campaign = test::campaign_of(json);
    override_margin(campaign, scale, {0.9, 1.1});
    return std::pair(campaign.margin->nominal, campaign.margin->one_spring_out);
  };
  CHECK(with({}) == std::pair(true, true));
  CHECK(with({"hinges.root.spring.torque_latched"}) == std::pair(true, true));
  CHECK(with({"hinges.*.spring.scale", "hinges.root.latch.damping"}) == std::pair(true, true));
  CHECK(with({"hinges.root.latch.damping"}) == std::pair(true, false));
}
