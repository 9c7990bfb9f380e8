#include "montecarlo/engine/accuracy/automatic_tolerance.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <numeric>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Nearly nothing dispersed, so that the sampling error is small and tolerances differ.
Json narrow_campaign(long runs) {
  Json json = quick_campaign(static_cast<int>(runs));
  json["dispersions"][0]["distribution"]["std"] = 1e-6;
  json["dispersions"].erase(1);
  json["outputs"] = {"latch_time", "latch_rate"};
  json["integration"] = {{"rtol", "auto"}, {"t_end", 20}};
  return json;
}

Campaign settled(const Json& json, const Crew& crew = {.threads = 1}) {
  Campaign campaign = campaign_of(json);
  settle_tolerance(campaign, crew);
  return campaign;
}

} // namespace

TEST_CASE("sampling errors by hand", "[automatic_tolerance]") {
  std::vector<double> values(100);
  std::iota(values.begin(), values.end(), 1.0);
  const double std = std::sqrt(100 * 101 / 12.0);   // of 1, 2, … n: √(n(n + 1)/12)
  const double kurtosis = moments(values).kurtosis; // −1.2
  const double of_std = std * std::sqrt((kurtosis + 2) / (4 * 400.0));
  // m = 5. Median: X_55 − X_45 = 10 over 10 ranks; at 0.01: X_6 − X_1 = 5 over 5. 1/f = 100 in both.
  const auto [moment, quantile] = sampling_error(values, std::vector{0.01, 0.5}, 400);
  CHECK(moment == Approx(of_std).epsilon(1e-12));
  CHECK(of_std < std / 20); // that of the mean, which a normal sample's would be too
  CHECK(quantile == Approx(std::sqrt(0.01 * 0.99 / 400) * 100).epsilon(1e-12));
  CHECK(sampling_error(values, std::vector{0.5}, 400).quantiles == Approx(2.5).epsilon(1e-12));
  CHECK(std::isnan(sampling_error(values, {}, 400).quantiles));
  CHECK(sampling_error(std::vector{1.0, 3.0}, {}, 8).moments ==
        Approx(std::sqrt(2.0 / 8)).epsilon(1e-12)); // too few for a kurtosis
  for (const std::vector<double>& nothing : {std::vector<double>{}, {2}, {2, 2, 2}}) {
    CHECK(std::isnan(sampling_error(nothing, std::vector{0.5}, 400).moments));
    CHECK(std::isnan(sampling_error(nothing, std::vector{0.5}, 400).quantiles));
  }
}

TEST_CASE("errors are held against a share of the sampling error", "[automatic_tolerance]") {
  const OutputAccuracy error{"a", 2, 4e-3, 3e-3};
  CHECK(is_within(error, {0.3, 0.4}, 0.01));
  CHECK_FALSE(is_within(error, {0.29, 0.4}, 0.01)); // RMS: mean and standard deviation
  CHECK_FALSE(is_within(error, {0.3, 0.39}, 0.01)); // the largest: quantiles
  CHECK(is_within(error, {none, none}, 0.01));
  CHECK(is_within({"a", 0, none, none}, {0, 0}, 0.01));
}

TEST_CASE("a pilot is an eighth of the runs, from 32 to 256", "[automatic_tolerance]") {
  for (const auto& [runs, pilot] : std::vector<std::pair<long, long>>{
           {1, 1}, {20, 20}, {100, 32}, {800, 100}, {1'000'000, 256}})
    CHECK(pilot_runs(runs) == pilot);
}

TEST_CASE("few runs are worth a looser tolerance than many, and none above 1e-6",
          "[automatic_tolerance]") {
  const Campaign few = settled(narrow_campaign(40)), many = settled(narrow_campaign(100'000));
  CHECK(few.integration.rtol <= 1e-6);
  CHECK(many.integration.rtol < few.integration.rtol / 3);
  CHECK(few.integration.atol == few.integration.rtol / 100);
  REQUIRE(few.tolerance->pilot);
  CHECK(few.tolerance->pilot->seed == 7);
  CHECK(few.tolerance->pilot->runs == 32);
  CHECK(few.tolerance->pilot->for_runs == 40);
  CHECK(few.tolerance->pilot->repeated.size() == 12);
  CHECK(few.tolerance->pilot->reached);
  Json wide = narrow_campaign(40);
  wide["dispersions"][0]["distribution"]["std"] = 0.05;
  CHECK(settled(wide).integration.rtol == 1e-6);
}

TEST_CASE("a share, and an absolute tolerance, can be given", "[automatic_tolerance]") {
  Json json = narrow_campaign(40);
  json["integration"]["rtol_share"] = 1e-6;
  json["integration"]["atol"] = 1e-9;
  const Campaign campaign = settled(json);
  CHECK(campaign.integration.rtol ==
        1e-10); // errors of 1e-8 of the sampling error are out of reach
  CHECK_FALSE(campaign.tolerance->pilot->reached);
  CHECK(campaign.integration.atol == 1e-9);
}

TEST_CASE("the choice is the same for any crew, and is the campaign's identity",
          "[automatic_tolerance][parallel]") {
  const Campaign one = settled(narrow_campaign(1000), {1, instruction_sets().front()});
  const Campaign two = settled(narrow_campaign(1000), {.threads = 2});
  CHECK(one.resolved.dump() == two.resolved.dump());
  const Campaign again = campaign_of(one.resolved);
  CHECK(campaign_hash(again.resolved) == campaign_hash(one.resolved));
  CHECK(again.integration.rtol == one.integration.rtol);
  CHECK(settled(one.resolved).resolved.dump() == one.resolved.dump()); // chosen once
}

TEST_CASE("a tolerance that is given stays", "[automatic_tolerance]") {
  Campaign campaign = campaign_of(quick_campaign(40));
  const Json before = campaign.resolved;
  settle_tolerance(campaign, {.threads = 1});
  CHECK(campaign.resolved == before);
}

TEST_CASE("all cases have one tolerance, that of the one in need of the tightest",
          "[automatic_tolerance]") {
  Json json = narrow_campaign(1000);
  json["dispersions"][0]["distribution"]["std"] = 0.05;
  const double wide = settled(json).integration.rtol;
  json["cases"] = parse_json(R"([ { "name": "wide" }, { "name": "narrow",
    "distributions": { "root_spring": { "type": "normal", "mean": 1, "std": 1e-6 } } } ])");
  const Campaign campaign = settled(json);
  CHECK(campaign.integration.rtol < wide);
  for (const Campaign& each : campaigns_of(campaign))
    CHECK(each.integration.rtol == campaign.integration.rtol);
}
