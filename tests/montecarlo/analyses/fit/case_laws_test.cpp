// Fits of tests in cases that give a dispersion a law of their own.
#include "montecarlo/analyses/fit/fit_report.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// The panel; in the case "cold" its spring has 0.8 ± 0.05 of the torque.
Campaign cold_campaign() {
  Json json = panel_campaign();
  json["cases"] = parse_json(R"([ { "name": "cold", "distributions":
    { "spring": { "type": "normal", "mean": 0.8, "std": 0.05 } } } ])");
  return campaign_of(json);
}

/// A torque test in the case: its spring has 0.79 ± 0.005.
Json torque_test() {
  return parse_json(R"({ "tests": [ { "name": "torque meter", "case": "cold",
      "values": [ { "parameter": "hinges.root.spring.scale", "value": 0.79, "std": 0.005 } ] } ],
    "fit": { "parameters": ["spring"], "samples": 1000, "starts": 2 } })");
}

bool told(const FitResult& result, const FitSpec& spec, const std::string& words) {
  const std::vector<std::string> findings = fit_findings(result, spec);
  return std::ranges::any_of(findings, [&](const std::string& finding) {
    return finding.find(words) != std::string::npos;
  });
}

} // namespace

TEST_CASE("a parameter to which a test's case gives another law is the test's own", "[fit]") {
  const Campaign campaign = cold_campaign();
  Json tests = torque_test();
  const auto problem = [&] {
    return message_of([&] { return read_fit(tests, "t.json", ".", campaign); });
  };
  CHECK_THAT(problem(), Catch::Contains("t.json: /tests/0/case: ") &&
                            Catch::Contains("\"spring\"") && Catch::Contains("\"own\""));
  tests["tests"][0]["own"] = {"spring"};
  CHECK(problem().empty());
  tests["tests"][0]["own"] = {"spring", "spr*"};
  CHECK_THAT(problem(), Catch::Contains("/tests/0/own/1: ") && Catch::Contains("\"spring\""));
  tests["tests"][0].erase("own");
  tests["tests"][0].erase("case");
  CHECK(problem().empty());
  tests["candidates"] = tests["tests"];
  tests["candidates"][0]["case"] = "cold";
  tests["candidates"][0]["values"][0].erase("value");
  CHECK_THAT(problem(), Catch::Contains("/candidates/0/case: "));
  tests["fit"]["parameters"] = {"friction"};
  tests["tests"][0]["values"][0]["parameter"] = "hinges.root.friction.scale";
  CHECK(problem().empty()); // the case leaves friction as it is
}

// Of two normal laws, the prior's in the case and the measured one, the posterior is known.
TEST_CASE("a test's own parameter has prior and posterior by the law of the test's case", "[fit]") {
  const Campaign campaign = cold_campaign();
  Json tests = torque_test();
  tests["tests"][0]["own"] = {"spring"};
  const FitSpec spec = read_fit(tests, "", ".", campaign);
  const FitResult result = fitted(campaign, spec);
  REQUIRE(result.parameters.size() == 1);
  const FittedParameter& spring = result.parameters[0];
  const double precision = 1 / (0.05 * 0.05) + 1 / (0.005 * 0.005);
  const double mean = (0.8 / (0.05 * 0.05) + 0.79 / (0.005 * 0.005)) / precision;
  const double std = 1 / std::sqrt(precision);
  CHECK(spring.prior_mean == Approx(0.8));
  CHECK(spring.prior_std == Approx(0.05));
  CHECK(spring.mode == Approx(mean).margin(1e-4 * std));
  CHECK(spring.mean == Approx(mean).margin(0.2 * std));
  CHECK(spring.std == Approx(std).epsilon(0.1));
  CHECK(told(result, spec, "no posterior.csv")); // of other units nothing is known
  CHECK(result.posterior.columns.empty());
}

TEST_CASE("what is held is held at the median of each test's own law, and told so", "[fit]") {
  const Campaign campaign = cold_campaign();
  Json tests = torque_test();
  tests["tests"][0]["values"] = parse_json(R"([ { "output": "root.latch_time", "std": 0.02 } ])");
  tests["tests"][0]["values"][0]["value"] = panel_latch_time(0.8, 1);
  tests["fit"]["parameters"] = {"friction"};
  const FitSpec spec = read_fit(tests, "", ".", campaign);
  const FitResult result = fitted(campaign, spec);
  CHECK(result.parameters.at(0).mode == Approx(1).margin(1e-3));
  CHECK(told(result, spec, "spring = 1 (prior 1 +- 0.05; 0.8 in \"torque meter\""));
  const Json json = fit_json(result, spec, Json::object());
  CHECK(json["held"]["spring"]["in_tests"]["torque meter"].get<double>() == Approx(0.8));
  CHECK_FALSE(told(result, spec, "no posterior.csv"));
  CHECK_FALSE(json["held"].contains("friction"));
}
