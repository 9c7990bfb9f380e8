#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a case is asked for by its name, and only of a campaign that has it", "[cases]") {
  const Campaign plain = campaign_of(quick_campaign(4));
  Json json = quick_campaign(4);
  json["cases"] = parse_json(R"([ { "name": "hot" }, { "name": "cold" } ])");
  const Campaign with_cases = campaign_of(json);
  const auto chosen = [](const Campaign& campaign, const std::vector<std::string>& names) {
    return message_of([&] { return chosen_cases(campaign, names); });
  };
  CHECK(chosen_cases(plain, {}).empty());
  CHECK_THAT(chosen(plain, {"hot"}), Catch::StartsWith("--case: found \"hot\"") &&
                                         Catch::Contains("the campaign has none"));
  CHECK_THAT(chosen(with_cases, {"hot", "could"}), Catch::StartsWith("--case: found \"could\"") &&
                                                       Catch::Contains("\"hot\"") &&
                                                       Catch::Contains("did you mean \"cold\""));
  const std::vector<CaseSpec> both = chosen_cases(with_cases, {});
  REQUIRE(both.size() == 2);
  CHECK((both[0].name == "hot" && both[1].name == "cold"));
  const std::vector<std::string> one{"cold"};
  REQUIRE(chosen_cases(with_cases, one).size() == 1);
  CHECK(chosen_cases(with_cases, one)[0].name == "cold");
}
