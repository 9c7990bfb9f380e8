#include "montecarlo/analyses/rare/rare_report.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <iterator>
#include <limits>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// A campaign with this many dispersions: d0, d1 …
Campaign campaign_with(std::size_t dispersions) {
  Campaign campaign = campaign_of(quick_campaign(10));
  campaign.dispersions.resize(dispersions, campaign.dispersions.front());
  for (std::size_t k = 0; k < dispersions; ++k)
    campaign.dispersions[k].name = "d" + std::to_string(k);
  return campaign;
}

SubsetEstimate repeat_of(bool reached, bool stuck = false) {
  SubsetEstimate estimate;
  estimate.reached = reached, estimate.stuck = stuck;
  estimate.probability = reached || !stuck ? 1e-3 : 0;
  estimate.variation = 0.2, estimate.evaluations = 1000;
  return estimate;
}

/// One stratum with these repeats; its estimate is the result's.
RareResult result_of(const std::vector<SubsetEstimate>& repeats) {
  RareResult result;
  RareEstimate& all = result.estimate;
  all.probability = 1e-3, all.interval = {5e-4, 2e-3};
  all.variation = 0.2, all.evaluations = 2000, all.plain_runs = 25'000;
  result.strata.resize(1);
  result.strata[0].estimates = repeats;
  return result;
}

bool has(const std::string& text, const char* words) { return text.find(words) != text.npos; }

} // namespace

TEST_CASE("the text of a rare event has each sentence where the estimate is such, and only there",
          "[rare]") {
  const Campaign campaign = campaign_with(1);
  for (const bool reached : {false, true})
    for (const double bias : {0.0, 0.025})
      for (const double plain_runs : {1999.0, 2001.0, infinite})
        for (const bool stuck : {false, true}) {
          RareResult result = result_of({repeat_of(true), repeat_of(reached, stuck)});
          result.estimate.reached = reached;
          result.estimate.bias = bias, result.estimate.plain_runs = plain_runs;
          const std::string text = rare_text(result, {}, campaign);
          CAPTURE(text);
          CHECK(has(text, "not reached in 1 of 2 repeats") == !reached);
          CHECK(has(text, "variation 20 %") == reached);
          CHECK(has(text, "too large by about 2.5 % on average") == (reached && bias > 0));
          CHECK(has(text, "Bias") == (reached && bias > 0));
          CHECK(has(text, "95 % bounds 0.0005 … 0.002,") == reached); // the lower one first
          CHECK(has(text, "95 % bound 0.002:") == !reached);
          CHECK(has(text, "would have been enough: 1999 runs") == (reached && plain_runs < 2000));
          CHECK(has(text, "would take 2e+03 runs") ==
                (reached && plain_runs > 2000 && plain_runs < infinite));
          CHECK(has(text, "≲ ") == !(reached || stuck)); // an upper bound of a repeat
          CHECK(has(text, "–") == (!reached && stuck));  // 0 has no variation
          CHECK_FALSE(has(text, "Clopper"));
          CHECK_FALSE(has(text, "MOST LIKELY"));
          CHECK_FALSE(has(text, "STRATA"));
        }
}

TEST_CASE("each repeat has a row of its own numbers, and each stratum, the largest part first",
          "[rare]") {
  RareResult result = result_of({repeat_of(true), repeat_of(true), repeat_of(false)});
  std::vector<SubsetEstimate>& repeats = result.strata[0].estimates;
  repeats[1].probability = 0.0125, repeats[1].variation = 0.375, repeats[1].evaluations = 4321;
  repeats[1].levels.resize(2);
  repeats[1].levels[0].threshold = 2.5, repeats[1].levels[1].threshold = 0.5;
  repeats[2].probability = 3e-5, repeats[2].variation = 0.5;
  RareOptions options;
  options.event = {"root.peak_moment", 100, true};
  const auto words_of = [](const std::string& text, const std::string& label) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("  " + label)) {
        std::istringstream in(line.substr(2 + label.size()));
        return std::vector<std::string>{std::istream_iterator<std::string>(in), {}};
      }
    return std::vector<std::string>{};
  };
  using Words = std::vector<std::string>;
  std::string text = rare_text(result, options, campaign_with(1));
  CHECK(words_of(text, "1 ")[0] == "0.001");
  // a level at the distance 2.5 below the limit of 100
  CHECK(words_of(text, "2 ") == Words{"0.0125", "38", "%", "4321", "97.5", "99.5"});
  CHECK(words_of(text, "3 ")[0] == "≲");

  for (const double probability : {1e-4, 2e-3}) {
    StratumEstimate part = result.strata[0];
    part.stratum.rare = {{probability < 1e-3 ? "seldom" : "often", 1.0}};
    part.stratum.probability = probability;
    part.estimate.interval = {0.25, 0.5}, part.estimate.probability = 0.375;
    part.estimate.evaluations = 77, part.estimate.reached = true;
    result.strata.push_back(part);
  }
  result.strata[0].stratum.probability = 0.9979;
  result.strata[0].estimate.interval = {1e-8, 2e-8};
  text = rare_text(result, options, campaign_with(1));
  CAPTURE(text);
  const auto often = text.find("often = 1"), seldom = text.find("seldom = 1");
  REQUIRE((often != text.npos && seldom != text.npos));
  CHECK(often < seldom);
  CHECK(seldom < text.find("no rare value"));
  CHECK(words_of(text, "often = 1") == Words{"0.002", "0.375", "0.00075", "77"});
}

