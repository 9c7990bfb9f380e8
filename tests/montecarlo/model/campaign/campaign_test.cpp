#include "montecarlo/model/campaign/campaign.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

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
