#include "montecarlo/model/campaign/cases.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// The small campaign with a temperature that drives friction, and three cases.
Json campaign_with_cases() {
  Json campaign = small_campaign();
  campaign["dispersions"].push_back(parse_json(R"({
    "name": "temperature", "distribution": { "type": "normal", "mean": 20, "std": 5 },
    "through": [ { "to": ["hinges.*.friction.coulomb"], "apply": "add",
                   "table": { "at": [-100, 20, 60], "value": [0.3, 0, 0] } } ] })"));
  campaign["cases"] = parse_json(R"([
    { "name": "cold", "distributions": { "temperature": { "type": "normal", "mean": -60, "std": 3 } } },
    { "name": "ambient" },
    { "name": "old", "add": { "hinges.root.harness.offset": "20 N*mm" },
      "scale": { "hinges.*.spring.scale": 0.5 }, "set": { "hinges.root.spring.scale": 1.5 } } ])");
  return campaign;
}

std::string problems_with(const Spoiled& change) {
  return message_of([&] { return campaign_of(spoil(campaign_with_cases(), change)); });
}

} // namespace

TEST_CASE("A case changes the nominal scene: it sets, then scales, then adds", "[cases]") {
  const Campaign campaign = campaign_of(campaign_with_cases());
  REQUIRE(campaign.cases.size() == 3);
  CHECK(campaign.cases[2].name == "old");
  const Scene old = scene_of_case(campaign.scene, campaign.cases[2]);
  CHECK(old.hinges[0].spring.scale == 1.5 * 0.5);
  CHECK(old.hinges[1].spring.scale == 0.5);
  CHECK(old.hinges[0].harness.offset == 0.02); // N·m
  CHECK(campaign.scene.hinges[0].spring.scale == 1);
  CHECK(write_scene(scene_of_case(campaign.scene, campaign.cases[1])) ==
        write_scene(campaign.scene));
}

TEST_CASE("Every dispersion of the nominal scene is at the median of its case's law", "[cases]") {
  Json document = campaign_with_cases();
  const auto disperse = [&](const char* entry) {
    document["dispersions"].push_back(parse_json(entry));
  };
  disperse(
      R"({ "name": "lot", "distribution": { "type": "discrete", "values": [1, 1.5, 2], "weights": [3, 4, 3] },
                "apply": "scale", "to": ["hinges.root.spring.scale"] })");
  disperse(
      R"({ "name": "bearing", "distribution": { "type": "empirical", "values": [0.1, 0.5, 0.2] },
                "apply": "add", "to": ["hinges.root.friction.coulomb"] })");
  document["correlations"] =
      parse_json(R"([{ "between": ["temperature", "bearing"], "spearman": 0.5 }])");
  document["dispersions"][document["dispersions"].size() - 3]["through"][0]["table"] =
      parse_json(R"({ "at": [-100, -60, 20], "value": [0.5, 0.3, 0] })");
  document["cases"][2]["distributions"] = parse_json(
      R"({ "lot": { "type": "constant", "value": 3 }, "temperature": { "type": "constant", "value": -100 } })");
  std::vector<std::vector<double>> found; // spring, friction
  for (const Campaign& its : campaigns_of(campaign_of(document))) {
    const Hinge root = nominal_scene(its).hinges[0];
    found.push_back(
        {root.spring.scale, root.friction.coulomb - its.scene.hinges[0].friction.coulomb});
  }
  REQUIRE(found.size() == 3);
  const std::vector<std::vector<double>> by_hand{{1.5, 0.5}, {1.5, 0.2}, {0.75 * 3, 0.7}};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 2; ++i) CHECK(found[k][i] == Approx(by_hand[k][i]).epsilon(1e-14));
}

