#include "montecarlo/analyses/margin/margin_study.hpp"
#include "montecarlo/analyses/margin/scaled_springs.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/statistics/wilks.hpp"
#include "montecarlo/model/static_margins/drive.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("with one of m springs lost, the weakest springs are m/(m − 1) times as strong",
          "[margin]") {
  Json json = one_panel_margin(300);
  json["margin"]["range"] = {0.5, 4};
  json["margin"]["tolerance"] = 0.002;
  json["requirements"].erase(1);
  const auto weakest = [&](const Json& cases, int springs) {
    json["margin"]["cases"] = cases;
    json["margin"]["springs_per_hinge"] = springs;
    const MarginResult result = margin_of(campaign_of(json));
    return only_window(windows_of(failing_by_scale(result.searches.front()))).lower;
  };
  const double whole = weakest({"nominal"}, 2);
  CHECK(weakest({"nominal", "one_spring_out"}, 2) == Approx(2 * whole).epsilon(0.005));
  CHECK(weakest({"one_spring_out"}, 4) == Approx(whole * 4 / 3).epsilon(0.005));
}

TEST_CASE("cases are those of the hinges whose springs are sized, each in turn", "[margin]") {
  Json json = quick_campaign(60);
  json["requirements"] =
      parse_json(R"([{ "output": "deployed", "probability": 0.9, "confidence": 0.9 }])");
  json["margin"] = parse_json(R"({
    "scale": ["hinges.root.spring.torque_stowed", "hinges.tip.spring.torque_latched"],
    "range": [0.9, 1.1], "points": 2, "cases": ["nominal", "one_spring_out"] })");
  const Campaign campaign = campaign_of(json);
  const MarginResult result = margin_of(campaign);
  REQUIRE(result.cases.size() == 3);
  CHECK(result.cases[0].name == "nominal");
  CHECK(result.cases[1].name == "root spring out");
  CHECK(result.cases[2].name == "tip spring out");
  REQUIRE(result.cases[2].weakened.size() ==
          3); // both torques and the offset, though one of them is sized
  CHECK(path_of(campaign.scene, result.cases[2].weakened[0]) == "hinges.tip.spring.torque_stowed");
  CHECK(result.searches[0].seen.at(1).size() == 3);
}

// The same line of torque, 2 → 0.2 N·m, of which an offset gives 1 N·m. One of two springs gives half of it, 0.55 N·m on
// average, and friction of 0.8 N·m stops the wing. With the whole offset the mean would be 1.05 N·m, which deploys.
TEST_CASE("a lost spring takes its share of the offset, in the runs as in the static margin",
          "[margin]") {
  Json json = one_panel_margin(60);
  json["requirements"].erase(1);
  json["requirements"][0]["probability"] = 0.9;
  json["scene"]["hinges"][0]["spring"] = {
      {"torque_stowed", 1}, {"torque_latched", -0.8}, {"offset", 1}};
  json["margin"]["range"] = {0.9, 1.1};
  json["margin"]["points"] = 2;
  json["margin"]["cases"] = {"nominal", "one_spring_out"};
  const Campaign campaign = campaign_of(json);
  const MarginResult result = margin_of(campaign);
  const auto share_deployed = [&](std::size_t which) {
    const auto& statuses = result.searches[0].seen.at(1).at(which).statuses;
    return double(statuses[static_cast<std::size_t>(Status::deployed)]) / 60;
  };
  CHECK(share_deployed(0) == 1);
  CHECK(share_deployed(1) == 0);
  const MarginCase& lost = result.cases.at(1);
  const Scene whole = nominal_scene(campaign),
              weaker = nominal_scene(scaled(campaign, lost.weakened, 0.5));
  StaticMarginSpec spec = campaign.motorization;
  spec.nasa = nasa_one_spring_out();
  const HingeDrive drive = drives_of(whole).at(0);
  for (const double x : {0.0, 0.3, 0.7, 1.0})
    CHECK(margins_at(weaker, drive, x, spec)[1] ==
          Approx(margins_at(whole, drive, x, spec)[2]).epsilon(1e-13));
}

