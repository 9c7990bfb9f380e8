#include "montecarlo/analyses/margin/weaker_springs.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <tuple>

using namespace wingspread;
using namespace wingspread::test;

// The spring's least is 0.2 a N·m at the latch, against friction of 0.02: by ECSS 0.8 · 0.2 a/(2 · 3 · 0.02) − 1, a/0.75 − 1;
// by NASA and the others 0.2 a/(3 · 0.02) − 1.
TEST_CASE("what weaker springs leave of the static margins, by hand", "[margin]") {
  Json json = one_panel_margin(100);
  json["scene"]["hinges"][0]["friction"] = {{"coulomb", 0.02}};
  json["dispersions"] = Json::array();
  const Campaign campaign = campaign_of(json);
  const std::vector<SceneParameter>& springs = campaign.margin->scaled;
  CHECK_FALSE(shortfall_at({&campaign, 1}, springs, 1));
  CHECK_FALSE(shortfall_at({&campaign, 1}, springs, 0.76));
  CHECK_FALSE(shortfall_at({&campaign, 1}, springs, 2));
  const auto shortfall = shortfall_at({&campaign, 1}, springs, 0.6);
  REQUIRE(shortfall);
  CHECK((shortfall->drive == "root" && shortfall->kind == MarginKind::ecss));
  CHECK(shortfall->margin == Approx(0.6 / 0.75 - 1).epsilon(1e-12));
  CHECK(shortfall->present == Approx(1 / 0.75 - 1).epsilon(1e-12));
  CHECK(to_string(*shortfall) == "ECSS margin of root -0.20, now +0.33");
  const auto lowered = lowered_margins({&campaign, 1}, springs, 0.9);
  REQUIRE(lowered.size() == 4); // ECSS, NASA, GEVS, AIAA
  CHECK(lowered[1].margin == Approx(0.18 / 0.06 - 1).epsilon(1e-12));
  CHECK(lowered_margins({&campaign, 1}, springs, 1.1).empty());
  CHECK(short_margins({&campaign, 1}, springs, 1).empty());
  const auto below = short_margins({&campaign, 1}, springs, 0.2); // 0.04 N·m
  REQUIRE(below.size() == 4);
  CHECK(below[0].margin == Approx(0.2 / 0.75 - 1).epsilon(1e-12));
  CHECK(below[1].margin == Approx(0.04 / 0.06 - 1).epsilon(1e-12));
}

TEST_CASE("of each standard the drive of the lowest margin below 0 is told, wherever it stands",
          "[margin]") {
  for (const bool first_is_weaker : {false, true}) {
    Json json = one_panel_margin(100);
    Json& scene = json["scene"];
    Json hinge = scene["hinges"][0], panel = scene["bodies"][0];
    hinge["name"] = "second", hinge["child"] = panel["name"] = "other";
    scene["bodies"].push_back(panel), scene["hinges"].push_back(hinge);
    const std::size_t weaker = first_is_weaker ? 0 : 1;
    scene["hinges"][1 - weaker]["friction"] = {{"coulomb", 0.1}};
    scene["hinges"][weaker]["friction"] = {{"coulomb", 0.2}};
    json["dispersions"] = Json::array();
    const Campaign campaign = campaign_of(json);
    const auto below = short_margins({&campaign, 1}, campaign.margin->scaled, 1);
    REQUIRE(below.size() == 4);
    CAPTURE(first_is_weaker);
    for (const Shortfall& each : below) CHECK(each.drive == (first_is_weaker ? "root" : "second"));
    CHECK(below[1].margin == Approx(0.2 / (3 * 0.2) - 1).epsilon(1e-12));
  }
}

TEST_CASE("of several cases each static margin is that of the case that it names", "[margin]") {
  Json json = one_panel_margin(100);
  json["dispersions"] = Json::array();
  json["cases"] = parse_json(R"([ { "name": "hot" },
    { "name": "cold", "scale": { "hinges.root.spring.torque_latched": 0.8 } },
    { "name": "dusty", "scale": { "hinges.root.friction.coulomb": 1.5, "hinges.root.friction.static": 1.5 } } ])");
  const Campaign campaign = campaign_of(json);
  const std::vector<Campaign> campaigns = campaigns_of(campaign);
  const std::vector<SceneParameter>& springs = campaign.margin->scaled;
  const auto all = lowered_margins(campaigns, springs, 0.7);
  REQUIRE(all.size() == 12);
  const auto key = [](const Shortfall& each) {
    return std::tuple(each.drive, each.kind, each.margin, each.present);
  };
  for (std::size_t k = 0; k < campaigns.size(); ++k) {
    const auto own = lowered_margins({&campaigns[k], 1}, springs, 0.7);
    REQUIRE(own.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(own[i].drive == "root (" + campaign.cases[k].name + ")");
      CHECK(key(own[i]) == key(all[4 * k + i]));
    }
  }
}