TEST_CASE("A case is a campaign of its own, with the same draws", "[cases]") {
  const Campaign campaign = campaign_of(campaign_with_cases());
  const std::vector<Campaign> all = campaigns_of(campaign);
  REQUIRE(all.size() == 3);
  CHECK(all[2].of_case == "old");
  CHECK(all[2].cases.empty());
  CHECK(all[2].scene.hinges[0].spring.scale == 0.75);
  CHECK(campaign_of(all[2].resolved).resolved == all[2].resolved);
  std::vector<std::vector<double>> draws;
  for (const Campaign& its : all) {
    draws.emplace_back(its.dispersions.size());
    RunPlan(its).draw(17, draws.back());
  }
  CHECK(draws[1] == draws[2]);
  CHECK(std::vector(draws[0].begin(), draws[0].begin() + 3) ==
        std::vector(draws[1].begin(), draws[1].begin() + 3));
  // Of another law the draw has the same place: −60 + 3 z where the campaign has 20 + 5 z.
  CHECK(draws[0][3] == Approx(-60 + 3 * (draws[1][3] - 20) / 5).epsilon(1e-14));
  CHECK(campaigns_of(campaign_of(small_campaign())).size() == 1);
}

// The covariance is that of the campaign's laws: with a case's law their coefficient holds, and with it the draws.
TEST_CASE("A case's law beside a covariance keeps the draws", "[cases][correlations]") {
  Json document = small_campaign();
  document["dispersions"] = Json::array();
  for (const char* name : {"spring", "other"})
    document["dispersions"].push_back(
        {{"name", name},
         {"distribution", {{"type", "normal"}, {"mean", 1}, {"std", 0.1}}},
         {"apply", "scale"},
         {"to", {"hinges.root.spring.scale"}}});
  document["correlations"] = {{{"between", {"spring", "other"}}, {"covariance", 0.009}}};
  document["cases"] = parse_json(R"([ { "name": "plain" },
    { "name": "wide", "distributions": { "other": { "type": "normal", "mean": 1, "std": 0.2 } } },
    { "name": "narrow", "distributions": { "spring": { "type": "normal", "mean": 1, "std": 0.05 } } },
    { "name": "flat", "distributions": { "other": { "type": "uniform", "lower": 0, "upper": 1 } } } ])");
  const std::vector<Campaign> all = campaigns_of(campaign_of(document));
  REQUIRE(all.size() == 4);
  const double coefficient = all[0].wanted_correlations.at(0).spearman;
  CHECK(coefficient == Approx(6 / std::numbers::pi * std::asin(0.45)).epsilon(1e-12));
  const auto scores = [](const Campaign& campaign) { // of the draws, by their laws
    std::vector<double> draws(2);
    RunPlan(campaign).draw(17, draws);
    for (std::size_t i = 0; i < 2; ++i) {
      const Law& law = campaign.dispersions[i].distribution.law;
      if (const auto* normal = std::get_if<Normal>(&law))
        draws[i] = 0.5 * std::erfc((normal->mean - draws[i]) / normal->std / std::sqrt(2.0));
    }
    return draws;
  };
  for (const Campaign& campaign : all) {
    CHECK(campaign.wanted_correlations.at(0).spearman == coefficient);
    for (std::size_t i = 0; i < 2; ++i)
      CHECK(scores(campaign)[i] == Approx(scores(all[0])[i]).epsilon(1e-12));
    CHECK(campaign_of(campaign.resolved).resolved == campaign.resolved);
  }
  CHECK(all[0].resolved["correlations"][0].contains("covariance"));
}

TEST_CASE("Cases are resolved in SI, and read back to themselves", "[cases]") {
  const Campaign campaign = campaign_of(campaign_with_cases());
  CHECK(
      campaign.resolved["cases"].dump() ==
      R"([{"name":"cold","distributions":{"temperature":{"type":"normal","mean":-60.0,"std":3.0}}},)"
      R"({"name":"ambient"},)"
      R"({"name":"old","set":{"hinges.root.spring.scale":1.5},"scale":{"hinges.*.spring.scale":0.5},)"
      R"("add":{"hinges.root.harness.offset":0.02}}])");
  CHECK(campaign_of(campaign.resolved).resolved == campaign.resolved);
}

