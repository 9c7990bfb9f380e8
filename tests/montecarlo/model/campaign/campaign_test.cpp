#include "distributions/prepared_distribution.hpp"
#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/support/random_cases.hpp"
#include "tests/support/random_scenes.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Whether draws of the law, through the table, change the friction of a hinge.
bool varies_by(const char* law, const char* table, const char* apply = "scale") {
  Json json = small_campaign();
  json["dispersions"] =
      parse_json(R"([ { "name": "t", "through": [ { "to": ["hinges.root.spring.scale"] },
    { "to": ["hinges.mid.spring.scale"], "apply": "add", "table": { "at": [0, 9], "value": [0, 0] } } ] } ])");
  json["dispersions"][0]["distribution"] = parse_json(law);
  json["dispersions"][0]["through"][0]["apply"] = apply;
  json["dispersions"][0]["through"][0]["table"] = parse_json(table);
  return vary(campaign_of(json));
}

} // namespace

TEST_CASE("The hash tells campaigns apart, and stays what it is", "[campaign]") {
  CHECK(campaign_hash(Json::object()) ==
        "08f44b07b5901a25"); // FNV-1a of "{}", by its definition, in Python
  const Campaign campaign = campaign_of(small_campaign());
  CHECK(campaign_hash(campaign_of(campaign.resolved).resolved) == campaign_hash(campaign.resolved));
  const Campaign other = campaign_of(spoil(small_campaign(), {"/sampling", R"({"seed": 2})", ""}));
  CHECK(campaign_hash(other.resolved) != campaign_hash(campaign.resolved));
}

TEST_CASE("Draws are applied in the order of the dispersions", "[campaign]") {
  Json document = small_campaign();
  document["dispersions"].push_back(parse_json(
      R"({ "name": "bias", "distribution": { "type": "constant", "value": 1 }, "apply": "add",
           "to": ["bodies.inner.mass", "hinges.root.spring.torque_stowed"] })"));
  const Campaign campaign = campaign_of(document);
  Scene scene = campaign.scene;
  apply(campaign, std::vector<double>{1.5, 7.25, 8.5, 0.125}, campaign.scene, scene);
  CHECK(scene.hinges[0].spring.torque_stowed == 2 * 1.5 + 0.125);
  CHECK(scene.hinges[0].spring.torque_latched == 1.4 * 1.5);
  CHECK(scene.bodies[0].mass == 7.25 + 0.125);
  CHECK(scene.bodies[1].mass == 8.5);
}

TEST_CASE("A run leaves nothing to the next, and touches only its targets", "[campaign]") {
  const Campaign campaign = campaign_of(small_campaign());
  Scene scene = campaign.scene;
  apply(campaign, std::vector<double>{3, 4, 5}, campaign.scene, scene);
  apply(campaign, std::vector<double>{1, 10, 8}, campaign.scene, scene); // the nominal values
  CHECK(write_scene(scene) == write_scene(campaign.scene));
  scene.bodies[0].inertia = 99;
  apply(campaign, std::vector<double>{1, 10, 8}, campaign.scene, scene);
  CHECK(scene.bodies[0].inertia == 99);
}

TEST_CASE("A draw drives parameters by way of its tables", "[campaign]") {
  Json document = small_campaign();
  document["dispersions"].push_back(parse_json(R"({ "name": "temperature",
    "distribution": { "type": "constant", "value": 20 },
    "through": [ { "to": ["hinges.*.spring.scale"], "apply": "scale",
                   "table": { "at": [-100, 20, 60], "value": [3, 1, 0.8] } },
                 { "to": ["hinges.root.friction.coulomb"], "apply": "add",
                   "table": { "at": [-100, 60], "value": [0.3, 0.1] } },
                 { "to": ["hinges.mid.initial_rate"], "apply": "set",
                   "table": { "at": [0, 1, 2, 3], "value": [0, 0.5, 0.5, 2] } } ] })"));
  const Campaign campaign = campaign_of(document);
  Scene scene = campaign.scene;
  const auto with = [&](double draw) {
    apply(campaign, std::vector<double>{1, 10, 8, draw}, campaign.scene, scene);
    return std::vector{scene.hinges[0].spring.scale, scene.hinges[1].spring.scale,
                       scene.hinges[0].friction.coulomb, scene.hinges[1].initial_rate};
  };
  CHECK(with(-100) == std::vector<double>{3, 3, 0.1 + 0.3, 0});
  CHECK(with(-300) == with(-100)); // constant beyond the ends
  CHECK(with(60) == std::vector<double>{0.8, 0.8, 0.1 + 0.1, 2});
  CHECK(with(1e300) == with(60));
  CHECK(with(20)[0] == 1);
  CHECK(with(1.5)[3] == 0.5); // monotone: level between equal values
  // PCHIP's slopes there: 0.75 at 0 by three points, 0 at 1 beside the level; Hermite's cubic at one half
  CHECK(with(0.5)[3] == Approx(0.25 + 0.75 / 8).epsilon(1e-15));
}

