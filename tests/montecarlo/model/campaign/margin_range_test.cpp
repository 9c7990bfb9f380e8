// The scales that `margin` searches: those of the campaign's file, and those of --range.
#include "montecarlo/model/campaign/overrides.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace wingspread;
using namespace wingspread::test;

namespace {

Json searching(double lower, double upper) {
  Json json = one_panel_margin(10);
  json["margin"]["range"] = {lower, upper};
  return json;
}

} // namespace

TEST_CASE("the widest range of a margin encloses its range at both ends, or is refused",
          "[margin]") {
  std::mt19937_64 random(4);
  const auto between = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  int refused = 0;
  for (int k = 0; k < 40; ++k) {
    const double lower = between(0.3, 1), upper = between(1.1, 3);
    const double lowest = lower * (k % 4 == 1 ? between(1.01, 1.05) : between(0.5, 0.99));
    const double highest = upper * (k % 4 == 2 ? between(0.4, 0.99) : between(1.01, 2));
    Json json = searching(lower, upper);
    json["margin"]["widest"] = {lowest, highest};
    CAPTURE(lower, upper, lowest, highest);
    if (lowest <= lower && upper <= highest) {
      const Campaign campaign = campaign_of(json);
      CHECK((campaign.margin->lowest == lowest && campaign.margin->highest == highest));
    } else {
      ++refused;
      CHECK_THROWS_WITH(campaign_of(json), Catch::StartsWith("/margin/widest: "));
    }
  }
  CHECK(refused == 20);
}

TEST_CASE("the option --range searches as the same range in the file does, whatever the file's "
          "widest range",
          "[margin]") {
  Json json = searching(0.9, 1.2);
  for (const bool given : {false, true}) {
    if (given) json["margin"]["widest"] = {0.8, 1.3};
    for (const auto& [lower, upper] :
         {std::pair(0.95, 1.1), std::pair(0.5, 2.), std::pair(2., 3.)}) {
      CAPTURE(given, lower, upper);
      Campaign campaign = campaign_of(json);
      override_margin(campaign, {}, {lower, upper});
      CHECK(campaign.resolved["margin"] == campaign_of(searching(lower, upper)).resolved["margin"]);
    }
  }
}
