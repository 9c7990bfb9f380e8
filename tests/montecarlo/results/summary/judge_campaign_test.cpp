#include "montecarlo/results/summary/judge_campaign.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// The panel of known margins: the least is at the latch, where the spring has a tenth of its torque. Springs differ by
/// 5 % and friction by a third of itself.
Json required(const char* requirement, int runs) {
  Json json = one_panel_margin(runs);
  json["scene"]["hinges"][0]["friction"] = {
      {"model", "exact"}, {"coulomb", 0.05}, {"static", 0.05}};
  json["dispersions"][1]["distribution"]["std"] = 0.01;
  json["requirements"] = Json::array({parse_json(requirement)});
  return json;
}

Results rows(const Campaign& campaign) {
  return rows_of(RunPlan(campaign), {0, campaign.sampling.runs});
}

} // namespace

TEST_CASE("a required margin is that of each row's draw, by hand", "[motorization]") {
  const Campaign campaign = campaign_of(required(
      R"({ "motorization": "NASA", "hinge": "*", "min": 0.5, "probability": 0.5, "confidence": 0.9 })",
      200));
  const Results results = rows(campaign);
  const std::vector<Column> columns = static_margin_columns(campaign, results);
  REQUIRE(columns.size() == 1);
  CHECK(columns[0].name == "NASA margin of every hinge");
  long broken = 0;
  for (std::size_t row = 0; row < results.size(); ++row) {
    const double spring = results.draws[0].values[row], friction = results.draws[1].values[row];
    const double margin = 0.2 * spring / (3 * (0.05 + friction)) - 1;
    CHECK(columns[0].values[row] == Approx(margin).epsilon(1e-12));
    CHECK(results.status[row] == Status::deployed);
    broken += margin < 0.5 ? 1 : 0;
  }
  CHECK((broken > 20 && broken < 180));
  const Verdict verdict = judge_campaign(campaign, results).front();
  CHECK(std::ssize(verdict.broken) == broken);
  CHECK(verdict.share == Approx(1 - static_cast<double>(broken) / 200));
  REQUIRE(verdict.observed); // the lower median
  std::vector<double> margins(columns[0].values.begin(), columns[0].values.end());
  std::ranges::sort(margins);
  CHECK((*verdict.observed == margins[99] || *verdict.observed == margins[100]));
}

TEST_CASE("each standard has its column, and one that is required twice the same",
          "[motorization]") {
  Json json = required(
      R"({ "motorization": "ECSS", "hinge": "root", "probability": 0.5, "confidence": 0.9 })", 60);
  for (const char* kind : {"GEVS", "AIAA", "GEVS"})
    json["requirements"].push_back({{"motorization", kind},
                                    {"hinge", "root"},
                                    {"min", -1},
                                    {"probability", 0.5},
                                    {"confidence", 0.9}});
  json["requirements"].back()["confidence"] = 0.8; // the same margin, and another requirement
  json["margin"]["motorization"] = {{"aiaa", {{"phase", "test"}}}};
  const Campaign campaign = campaign_of(json);
  const Results results = rows(campaign);
  const std::vector<Column> columns = static_margin_columns(campaign, results);
  REQUIRE(columns.size() == 3);
  CHECK(columns[2].name == "AIAA margin of root");
  for (std::size_t row = 0; row < results.size(); ++row) {
    const double torque = 0.2 * results.draws[0].values[row];
    const double friction = 0.05 + results.draws[1].values[row];
    CHECK(columns[0].values[row] == Approx(0.8 * torque / (6 * friction) - 1).epsilon(1e-12));
    CHECK(columns[1].values[row] == Approx(torque / (3 * friction) - 1).epsilon(1e-12));
    CHECK(columns[2].values[row] == Approx(torque / (2 * friction) - 1).epsilon(1e-12));
  }
  const std::vector<Verdict> verdicts = judge_campaign(campaign, results);
  REQUIRE(verdicts.size() == 4);
  CHECK(verdicts[1].broken.size() == verdicts[3].broken.size());
}

TEST_CASE("a run that did not deploy breaks a required margin, and one without resistance does not",
          "[motorization]") {
  Json json = required(
      R"({ "motorization": "NASA", "hinge": "root", "probability": 0.5, "confidence": 0.9 })", 40);
  json["integration"]["t_end"] = 0.1;
  Campaign campaign = campaign_of(json);
  CHECK(judge_campaign(campaign, rows(campaign)).front().broken.size() == 40);
  json["integration"]["t_end"] = 60;
  json["scene"]["hinges"][0].erase("friction");
  json["dispersions"].erase(1);
  campaign = campaign_of(json);
  const Results results = rows(campaign);
  CHECK(static_margin_columns(campaign, results)[0].values[0] ==
        std::numeric_limits<double>::max());
  const Verdict verdict = judge_campaign(campaign, results).front();
  CHECK(verdict.decision == Decision::pass);
  CHECK_FALSE(verdict.observed); // no number
}

TEST_CASE("a campaign that requires no margin has no column of them", "[motorization]") {
  const Campaign campaign = campaign_of(one_panel_margin(100));
  CHECK(static_margin_columns(campaign, Results(RunPlan(campaign).names())).empty());
}

TEST_CASE("runs are one and the same where nothing varies and no result differs or is missing") {
  Json json = one_panel_margin(100);
  json.erase("margin");
  const Campaign varied = campaign_of(json);
  json.erase("dispersions");
  const Campaign fixed = campaign_of(json);
  const auto output = [](long count, double min, double max) {
    OutputSummary made;
    made.moments.count = count, made.missing = 4 - count;
    made.moments.min = min, made.moments.max = max;
    return made;
  };
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto is_one = [&](const Campaign& campaign, long deployed, const OutputSummary& second,
                          long runs = 4) {
    Summary summary;
    summary.runs = runs;
    summary.statuses = {{Status::deployed, deployed, 0, {}},
                        {Status::stalled, runs - deployed, 0, {}}};
    summary.outputs = {output(4, 2, 2), second};
    summary.requirements.resize(3);
    for (Verdict& verdict : summary.requirements) verdict.guaranteed_share = 0.9;
    summary.requirements[0].decision = Decision::pass;
    summary.requirements[1].decision = Decision::fail;
    summary.requirements[1].broken.push_back(0);
    withdraw_if_one_run(campaign, summary);
    const bool one = summary.one_run;
    const Verdict &passed = summary.requirements[0], &failed = summary.requirements[1];
    CHECK(passed.one_run == one);
    CHECK(summary.requirements[2].one_run == one); // undecided: more of the same run do not decide
    CHECK((passed.decision == (one ? Decision::undecided : Decision::pass)));
    CHECK(std::isnan(passed.guaranteed_share) == one);
    CHECK((!failed.one_run && failed.decision == Decision::fail && failed.guaranteed_share == 0.9));
    return one;
  };
  CHECK(is_one(fixed, 4, output(4, 3, 3)));
  CHECK(is_one(fixed, 0, output(0, none, none)));
  CHECK_FALSE(is_one(fixed, 4, output(4, 3, 3.5)));
  CHECK_FALSE(is_one(fixed, 4, output(3, 3, 3))); // one of the runs lacks it
  CHECK_FALSE(is_one(fixed, 3, output(4, 3, 3)));
  CHECK_FALSE(is_one(varied, 4, output(4, 3, 3)));
  CHECK_FALSE(is_one(fixed, 0, output(4, 3, 3), 0));
}