// The margin of a draw is 0.2 a s/(3 f) − 1 at the scale s: required to be 0 for 97 % of all, that takes s so large that
// no more than the allowed number of draws have less.
TEST_CASE("a required static margin bounds the window, count by count", "[margin]") {
  Json json = one_panel_margin(300);
  json["scene"]["hinges"][0]["friction"] = {
      {"model", "exact"}, {"coulomb", 0.08}, {"static", 0.08}};
  json["dispersions"][1]["distribution"]["std"] = 0.008;
  json["requirements"][0] = {{"motorization", "NASA"}, {"probability", 0.97}, {"confidence", 0.9}};
  json["requirements"][1]["min"] = -4;
  json["margin"]["cases"] = {"nominal", "one_spring_out"};
  json["margin"]["range"] = {0.9, 2};
  const Campaign campaign = campaign_of(json);
  const MarginResult result = margin_of(campaign);
  const MarginSearch& search = result.searches.front();
  const auto conditions = conditions_of(campaign, result);
  REQUIRE(conditions.size() ==
          3); // the margin is of the whole wing, and not of the one that lost a spring
  CHECK((conditions[2].which_case == 1 && conditions[2].requirement == 1));
  const RunPlan plan(campaign);
  std::vector<double> draws(campaign.dispersions.size());
  for (const auto& [scale, cases] : search.seen) {
    long broken = 0;
    for (long run = 0; run < 300; ++run) {
      plan.draw(run, draws);
      broken += 0.2 * scale * draws[0] < 3 * (0.08 + draws[1]) ? 1 : 0;
    }
    CAPTURE(scale);
    CHECK(std::ssize(verdict_of(cases, conditions[0]).broken) == broken);
  }
  const Window window = only_window(windows_of(failing_by_scale(search)));
  CHECK((window.lower > 1.2 && window.lower < 1.7));
  CHECK(failing_by_scale(search).at(*window.below).contains(0));
  CHECK(*search.recommended > 1);
}

// Cold, the friction is twice what it is: the weakest springs are those of the cold case, and the strongest those of the
// other, whose wing comes faster.
TEST_CASE("requirements are held in every case of the campaign", "[margin]") {
  Json json = one_panel_margin(300);
  json["scene"]["hinges"][0]["friction"] = {{"model", "exact"}, {"coulomb", 0.4}, {"static", 0.4}};
  json["requirements"][1]["min"] = -1.4;
  const auto window_of_cases = [&](const Json& cases) {
    Json own = json;
    if (!cases.empty()) own["cases"] = cases;
    const MarginResult result = margin_of(campaign_of(own));
    return std::pair{only_window(windows_of(failing_by_scale(result.searches.front()))), result};
  };
  const Json cold = parse_json(R"({ "name": "cold", "scale": { "hinges.root.friction.coulomb": 1.5,
                                                               "hinges.root.friction.static": 1.5 } })");
  const Json warm =
      parse_json(R"({ "name": "warm", "scale": { "hinges.root.latch.stiffness": 1 } })");
  const Window ambient = window_of_cases(Json::array()).first;
  const Window only_cold = window_of_cases(Json::array({cold})).first;
  const auto [both, result] = window_of_cases(Json::array({cold, warm}));
  CHECK(only_cold.lower > 1.3 * ambient.lower);
  CHECK(both.lower == Approx(only_cold.lower).epsilon(0.01));
  CHECK(both.upper == Approx(ambient.upper).epsilon(0.01));
  REQUIRE(result.cases.size() == 2);
  CHECK((result.cases[0].name == "cold" && result.cases[1].name == "warm"));
  CHECK(result.searches[0].seen.at(1).size() == 2);
}

TEST_CASE("requirements that cannot be met together leave no window", "[margin]") {
  Json json = one_panel_margin(300);
  json["requirements"][1]["min"] = -0.2;
  const Campaign campaign = campaign_of(json);
  const MarginSearch search = margin_of(campaign).searches.front();
  const FailingByScale by_scale = failing_by_scale(search);
  CHECK(windows_of(by_scale).empty());
  CHECK_FALSE(search.recommended);
  CHECK_FALSE(search.confirmation);
  CHECK_FALSE(is_confirmed(search));
  // the closed form on a fine grid: it is true
  const long allowed = *allowed_failures(300, 0.97, 0.9);
  for (double scale = 0.5; scale <= 2; scale *= 1.002)
    CHECK(closed_form(campaign, scale, 0.2).too_fast > allowed);
  CHECK(closed_by(by_scale) == std::vector<std::size_t>{1});
}

