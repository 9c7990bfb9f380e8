#include "montecarlo/engine/runs/static_margin_draws.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// The panel with a harness besides.
Campaign harnessed(int runs) {
  Json json = one_panel_margin(runs);
  json["scene"]["hinges"][0]["harness"] = {{"torque_stowed", 0.05}, {"torque_latched", 0.1}};
  json["statistics"] = {{"quantiles", {0.1, 0.5}}};
  json["margin"]["motorization"] = {{"points", 5}};
  return campaign_of(json);
}

} // namespace

TEST_CASE("nominal margins at every angle are those of the formulas", "[motorization]") {
  const Campaign campaign = harnessed(20);
  const StaticMarginStudy study = study_static_margins(campaign);
  REQUIRE(study.drives.size() == 1);
  const DriveMargins& root = study.drives.front();
  REQUIRE(root.travel.size() == 5);
  for (const TravelPoint& point : root.travel) {
    const double spring = 2 - 1.8 * point.x, harness = 0.05 + 0.05 * point.x;
    CHECK(point.angle == Approx(1.5707963267948966 * (1 - point.x)).margin(1e-15));
    CHECK(point.margins[0] == Approx(0.8 * spring / (2 * (3 * 0.8 + 3 * harness)) - 1));
    CHECK(point.margins[1] == Approx(spring / (3 * (0.8 + harness)) - 1));
    CHECK(point.margins[2] == Approx(0.5 * spring / (0.8 + harness) - 1));
    CHECK(point.margins[3] == Approx(spring / (3 * (0.8 + harness)) - 1)); // critical design
    CHECK(point.margins[4] == point.margins[3]);
  }
  CHECK(root.worst_angle == Margins{0, 0, 0, 0, 0});
  CHECK(root.worst == root.travel.back().margins);
}

TEST_CASE("dispersed margins are those of the draws, with the worst of them", "[motorization]") {
  const Campaign campaign = harnessed(200);
  const DriveMargins root = study_static_margins(campaign).drives.front();
  const RunPlan plan(campaign);
  std::vector<std::pair<double, long>> margins; // NASA, half-way
  std::vector<double> draws(3);
  for (long run = 0; run < 200; ++run) {
    plan.draw(run, draws);
    margins.emplace_back(1.1 * draws[0] / (3 * (0.8 + draws[1] + 0.075)) - 1, run);
  }
  std::ranges::sort(margins);
  const MarginSpread& spread = root.travel[2].spread[1];
  REQUIRE(spread.quantiles.size() == 2);
  CHECK(spread.least == Approx(margins.front().first).epsilon(1e-12));
  CHECK(spread.worst_run == margins.front().second);
  CHECK(spread.quantiles[0] == Approx(margins[19].first).epsilon(1e-12)); // X_(20) of 200
  CHECK(spread.quantiles[1] == Approx(margins[99].first).epsilon(1e-12));
  CHECK(spread.share_short == 1);
  CHECK(root.worst_spread[1].least <= spread.least);
  CHECK(root.worst_spread[1].share_short == 1);
}

TEST_CASE("the worst draw is found wherever it is, be it the first", "[motorization]") {
  std::array<int, 3> worst{};
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Campaign campaign = harnessed(3);
    campaign.sampling.seed = seed;
    const DriveMargins root = study_static_margins(campaign).drives.front();
    const RunPlan plan(campaign);
    std::pair<double, long> half_way{1e9, -1}, at_latch{1e9, -1}; // NASA; the least is at the latch
    std::vector<double> draws(3);
    for (long run = 0; run < 3; ++run) {
      plan.draw(run, draws);
      half_way = std::min(half_way, {1.1 * draws[0] / (3 * (0.8 + draws[1] + 0.075)) - 1, run});
      at_latch = std::min(at_latch, {0.2 * draws[0] / (3 * (0.8 + draws[1] + 0.1)) - 1, run});
    }
    CAPTURE(seed);
    CHECK(root.travel[2].spread[1].worst_run == half_way.second);
    CHECK(root.travel[2].spread[1].least == Approx(half_way.first).epsilon(1e-12));
    CHECK(root.worst_spread[1].worst_run == at_latch.second);
    plan.draw(at_latch.second, draws);
    CHECK(root.worst_draw[1]["spring"] == draws[0]);
    CHECK(root.worst_draw[1]["friction"] == draws[1]);
    ++worst[static_cast<std::size_t>(half_way.second)];
  }
  CHECK(std::ranges::min(worst) > 0);
}

TEST_CASE("draws that are unphysical have no margins, and are counted", "[motorization]") {
  Json json = one_panel_margin(200);
  json["dispersions"][2]["distribution"] = {{"type", "normal"}, {"mean", 1}, {"std", 1}};
  const Campaign campaign = campaign_of(json);
  const StaticMarginStudy study = study_static_margins(campaign);
  CHECK(study.invalid > 10);
  CHECK(study.draws + study.invalid == 200);
}