TEST_CASE("rare.json names the scene, and the unit of each draw that is no factor", "[rare]") {
  Campaign campaign = campaign_with(4); // of a spring's torques, and of masses
  campaign.scene.name = "some wing";
  campaign.dispersions[0].apply = Apply::set, campaign.dispersions[1].apply = Apply::scale;
  campaign.dispersions[2].apply = Apply::add, campaign.dispersions[3].apply = Apply::set;
  campaign.dispersions[3].targets.clear(); // only "through"
  RareResult result = result_of({repeat_of(true)});
  result.likeliest.emplace();
  result.likeliest->draws = {1, 2, 3, 4}, result.likeliest->z = {0.5, -1, 2, 0};
  const Json json = rare_json(result, {}, campaign, {});
  CHECK(json["scene"] == "some wing");
  CHECK_FALSE(json.contains("report"));
  campaign.report.title = "T"; // of the first page, for a report of this folder alone
  CHECK(rare_json(result, {}, campaign, {})["report"] == Json{{"title", "T"}});
  CHECK(json["likeliest"]["units"] == Json{{"d0", "N·m"}, {"d1", ""}, {"d2", "kg"}, {"d3", ""}});
}

TEST_CASE("unphysical draws are among the warnings, of the file as of the terminal", "[rare]") {
  RareResult result = result_of({repeat_of(true)});
  CHECK(doubts_of(result).empty());
  result.statuses[static_cast<std::size_t>(Status::invalid)] = 3;
  const std::vector<std::string> said = doubts_of(result);
  REQUIRE(said.size() == 1);
  CHECK(said[0].starts_with("3 of 2000 runs have an unphysical draw"));
  CHECK(rare_json(result, {}, campaign_with(1), {})["warnings"] == Json(said));
}

TEST_CASE("one unphysical draw, one cut peak and one open latch are doubts, and none is not",
          "[rare]") {
  for (const long count : {0L, 1L}) {
    RareResult result = result_of({repeat_of(true)});
    result.statuses[static_cast<std::size_t>(Status::invalid)] = count;
    result.cut = result.open_latches = count;
    CAPTURE(count);
    const std::vector<std::string> said = doubts_of(result);
    REQUIRE(std::ssize(said) == 3 * count);
    CHECK(has(rare_text(result, {}, campaign_with(1)), "\nt_end cut the peak in 1 of 2000 runs") ==
          (count > 0));
    if (count == 0) continue;
    CHECK(said[0].starts_with("1 of 2000 runs have an unphysical draw"));
    CHECK(said[1].starts_with("t_end cut the peak in 1 of 2000 runs"));
    CHECK(said[2] == warn_of_open_latches(1, 2000, ""));
  }
}

TEST_CASE("the text of an event that is not rare counts, and has no bias", "[rare]") {
  RareResult result = result_of({repeat_of(true)});
  result.estimate.reached = result.estimate.plain = true;
  result.estimate.hits = 13, result.estimate.draws = 200, result.estimate.plain_runs = 200;
  const std::string text = rare_text(result, {}, campaign_with(1));
  CHECK_THAT(text, Catch::Contains("13 of 200 runs have the event") &&
                       Catch::Contains("95 % bounds 0.0005 … 0.002 (Clopper–Pearson)") &&
                       Catch::Contains("2000 runs made.\n"));
  CHECK_FALSE(has(text, "Bias"));
}

