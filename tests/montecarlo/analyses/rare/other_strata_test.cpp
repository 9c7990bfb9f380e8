#include "montecarlo/engine/runs/run_plan.hpp"
#include "tests/montecarlo/analyses/rare/lid_support.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <catch2/catch.hpp>

#include <map>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("draws of the other strata are theirs, each as often as it is probable", "[rare]") {
  Json json = rare_values(11, 1e-3);
  json["dispersions"][10]["distribution"]["weights"] = {0.995,
                                                        0.005}; // combinations with it are likelier
  const Campaign campaign = campaign_of(json);
  const Strata strata = strata_of(campaign, {});
  const Stratum& together = strata.list.back();
  REQUIRE(together.others.size() > 100);
  const std::size_t own = coordinates_of(campaign.dispersions).names.size();
  REQUIRE(coordinates_in(strata.list.front(), own) == own);
  REQUIRE(coordinates_in(together, own) == own + 1);
  constexpr long runs = 20000;
  std::vector<NormalPoint> points;
  RandomStream random(1, 0, stream_name("others"));
  for (long k = 0; k < runs; ++k) {
    NormalPoint z;
    for (std::size_t i = 0; i < own + 1; ++i)
      z.push_back(inverse(Normal{}, tails_of_uniform(open_uniform(random()))));
    points.push_back(within(together, std::move(z)));
    REQUIRE(points.back().size() == own);
  }
  const RunPlan plan(campaign, [&](long k, std::span<Tails> u) {
    for (std::size_t i = 0; i < u.size(); ++i)
      u[i] = unit_point(points[static_cast<std::size_t>(k)][i]);
  });
  std::map<std::vector<bool>, long> found;
  std::vector<double> draws(own);
  for (long k = 0; k < runs; ++k) {
    plan.draw(k, draws);
    std::vector<bool> rare;
    for (const double draw : draws) rare.push_back(draw != 1);
    ++found[rare];
  }
  const auto shows = [&](const Stratum& stratum, const std::vector<bool>& rare) {
    std::size_t k = 0;
    for (std::size_t i = 0; i < own; ++i) k += rare[i];
    return k >= stratum.rare.size() && std::ranges::all_of(stratum.rare, [&](const auto& value) {
             return rare[static_cast<std::size_t>(std::stoi(value.first.substr(1)))];
           });
  };
  long all = 0;
  for (const auto& [rare, count] : found) {
    all += count;
    CHECK(std::ranges::any_of(together.others, [&](const Stratum& s) { return shows(s, rare); }));
    CHECK(std::ranges::none_of(std::span(strata.list).first(64), [&](const Stratum& s) {
      return s.rare.size() == static_cast<std::size_t>(std::ranges::count(rare, true)) &&
             shows(s, rare);
    }));
  }
  CHECK(all == runs);
  for (const Stratum& stratum : together.others) {
    const double share = stratum.probability / together.probability;
    long count = 0;
    for (const auto& [rare, times] : found)
      count += stratum.rare.size() == static_cast<std::size_t>(std::ranges::count(rare, true)) &&
                       shows(stratum, rare)
                   ? times
                   : 0;
    CHECK(std::abs(static_cast<double>(count) - runs * share) < 5 * std::sqrt(runs * share) + 1);
  }
}

TEST_CASE("of thirty rare values less than a hundredth of the other strata is left out", "[rare]") {
  const Strata strata = strata_of(campaign_of(rare_values(30, 1e-3)), {});
  CHECK(strata.list.back().others.size() <= 1024);
  CHECK(strata.left_out < 0.01 * strata.list.back().probability);
}

TEST_CASE("an event by two of many rare values has its probability, however many strata they make",
          "[rare]") {
  for (const int parts : {8, 14, 24}) {
    Json json = rare_values(parts, 1e-3);
    json["scene"]["hinges"][0]["friction"] = {{"coulomb", 0.1}, {"model", "exact"}};
    for (Json& part : json["dispersions"]) {
      part["distribution"]["values"] = {0, 0.7};
      part["apply"] = "add";
      part["to"] = {"hinges.h.friction.coulomb"};
    }
    json["dispersions"].push_back(normal_law("s", 1, 0.01, "scale", "hinges.h.spring.scale"));
    const RareResult found = estimate_of(json, {.samples = 200, .repeats = 1});
    const double exact = boost::math::cdf(
        boost::math::complement(boost::math::binomial_distribution<>(parts, 1e-3), 1));
    CAPTURE(parts, exact);
    CHECK(found.estimate.probability == Approx(exact).epsilon(0.02));
    CHECK(found.estimate.interval.lower <= exact);
    CHECK(found.estimate.interval.upper >= exact);
    CHECK(found.estimate.interval.upper < 1.1 * exact);
  }
}