TEST_CASE("a hinge without spring and latch drives nothing, and has no margin", "[motorization]") {
  Json json = small_campaign();
  json["margin"] =
      parse_json(R"({ "scale": ["hinges.root.spring.torque_stowed"], "range": [0.5, 2] })");
  const Campaign campaign = campaign_of(json);
  const StaticMarginStudy study = study_static_margins(campaign);
  REQUIRE(study.drives.size() == 1);
  CHECK(study.drives[0].hinge == "root");
}

// More places than are worked out at a time: the margins of each are still those of its own x.
TEST_CASE("margins at many places are each place's own", "[motorization]") {
  Json json = one_panel_margin(100);
  json["scene"]["hinges"][0]["harness"] = {{"torque_stowed", 0.05}, {"torque_latched", 0.1}};
  json["statistics"] = {{"quantiles", {0.3}}};
  json["margin"]["motorization"] = {{"points", 150}};
  const Campaign campaign = campaign_of(json);
  const StaticMarginStudy study = study_static_margins(campaign);
  const DriveMargins& root = study.drives.front();
  REQUIRE(root.travel.size() == 150);
  const RunPlan plan(campaign);
  std::vector<double> draws(3);
  std::vector<double> worst(100, 1e300); // NASA's, over the ends of the travel
  for (const TravelPoint& point : root.travel) {
    std::vector<std::pair<double, long>> margins;
    for (long run = 0; run < 100; ++run) {
      plan.draw(run, draws);
      const double spring = draws[0] * (2 - 1.8 * point.x), harness = 0.05 + 0.05 * point.x;
      margins.emplace_back(spring / (3 * (0.8 + draws[1] + harness)) - 1, run);
      worst[static_cast<std::size_t>(run)] =
          std::min(worst[static_cast<std::size_t>(run)], margins.back().first);
    }
    const auto is_short = [](const auto& margin) { return margin.first < 0; };
    const MarginSpread& spread = point.spread[1];
    CHECK(spread.share_short ==
          static_cast<double>(std::ranges::count_if(margins, is_short)) / 100);
    std::ranges::sort(margins);
    CHECK(spread.least == Approx(margins.front().first).epsilon(1e-12));
    CHECK(spread.worst_run == margins.front().second);
    CHECK(spread.quantiles.at(0) == Approx(margins[29].first).epsilon(1e-12));
  }
  std::ranges::sort(worst);
  CHECK(root.worst_spread[1].quantiles.at(0) == Approx(worst[29]).epsilon(1e-12));
  CHECK(root.worst_spread[1].least == Approx(worst[0]).epsilon(1e-12));
}

TEST_CASE("a margin of nothing is enough: those below it are short", "[motorization]") {
  Json json = one_panel_margin(20);
  Json& hinge = json["scene"]["hinges"][0];
  hinge["spring"] = {{"torque_stowed", 3}, {"torque_latched", 3}};
  hinge["friction"] = {{"model", "exact"}, {"coulomb", 1}, {"static", 1}};
  Json dispersion = json["dispersions"][2]; // the mass has no part in it
  json["dispersions"] = Json::array({dispersion});
  const Campaign campaign = campaign_of(json);
  const StaticMarginStudy study = study_static_margins(campaign);
  const DriveMargins& root = study.drives.front();
  CHECK(root.worst[1] == 0); // by NASA: 3/(3 · 1) − 1
  CHECK(root.worst_spread[1].least == 0);
  CHECK(root.worst_spread[1].share_short == 0);
  CHECK(root.worst_spread[0].share_short == 1); // by ECSS it takes six times the friction
}

TEST_CASE("unphysical draws are counted, whether or not some hinge drives", "[motorization]") {
  for (const bool drives : {true, false}) {
    Json json = one_panel_margin(200);
    json["dispersions"] = Json::array();
    json["dispersions"].push_back(parse_json(R"({ "name": "mass", "apply": "set",
      "distribution": { "type": "normal", "mean": 1, "std": 1 }, "to": ["bodies.panel.mass"] })"));
    if (!drives) {
      Json& hinge = json["scene"]["hinges"][0];
      for (const char* key : {"spring", "friction", "latch"}) hinge.erase(key);
      hinge["angle"] = 0, hinge["joint"] = {{"stiffness", 100}};
      json.erase("margin"), json.erase("requirements");
      json["outputs"] = Json::array();
    }
    const Campaign campaign = campaign_of(json);
    const StaticMarginStudy study = study_static_margins(campaign);
    CHECK(study.drives.empty() != drives);
    const RunPlan plan(campaign);
    std::vector<double> draws(1);
    long unphysical = 0;
    for (long run = 0; run < 200; ++run) {
      plan.draw(run, draws);
      unphysical += draws[0] <= 0 ? 1 : 0;
    }
    CHECK(unphysical > 10);
    CHECK(study.invalid == unphysical);
    CHECK(study.draws == 200 - unphysical);
  }
}