TEST_CASE("Each fault of a case is told", "[cases]") {
  struct Case {
    const char *pointer, *value, *message;
  };
  const auto [pointer, value, message] = GENERATE(values<Case>(
      {{"/cases", "3", "/cases: found 3, expected an array of cases"},
       {"/cases/1", "3", "/cases/1: found 3, expected a case: an object"},
       {"/cases/1/nam", "3",
        "/cases/1/nam: found the unknown key \"nam\", expected \"name\", \"set\", \"scale\", "
        "\"add\" or \"distributions\" (did you mean \"name\"?)"},
       {"/cases/1/name", "\"a b\"",
        "/cases/1/name: found string \"a b\", expected a string, the name of a folder: letters, "
        "digits, \"_\" and \"-\""},
       {"/cases/1/name", "\"cold\"",
        "/cases/1/name: found \"cold\", the name of another case too, expected a name of its own"},
       {"/cases/1/set", "[]",
        "/cases/1/set: found an array of 0, expected an object with numbers by the paths of "
        "parameters"},
       {"/cases/1/set", R"({"hinges.root.sprng.scale": 1})",
        "/cases/1/set/hinges.root.sprng.scale: found the path \"hinges.root.sprng.scale\", "
        "expected "
        "the path of a parameter (did you mean \"hinges.root.spring.scale\"?)"},
       {"/cases/1/set", R"({"hinges.root.latch": 1})",
        "/cases/1/set/hinges.root.latch: found the path \"hinges.root.latch\", expected the path "
        "of a "
        "parameter (did you mean \"hinges.root.angle.latched\"?)"},
       {"/cases/1/set", R"({"bodies.inner.inertia": "2 kg"})",
        "/cases/1/set/bodies.inner.inertia: found string \"2 kg\", expected a number, kg·m², or a "
        "string of a number and its unit: \"kg*m^2\", \"kg*mm^2\", \"lb*in^2\" or \"slug*ft^2\""},
       {"/cases/1/scale", R"({"bodies.*.inertia": 2, "bodies.inner.inertia": 3})",
        "/cases/1/scale/bodies.inner.inertia: found bodies.inner.inertia a second time, expected "
        "each "
        "parameter once"},
       {"/cases/1/scale", R"({"bodies.outer.mass": 2})",
        "/cases/1/scale/bodies.outer.mass: found a change of bodies.outer.mass, which "
        "\"mass.outer\" "
        "sets in every run, expected a parameter that no dispersion sets (\"distributions\" gives "
        "that one another law in a case)"},
       {"/cases/1/scale", R"({"bodies.outer.inertia": -1})",
        "/cases/1: found bodies.outer.inertia of -0.25, expected > 0, in the case too"},
       {"/cases/1/set", R"({"bodies.outer.inertia": "-250 kg*mm^2"})",
        "/cases/1: found bodies.outer.inertia of \"-250 kg*mm^2\", expected > 0, in the case too"},
       {"/cases/1/distributions", "3",
        "/cases/1/distributions: found 3, expected an object with distributions by the names of "
        "dispersions"},
       {"/cases/1/distributions", R"({"temperatur": {"type": "constant", "value": 3}})",
        "/cases/1/distributions/temperatur: found \"temperatur\", expected the name of a "
        "dispersion "
        "(did you mean \"temperature\"?)"},
       {"/cases/1/distributions", R"({"mass": {"type": "constant", "value": "3 m"}})",
        "/cases/1/distributions/mass/value: found string \"3 m\", expected a number, kg, or a "
        "string "
        "of a number and its unit: \"kg\", \"g\", \"lb\", \"lbm\" or \"slug\""},
       {"/case", "\"cold\"",
        "/case: found string \"cold\", expected no case of another campaign beside \"cases\""}}));
  CAPTURE(pointer, value);
  CHECK(facts_of(problems_with({pointer, value, ""})) == facts_of(message));
}