TEST_CASE(
    "the text of strata names the draws that are not simulated, and how many others there are",
    "[rare]") {
  for (const bool reached : {false, true})
    for (const double lower : {0.0, 5e-4})
      for (const double left_out : {0.0, 1e-6})
        for (const std::size_t rare : {1, 12}) {
          RareResult result = result_of({repeat_of(reached)});
          result.strata[0].stratum.probability = 0.9;
          result.strata[0].estimate = result.estimate;
          for (std::size_t k = 0; k < rare; ++k) {
            result.strata.push_back(result.strata[0]);
            result.strata.back().stratum.rare = {{"nofire", 1.0}};
            result.strata.back().stratum.probability = 1e-3;
          }
          result.estimate.reached = reached, result.estimate.interval.lower = lower;
          result.left_out = left_out;
          const std::string text = rare_text(result, {}, campaign_with(1));
          CAPTURE(text);
          CHECK(has(text, "nofire = 1"));
          CHECK(has(text, "95 % bounds 0.0005 … 0.002") == (lower > 0));
          CHECK(has(text, "not simulated") == (left_out > 0));
          CHECK(has(text, "≤ 1e-06") == (left_out > 0));
          CHECK(has(text, "1 others, each at most 2e-06") == (rare == 12)); // of 13, 12 are shown
          CHECK(has(text, "the upper one is an estimate") == (!reached && lower > 0));
          CHECK(has(text, "not reached. 95 % upper bound 0.002") == (!reached && lower == 0));
        }
}

TEST_CASE("the text of a rare event says what its first levels show as a plain sample", "[rare]") {
  RareResult result = result_of({repeat_of(true)});
  result.estimate.reached = true, result.estimate.draws = 1000;
  CHECK(has(rare_text(result, {}, campaign_with(1)),
            "of 1000 runs, show P ≤ 0.0037")); // 0.025 = (1 − P)^1000
  result.left_out = 2e-5;                      // the first levels are then samples of strata
  CHECK_FALSE(has(rare_text(result, {}, campaign_with(1)), "plain sample"));
  const auto told = [&] {
    return std::ranges::any_of(
        doubts_of(result), [](const std::string& doubt) { return has(doubt, "not simulated"); });
  };
  result.estimate.probability = 1e-3;
  CHECK_FALSE(told());
  result.estimate.probability = 1e-4;
  CHECK(told());
}

TEST_CASE("an event that no run has: a bound by counting is none that is estimated", "[rare]") {
  RareResult result = result_of({repeat_of(false)});
  result.estimate.interval = {0, 0.002};
  result.estimate.draws = 1800;
  result.estimate.plain = result.estimate.reached = true;
  const auto told = [&] { return rare_text(result, {}, campaign_with(1)); };
  CHECK(has(told(), "not reached, 95 % upper bound 0.002"));
  CHECK(has(told(), "0 of 1800 runs"));
  CHECK_FALSE(has(told(), "use `wingspread run`"));
  result.strata[0].estimate = result.estimate;
  result.strata.push_back(result.strata[0]);
  result.estimate.reached = false;
  CHECK(has(told(), "not reached. 95 % upper bound 0.002"));
  CHECK_FALSE(has(told(), "not guaranteed"));
  result.strata[1].estimate.reached = false;
  CHECK(has(told(), "not guaranteed"));
}

TEST_CASE("the text of the likeliest run has the eight largest deviations", "[rare]") {
  for (const std::size_t dispersions : {1, 8, 9}) {
    const Campaign campaign = campaign_with(dispersions);
    RareResult result = result_of({repeat_of(true)});
    result.estimate.reached = true;
    result.likeliest = LikeliestRun{3.5, {}, {}, Status::stalled, "it lacks energy"};
    for (std::size_t k = 0; k < dispersions; ++k) {
      result.likeliest->z.push_back(k % 2 == 0 ? 0.5 + 0.25 * static_cast<double>(k) : -3);
      result.likeliest->draws.push_back(1 + 0.01 * result.likeliest->z.back());
    }
    const std::string text = rare_text(result, {}, campaign);
    CAPTURE(text);
    CHECK_THAT(text, Catch::Contains(
                         "at the distance 3.50 in normal coordinates: stalled, it lacks energy"));
    CHECK(has(text, "d0 ") == (dispersions < 9)); // the least
    CHECK(has(text, "1 others, at most 0.50") == (dispersions == 9));
    CHECK_FALSE(has(text, "correlated"));
    if (dispersions > 1) CHECK(text.find("d1 ") < text.find("d2 ")); // 3 before 1
    for (std::size_t k = 1; k < dispersions; ++k) { // the draw, and its normal coordinate's sign
      const double z = result.likeliest->z[k];
      CHECK(has(text, fmt::format("\n  d{:<39}{:>14.6g}{:>+24.2f}\n", k, 1 + 0.01 * z, z).c_str()));
    }
  }
}