TEST_CASE("Draws vary where they change a parameter, whatever the values of their law",
          "[campaign]") {
  constexpr const char* normal = R"({ "type": "normal", "mean": 40, "std": 10 })";
  constexpr const char* beyond = R"({ "type": "uniform", "lower": 100, "upper": 110 })";
  constexpr const char* level = R"({ "at": [-80, 0, 80], "value": [1, 1, 1] })";
  constexpr const char* step = R"({ "at": [-80, 0, 80], "value": [2, 1, 1] })";
  constexpr const char* humped = R"({ "at": [0, 35, 45, 80], "value": [1, 1, 2, 1] })";
  constexpr const char* valley = R"({ "at": [-20, 0, 20], "value": [2, 1, 2] })";
  CHECK_FALSE(varies_by(normal, level));
  CHECK_FALSE(varies_by(beyond, step)); // clamped
  CHECK(varies_by(normal, step));       // rarely below 0, at 4 σ
  CHECK(varies_by(normal, humped));     // alike at both ends of the law
  CHECK_FALSE(varies_by(R"({ "type": "uniform", "lower": 10, "upper": 30 })", humped));
  CHECK_FALSE(varies_by(R"({ "type": "normal", "mean": 40, "std": 10,
    "truncate": { "lower": 5 } })",
                        step));
  CHECK(varies_by(R"({ "type": "uniform", "lower": -20, "upper": 20 })", valley));
  const auto discrete = [](const char* values, const char* weights) {
    return fmt::format(R"({{ "type": "discrete", "values": {}, "weights": {} }})", values, weights);
  };
  CHECK_FALSE(varies_by(discrete("[-20, 20]", "[1, 1]").c_str(), valley));
  CHECK(varies_by(discrete("[-20, 0, 20]", "[1, 1, 1]").c_str(), valley));
  CHECK_FALSE(varies_by(discrete("[-20, 0, 20]", "[1, 0, 1]").c_str(), valley));
  CHECK(varies_by(R"({ "type": "lognormal", "mu_log": 3, "sigma_log": 1 })", humped));
  CHECK(varies_by(normal, step, "set"));
  CHECK_FALSE(varies_by(normal, level, "set"));
}

TEST_CASE("A factor on zero changes nothing, nor does what a factor of zero follows",
          "[campaign]") {
  Json json = small_campaign();
  const auto varies = [&](const char* dispersions) {
    json["dispersions"] = parse_json(dispersions);
    return vary(campaign_of(json));
  };
  json["scene"]["hinges"][0]["initial_rate"] = 0;
  constexpr const char* factor =
      R"([ { "name": "a", "apply": "scale", "to": ["hinges.root.initial_rate"],
    "distribution": { "type": "normal", "mean": 1, "std": 0.1 } } ])";
  CHECK_FALSE(varies(factor));
  CHECK(varies(R"([ { "name": "b", "apply": "add", "to": ["hinges.root.initial_rate"],
    "distribution": { "type": "constant", "value": 1 } }, { "name": "a", "apply": "scale",
    "to": ["hinges.root.initial_rate"], "distribution": { "type": "normal", "mean": 1, "std": 0.1 } } ])"));
  CHECK_FALSE(varies(R"([ { "name": "b", "apply": "add", "to": ["hinges.root.initial_rate"],
    "distribution": { "type": "normal", "mean": 1, "std": 0.1 } }, { "name": "a", "apply": "scale",
    "to": ["hinges.root.initial_rate"], "distribution": { "type": "constant", "value": 0 } } ])"));
  json["scene"]["hinges"][0]["initial_rate"] = 0.1;
  CHECK(varies(factor));
}

TEST_CASE("Draws vary just where a sample of them has two effects", "[campaign]") {
  int vary = 0, same = 0;
  for (int seed = 1; seed <= random_cases(3000, 400); ++seed) {
    oracle::Draws draws(seed);
    std::vector<double> at{-30}, value;
    const int knots = 2 + draws.below(5);
    for (int k = 1; k < knots; ++k) at.push_back(at.back() + 1 + draws.below(30));
    for (int k = 0; k < knots; ++k) value.push_back(1 + draws.below(3) / 2); // 1, 1 or 2
    const Curve table(at, value, Interpolation::monotone);
    Distribution law;
    const double centre = -40 + draws.below(120), width = 1 + draws.below(20);
    if (seed % 3 == 0) law.law = Uniform{centre, centre + width};
    if (seed % 3 == 1)
      law = {Normal{centre, width}, Truncation{centre - width / 2, centre + width}};
    if (seed % 3 == 2) law.law = Discrete{{centre, centre + width}, {1, 2}};
    const PreparedDistribution prepared(law);
    const double first = table.value_at(prepared.quantile(0.5));
    bool differs = false;
    for (int k = 0; k <= 4000; ++k)
      differs = differs || table.value_at(prepared.quantile(k / 4000.0)) != first;
    CAPTURE(seed);
    CHECK(one_effect(law, &table) == (differs ? std::nullopt : std::optional(first)));
    ++(differs ? vary : same);
  }
  CHECK((vary > 50 && same > 50));
}
