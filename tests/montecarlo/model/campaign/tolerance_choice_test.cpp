#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/tolerance_choice.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

Json with_integration(const char* integration) {
  Json campaign = small_campaign();
  campaign["integration"] = parse_json(integration);
  return campaign;
}

Campaign read_integrated(const char* integration) {
  return read_campaign(with_integration(integration).dump(), "");
}

struct IntegrationCase {
  const char *integration, *message;
};

} // namespace

TEST_CASE("a tolerance can be left to a pilot", "[tolerance_choice]") {
  const Campaign campaign = read_integrated(R"({"rtol": "auto"})");
  REQUIRE(campaign.tolerance);
  CHECK(campaign.tolerance->share == 0.01);
  CHECK_FALSE(campaign.tolerance->has_atol);
  CHECK_FALSE(campaign.tolerance->pilot);
  CHECK(campaign.resolved["integration"].dump() ==
        R"({"method":"auto","rtol":"auto","latch":"event","t_end":60.0,"max_steps":1000000,)"
        R"("rtol_share":0.01})");
  CHECK(read_campaign(campaign.resolved.dump(), "").resolved == campaign.resolved);
  const Campaign given = read_integrated(R"({"rtol": "auto", "atol": 1e-9, "rtol_share": 0.1})");
  CHECK(given.tolerance->share == 0.1);
  CHECK(given.tolerance->has_atol);
  CHECK(given.resolved["integration"]["atol"] == 1e-9);
  CHECK_FALSE(read_integrated(R"({"rtol": 1e-6})").tolerance);
  CHECK_FALSE(read_integrated(R"({})").tolerance);
}

TEST_CASE("what a pilot has chosen is read as it was written", "[tolerance_choice]") {
  const char* integration =
      R"({"method":"auto","rtol":1e-07,"atol":1e-09,"latch":"event","t_end":60.0,)"
      R"("max_steps":1000000,"rtol_share":0.01,"rtol_pilot":{"seed":18446744073709551615,)"
      R"("runs":32,"for_runs":100,"repeated":[0,5,31],"not_reached":true}})";
  const Campaign campaign = read_integrated(integration);
  CHECK(campaign.integration.rtol == 1e-7);
  CHECK(campaign.integration.atol == 1e-9);
  REQUIRE(campaign.tolerance);
  CHECK(campaign.tolerance->pilot ==
        TolerancePilot{18446744073709551615ULL, 32, {0, 5, 31}, 100, false});
  CHECK(campaign.resolved["integration"].dump() == integration);
}

TEST_CASE("each fault of a tolerance left to a pilot is told", "[tolerance_choice]") {
  const auto [integration, message] = GENERATE(values<IntegrationCase>(
      {{R"({"rtol": "automatic"})", "/integration/rtol: found string \"automatic\", expected a "
                                    "number, ≥ 1e-15 and < 1, or \"auto\""},
       {R"({"rtol": 1e-6, "rtol_share": 0.1})",
        "/integration/rtol_share: found a share of the sampling error beside a fixed \"rtol\", "
        "expected \"rtol\": \"auto\""},
       {R"({"rtol": "auto", "rtol_share": 1})",
        "/integration/rtol_share: found 1, expected a number, > 0 and < 1"},
       {R"({"rtol": "auto", "rtol_pilot": {}})",
        "/integration/rtol_pilot: found a pilot's record beside \"rtol\": \"auto\", expected it "
        "beside the tolerance it chose"},
       {R"({"rtol_pilot": {"seed": 1, "runs": 0, "for_runs": 1, "repeated": [2, 1]}})",
        "/integration/rtol_pilot/runs: found 0, expected an integer, ≥ 1\n"
        "/integration/rtol_pilot/repeated/1: found 1, expected an array of integers ≥ 0, each less "
        "than the next"},
       {R"({"rtol_pilot": {"seed": 1, "runs": 1, "for_runs": 1, "repeated": [0], "not_reached": false}})",
        "/integration/rtol_pilot/not_reached: found false, expected true, or no such key"}}));
  CHECK(message_of([&] { return read_integrated(integration); }) == message);
}