TEST_CASE("Cases whose names are refused are not said to have one name", "[cases]") {
  Json document = campaign_with_cases();
  document["cases"][0]["name"] = "a/b", document["cases"][2]["name"] = "c/d";
  const std::string message = message_of([&] { return campaign_of(document); });
  CHECK_THAT(message, Catch::Contains("/cases/0/name: found string \"a/b\"") &&
                          Catch::Contains("/cases/2/name: found string \"c/d\"") &&
                          !Catch::Contains("another case"));
}

TEST_CASE("The law of an `each` is another for all of its copies", "[cases]") {
  Json document = campaign_with_cases();
  document["cases"][1]["distributions"]["mass"] =
      parse_json(R"({"type": "constant", "value": "8 kg"})");
  const Campaign its = campaigns_of(campaign_of(document))[1];
  std::vector<double> draws(4);
  RunPlan(its).draw(0, draws);
  CHECK(draws[1] == 8);
  CHECK(draws[2] == 8);
}

TEST_CASE("A quantity of an unknown parameter is no further fault", "[cases]") {
  Json document = test::small_campaign();
  document["dispersions"] = parse_json(R"([
    { "name": "a", "distribution": { "type": "normal", "mean": "2 N*m", "std": "0.1 N*m",
      "truncate": { "lower": "1 N*m" } }, "apply": "set", "to": ["hinges.root.friction.coulomb"] },
    { "name": "b", "distribution": { "type": "uniform", "lower": "7 kg", "upper": 9 },
      "apply": "add", "each": "bodies.*.mass" },
    { "name": "c", "distribution": { "type": "uniform", "lower": 0, "upper": 1 }, "through": [
      { "to": ["hinges.root.friction.viscous"], "apply": "set",
        "table": { "at": [0, 1], "value": ["1 N*m*s/rad", "2 N*m*s/rad"] } } ] } ])");
  document["cases"] = parse_json(R"([{ "name": "cold", "distributions": {
    "a": { "type": "constant", "value": "3 N*m" } } }])");
  const auto message = [&] {
    return test::message_of([&] { (void)read_campaign(document.dump(), ""); });
  };
  REQUIRE(message().empty());
  const Json whole = document;
  document["scene"] = "none.json";
  CHECK(message() ==
        "/scene: found no file that can be read at \"none.json\", expected a scene, or "
        "the name of the file that holds it");
  document = whole; // a misspelt path is the same for its own draws and for the case's
  document["dispersions"][0]["to"][0] = "hinges.root.friction.culomb";
  document["dispersions"][2]["through"][0]["to"][0] = "hinges.root.friction.viscos";
  CHECK_THAT(message(),
             Catch::Contains("culomb") && Catch::Contains("viscos") && !Catch::Contains("N*m"));
  document = whole; // other faults are told beside the scene's
  document["scene"] = "none.json";
  document["dispersions"][0]["distribution"]["std"] = "much";
  document["dispersions"][1]["distribution"]["type"] = "unifrm";
  CHECK_THAT(message(), Catch::Contains("\"much\"") && Catch::Contains("\"unifrm\""));
}

TEST_CASE("A change of parameters with different units takes numbers in SI only", "[cases]") {
  Json document = small_campaign();
  document["cases"] = Json::array();
  Json& hinges = document["scene"]["hinges"];
  REQUIRE(hinges.size() >= 2);
  hinges[0]["damper"] = {{"law", "viscous"}, {"coefficient", 1}};
  hinges[1]["damper"] = {{"law", "power"}, {"coefficient", 1}, {"exponent", 1.5}};
  const auto change = [&](const Json& value) {
    document["cases"] = {{{"name", "k"}, {"set", {{"hinges.*.damper.coefficient", value}}}}};
    return message_of([&] { return campaign_of(document); });
  };
  CHECK(change(2).empty());
  CHECK_THAT(change("2 N*mm*s/rad"),
             Catch::Contains("/cases/0/set/hinges.*.damper.coefficient: found "));
  hinges[1]["damper"] = hinges[0]["damper"];
  CHECK(change("2 N*mm*s/rad").empty());
}