TEST_CASE("a margin is sought from that number of runs on that can show each requirement alone",
          "[margin]") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share(0.8, 0.99);
  const std::atomic<bool> stopped = true; // accepted: no run is made
  for (int k = 0; k < 20; ++k) {
    Json json = one_panel_margin(100);
    long least = 0;
    for (Json& requirement : json["requirements"]) {
      const double p = share(random), c = share(random);
      requirement["probability"] = p, requirement["confidence"] = c;
      least = std::max(least, runs_to_show(p, c, 0).value());
    }
    CAPTURE(least);
    for (const long runs : {least - 1, least, least + 1}) {
      json["sampling"]["runs"] = runs;
      const Campaign campaign = campaign_of(json);
      ThreadEvaluator evaluator({.threads = 1}, stopped);
      MarginResult result;
      const auto find = [&] {
        find_margin(
            campaign, evaluator, [](const StudyProgress&) {}, result);
      };
      if (runs < least)
        CHECK_THROWS_WITH(find(), Catch::Contains("/sampling/runs: found " + std::to_string(runs)));
      else
        CHECK_THROWS_AS(find(), Stopped);
    }
  }
}

TEST_CASE("the present springs have the verdicts of run, with interim analyses too",
          "[margin][parallel]") {
  for (const char* kind : {"alone", "until", "extended_from"}) {
    Json json = one_panel_margin(2000);
    json["margin"]["range"] = {0.9, 1.1};
    if (kind == std::string("until")) // never met: both analyses take place
      json["until"] = parse_json(R"([ { "output": "deployed", "width": 1e-6 } ])");
    if (kind == std::string("extended_from")) json["sampling"]["extended_from"] = {500, 1000};
    const Campaign campaign = campaign_of(json);
    const Folder folder;
    (void)run_into(folder.path() / "r", campaign);
    const Json summary = parse_json_file(folder.path() / "r" / summary_file);
    const MarginResult result = margin_of(campaign);
    const std::vector<Verdict>& verdicts = result.searches.front().seen.at(1).front().verdicts;
    REQUIRE(verdicts.size() == 2);
    for (std::size_t k = 0; k < 2; ++k) {
      CAPTURE(kind, k);
      const Json& there = summary["requirements"][k];
      CHECK(there["failures"]["allowed"] == *verdicts[k].allowed);
      CHECK(there["verdict"] == to_string(verdicts[k].decision));
    }
    if (kind != std::string("alone"))
      CHECK(*verdicts[0].allowed < *allowed_failures(2000, 0.97, 0.9));
  }
}

TEST_CASE("a margin with too few runs for its interim analyses is refused", "[margin]") {
  Json json = one_panel_margin(1300);
  for (Json& requirement : json["requirements"]) requirement["probability"] = 0.998;
  REQUIRE(allowed_failures(1300, 0.998, 0.9)); // as the only analysis; 1497 runs of one of two
  json["until"] = parse_json(R"([ { "output": "deployed", "width": 1e-6 } ])");
  CHECK_THROWS_WITH(margin_of(campaign_of(json)),
                    Catch::Contains("/sampling/runs: found 1300, expected at least 1497"));
  json.erase("until");
  json["sampling"] = {{"design", "random"}, {"runs", 30}, {"seed", 1}, {"extended_from", {20}}};
  for (Json& requirement : json["requirements"]) requirement["probability"] = 0.9;
  REQUIRE(allowed_failures(30, 0.9, 0.9)); // as the only analysis
  CHECK_THROWS_WITH(
      margin_of(campaign_of(json)),
      Catch::Contains("/sampling/runs: found 30, expected more: the analyses before"));
}

TEST_CASE("a margin over a case that does not vary is refused by its name", "[margin]") {
  Json json = one_panel_margin(200);
  for (Json& dispersion : json["dispersions"])
    dispersion["distribution"] = parse_json(R"({ "type": "constant", "value": 0.9 })");
  json["cases"] = parse_json(R"([ { "name": "amb" }, { "name": "hot", "distributions": {
    "spring": { "type": "normal", "mean": 1, "std": 0.05 } } } ])");
  CHECK_THROWS_WITH(
      margin_of(campaign_of(json)),
      Catch::Contains("/dispersions: found laws with a single value only in case amb") &&
          !Catch::Contains("hot"));
  json["cases"].erase(0);
  CHECK_NOTHROW(margin_of(campaign_of(json)));
}
