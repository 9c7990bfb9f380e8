#include "montecarlo/model/input_checks/dispersion_checks.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <set>

using namespace wingspread;
using namespace wingspread::test;

namespace {

using Pair = std::pair<std::size_t, std::size_t>;

/// The warnings of a campaign with these correlations between a spring and three masses.
std::vector<InputWarning> told_of(Campaign& campaign, const std::vector<Pair>& pairs,
                                  double spearman) {
  campaign.wanted_correlations.clear();
  for (const auto& [a, b] : pairs) campaign.wanted_correlations.push_back({a, b, spearman});
  InputWarnings warnings({"campaign.json"});
  check_correlations(campaign, warnings);
  return warnings.list();
}

} // namespace

TEST_CASE("three dispersions have a common cause where each is correlated with both others",
          "[warnings]") {
  Campaign campaign = campaign_of(quick_campaign(1));
  const auto name = [&](std::size_t k) { return campaign.dispersions[k].name; };
  const std::vector<Pair> all{{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}};
  for (unsigned chosen = 0; chosen < 1U << all.size(); ++chosen) {
    std::vector<Pair> pairs;
    for (std::size_t k = 0; k < all.size(); ++k)
      if ((chosen >> k & 1U) != 0) pairs.push_back(all[k]);
    const std::set<Pair> named(pairs.begin(), pairs.end());
    std::set<std::string> triples; // in any order of the three
    for (std::size_t c = 2; c < 4; ++c)
      for (std::size_t b = 1; b < c; ++b)
        for (std::size_t a = 0; a < b; ++a)
          if (named.contains({a, b}) && named.contains({b, c}) && named.contains({a, c}))
            for (const auto& [i, j, k] :
                 {std::array{a, b, c}, {a, c, b}, {b, a, c}, {b, c, a}, {c, a, b}, {c, b, a}})
              triples.insert(name(i) + ", " + name(j) + " and " + name(k) +
                             ", each correlated with the others");
    for (const bool backwards : {false, true}) { // as the campaign lists them
      if (backwards) std::ranges::reverse(pairs);
      CAPTURE(chosen, backwards);
      const auto told = told_of(campaign, pairs, backwards ? -0.6 : 0.6);
      REQUIRE(told.size() == (triples.empty() ? 0 : 1));
      if (triples.empty()) continue;
      CHECK(told[0].pointer == "/correlations");
      CHECK(triples.contains(told[0].found));
      CHECK(told_of(campaign, pairs, 0.49).empty());
    }
  }
}

TEST_CASE("a correlation of 0.8 and more, of either sign, has one cause", "[warnings]") {
  Campaign campaign = campaign_of(quick_campaign(1));
  for (const double spearman : {0.0, 0.5, 0.79, 0.8, 0.95})
    for (const double sign : {-1, 1}) {
      CAPTURE(spearman, sign);
      const auto told = told_of(campaign, {{0, 1}, {2, 3}}, sign * spearman);
      REQUIRE(told.size() == (spearman < 0.8 ? 0 : 2));
      if (spearman < 0.8) continue;
      CHECK(told[0].pointer == "/correlations/0");
      CHECK(told[1].pointer == "/correlations/1");
      CHECK_THAT(told[1].found, Catch::EndsWith("of mass.panel_2 and mass.panel_3"));
    }
}

TEST_CASE("a correlation with a law of a single value is told, whichever of both it is",
          "[warnings]") {
  for (const std::size_t constant : {0, 1, 2}) {
    Campaign campaign = campaign_of(quick_campaign(1));
    campaign.dispersions[constant].distribution.law = Constant{1};
    const auto told = told_of(campaign, {{2, 3}, {1, 0}}, 0.6);
    REQUIRE(told.size() == 1);
    CHECK(told[0].pointer == (constant == 2 ? "/correlations/0" : "/correlations/1"));
    CHECK_THAT(told[0].found, Catch::Contains(campaign.dispersions[constant].name));
  }
}

TEST_CASE("what ties leave of a correlation is told where it is much less", "[warnings]") {
  Campaign campaign = campaign_of(quick_campaign(1));
  for (const auto& [weight, told] : {std::pair(0.5, false), {0.99, true}}) {
    campaign.dispersions[1].distribution.law = Discrete{{1, 2, 3, 4}, {0.4, 0.3, 0.2, 0.1}};
    if (told) campaign.dispersions[1].distribution.law = Discrete{{1, 2}, {weight, 1 - weight}};
    const auto warnings =
        told_of(campaign, {{0, 1}}, told ? 0.9 : 0.7); // beside a common cause too
    CHECK(std::ranges::any_of(warnings, [](const InputWarning& each) {
            return each.pointer == "/correlations/0/spearman" &&
                   each.found.find("ties leave") != std::string::npos;
          }) == told);
  }
}
