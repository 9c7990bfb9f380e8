// What a fit reports besides its numbers.
#include "montecarlo/analyses/fit/fit_report.hpp"
#include "montecarlo/analyses/fit/fit_study.hpp"
#include "montecarlo/foundation/formats/csv.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a std in another unit, and tests that contradict the prior, are told") {
  const Folder folder;
  // the trace sees 2 N·m × spring − 0.3 N·m × friction: a narrow prior of the friction leaves a conflict to the spring
  const Campaign campaign = campaign_of(panel_campaign(0.05, 0.1));
  const auto findings = [&](double spring, double friction, double std) {
    folder.write("t1.csv", panel_trace(spring, friction, 0, 0.005, 1));
    Json tests = parse_json(one_way);
    tests["fit"]["samples"] = 100;
    tests["tests"][0]["trace"]["columns"]["root.angle"]["std"] = std;
    const FitSpec spec = read_fit(tests, "", folder.path(), campaign);
    return fit_findings(fitted(campaign, spec), spec);
  };
  CHECK(findings(1.02, 1.1, 0.005).empty());
  const auto large = findings(1.02, 1.1, 0.29); // 0.29 deg, taken for rad
  REQUIRE(large.size() == 1);
  CHECK(large[0].starts_with("root.angle of \"one way\": the residuals are 0.01"));
  CHECK(large[0].ends_with("is its std too large, or in another unit?"));
  const auto far = findings(1.35, 1, 0.005); // 7 standard deviations of the spring's prior
  REQUIRE_FALSE(far.empty());
  CHECK(far.back().find("standard deviations of its prior from the prior's median") !=
        std::string::npos);
}

// The latch time depends on 2 N·m spring − 0.3 N·m friction alone: an error of the friction moves the spring by 0.15 of
// it.
TEST_CASE("a dispersion that is not fitted is named, and its spread widens what depends on it") {
  const Folder folder;
  const Campaign campaign = campaign_of(panel_campaign(0.5, 0.2));
  Json tests = parse_json(R"({ "tests": [ { "name": "timer",
      "values": [ { "output": "root.latch_time", "value": 2.3, "std": "1 ms" } ] } ],
    "fit": { "parameters": ["spring"], "samples": 400, "starts": 2 } })");
  const FitSpec spec = read_fit(tests, "", folder.path(), campaign);
  const FitResult result = fitted(campaign, spec);
  REQUIRE(result.held.size() == 1);
  CHECK(result.held[0].name == "friction");
  CHECK(result.held[0].median == 1);
  CHECK(result.held[0].prior_std == Approx(0.2).epsilon(1e-2));
  const FittedParameter& spring = result.parameters[0];
  CHECK(spring.widening * spring.std == Approx(std::hypot(spring.std, 0.15 * 0.2)).epsilon(0.02));
  const std::vector<std::string> findings = fit_findings(result, spec);
  REQUIRE_FALSE(findings.empty());
  CHECK_THAT(findings.back(), Catch::Contains("held at its median in all tests: friction = 1 ") &&
                                  Catch::Contains("the posterior sd is: spring 0.03"));
  const Json json = fit_json(result, spec, Json::object());
  CHECK(json["held"]["friction"]["value"] == 1);
  CHECK(json["parameters"]["spring"]["std_with_held"].get<double>() ==
        Approx(spring.widening * spring.std));
  tests["fit"]["parameters"] = {"spring", "friction"};
  tests["tests"].push_back(tests["tests"][0]);
  tests["tests"][1]["name"] = "again";
  const FitSpec both = read_fit(tests, "", folder.path(), campaign);
  CHECK(fitted(campaign, both).held.empty());
}

TEST_CASE("values that deviate little each, but together too much, are told") {
  const Folder folder;
  const Campaign campaign = campaign_of(panel_campaign(0.5, 0.2));
  Json tests = parse_json(R"({ "tests": [],
    "fit": { "parameters": ["spring", "friction"], "samples": 200, "starts": 2 } })");
  const auto study = [&](double off) {
    tests["tests"].clear();
    for (int k = 0; k < 10; ++k)
      tests["tests"].push_back({{"name", "timer " + std::to_string(k)},
                                {"values",
                                 {{{"output", "root.latch_time"},
                                   {"value", 2.35 + (k % 2 == 0 ? off : -off)},
                                   {"std", 0.0215}}}}});
    const FitSpec spec = read_fit(tests, "", folder.path(), campaign);
    const FitResult result = fitted(campaign, spec);
    // The mean fits at the mode: χ² = Σ (off/std)².
    CHECK(result.values.chi_squared == Approx(10 * std::pow(off / 0.0215, 2)).epsilon(0.01));
    CHECK(fit_json(result, spec, Json::object())["values"]["n"] == 10);
    return std::pair(result.values.p_value, fit_findings(result, spec));
  };
  const auto [p, findings] = study(0.05); // 2.3 σ each
  CHECK(p < 1e-6);                        // χ² 54 of 10 numbers: 5e-8
  REQUIRE(findings.size() == 1);
  CHECK_THAT(findings[0], Catch::Contains("10 measured values together"));
  const auto [fits, none] = study(0.02);
  CHECK(fits == Approx(0.5).margin(0.2)); // χ² 8.7
  CHECK(none.empty());
}

TEST_CASE(
    "a clock that is late is told where the residuals count as few, and a trace given twice") {
  const Folder folder;
  const Campaign campaign = campaign_of(panel_campaign(0.5, 0.2));
  const auto findings = [&](double late, bool twice) {
    std::string text = "t,th\n";
    RandomStream random(3, 0, stream_name("trace"));
    for (int k = 0; k <= 80; ++k) {
      const double z = inverse(Normal{}, tails_of_uniform(open_uniform(random())));
      text += std::to_string(0.02 * k) + "," +
              csv_cell(panel_angle(std::max(0.0, 0.02 * k - late), 1, 1) + 0.005 * z) + "\n";
    }
    folder.write("t1.csv", text);
    Json tests = parse_json(one_way);
    tests["fit"]["samples"] = 100;
    tests["tests"][0]["trace"].erase("correlated");
    if (twice) tests["tests"].push_back(tests["tests"][0]), tests["tests"][1]["name"] = "again";
    const FitSpec spec = read_fit(tests, "", folder.path(), campaign);
    return fmt::format("{}", fmt::join(fit_findings(fitted(campaign, spec), spec), "\n"));
  };
  CHECK(findings(0, false).empty());
  CHECK_THAT(findings(0.1, false), Catch::Contains("depend on each other") &&
                                       Catch::Contains("the model lacks something"));
  CHECK_THAT(findings(0, true), Catch::Equals("\"again\" has the numbers of \"one way\": the same "
                                              "trace counts twice"));
}

TEST_CASE("what is held widens a standard deviation at most to the prior's, and then says so") {
  FitResult result;
  result.finished = true;
  result.held.push_back({"mass", 1, 1, 0.005});
  FittedParameter& spring = result.parameters.emplace_back();
  spring.name = "spring", spring.prior_std = 0.1, spring.std = 0.008;
  const auto finding = [&](double factor) {
    spring.widen(factor);
    return fit_findings(result, FitSpec()).back();
  };
  CHECK_THAT(finding(365), Catch::Contains("spring 0.1 in place of 0.008 (as wide as the prior: "
                                           "the held values decide it)"));
  CHECK(spring.widening * spring.std == Approx(0.1));
  CHECK_THAT(finding(2), Catch::Contains("spring 0.016 in place of 0.008") &&
                             !Catch::Contains("as wide as the prior"));
  spring.std = 0.12; // another mode: wider than the prior without what is held
  CHECK_THAT(finding(3), Catch::Contains("spring 0.12 in place of 0.12 (as wide as the prior"));
  CHECK_THAT(finding(std::nan("")), Catch::Contains("as wide as the prior"));
}

TEST_CASE("one bad sample is named with its time, not the whole trace") {
  const Folder folder;
  std::string text = "t,th\n";
  for (int k = 0; k <= 80; ++k)
    text += csv_cell(0.02 * k) + "," +
            csv_cell(panel_angle(0.02 * k, 1.02, 1.1) + (k == 40 ? 0.5 : 1e-3 * std::sin(9 * k))) +
            "\n";
  folder.write("t1.csv", text);
  const Campaign campaign = campaign_of(panel_campaign());
  Json tests = parse_json(one_way);
  tests["fit"]["samples"] = 100;
  const FitSpec spec = read_fit(tests, "", folder.path(), campaign);
  const FitResult result = fitted(campaign, spec);
  REQUIRE(result.channels[0].outliers.size() == 1);
  CHECK(result.channels[0].outliers[0].time == Approx(0.8));
  CHECK(result.channels[0].outliers[0].sigmas == Approx(100).epsilon(0.1));
  const double rms = result.channels[0].rms, rest = result.channels[0].rest_rms,
               bad = 0.005 * result.channels[0].outliers[0].sigmas;
  CHECK(80 * rest * rest == Approx(81 * rms * rms - bad * bad).epsilon(1e-6));
  CHECK((rest > 0 && rest < 0.3 * rms));
  const std::string first = fit_findings(result, spec).front();
  CHECK_THAT(first, Catch::StartsWith("root.angle of \"one way\": 1 of 81 numbers is far from the "
                                      "rest: ") &&
                        Catch::Contains(" deg at 0.8 s, ") && Catch::Contains(" σ from the fit"));
  const Json json = fit_json(result, spec, Json::object());
  CHECK(json["tests"][0]["traces"]["root.angle"]["outliers"].size() == 1);
}

TEST_CASE(
    "a sensor's offset that its std hardly allows is told, whether its noise is known or not") {
  const Folder folder;
  const Campaign campaign = campaign_of(panel_campaign());
  const auto told = [&](double offset, bool known) {
    std::string text = "t,th\n";
    RandomStream random(3, 0, stream_name("noise"));
    for (int k = 0; k <= 80; ++k) {
      const double z = inverse(Normal{}, tails_of_uniform(open_uniform(random())));
      text += csv_cell(0.02 * k) + "," +
              csv_cell(panel_angle(0.02 * k, 1, 1) + offset + 0.005 * z) + "\n";
    }
    folder.write("t1.csv", text);
    Json tests =
        parse_json(R"({ "tests": [ { "name": "one", "trace": { "file": "t1.csv", "time": "t",
        "columns": { "root.angle": { "column": "th", "offset_std": 0.01 } } } } ],
      "fit": { "parameters": ["spring"], "samples": 300, "starts": 2 } })");
    if (known) tests["tests"][0]["trace"]["columns"]["root.angle"]["std"] = 0.005;
    const FitSpec spec = read_fit(tests, "", folder.path(), campaign);
    const auto findings = fit_findings(fitted(campaign, spec), spec);
    return std::ranges::any_of(findings, [](const std::string& finding) {
      return finding.find("offset of root.angle") != std::string::npos &&
             finding.find("contradict") != std::string::npos;
    });
  };
  for (const bool known : {true, false}) {
    CHECK(told(0.08, known));
    CHECK_FALSE(told(0.02, known));
  }
}

TEST_CASE("a posterior at a limit of its prior is told") {
  const Folder folder;
  Json json = panel_campaign();
  json["dispersions"][0]["distribution"] =
      parse_json(R"({ "type": "uniform", "lower": 0.9, "upper": 1.1 })");
  const Campaign campaign = campaign_of(json);
  const auto findings = [&](double spring) {
    folder.write("t1.csv", panel_trace(spring, 1, 0, 0.005, 1));
    Json tests = parse_json(one_way);
    tests["fit"]["samples"] = 100, tests["fit"]["parameters"] = {"spring"};
    const FitSpec spec = read_fit(tests, "", folder.path(), campaign);
    std::string text;
    for (const std::string& each : fit_findings(fitted(campaign, spec), spec)) text += each + '\n';
    return text;
  };
  CHECK_THAT(findings(1.3), Catch::Contains("spring lies at the limit 1.1 of its prior"));
  CHECK_THAT(findings(0.7), Catch::Contains("spring lies at the limit 0.9 of its prior"));
  CHECK_THAT(findings(1.0), !Catch::Contains("at the limit"));
}

TEST_CASE("a prior that is cut on one side only has a limit there, and one that fades out none") {
  const Folder folder;
  folder.write("t1.csv", panel_trace(0.7, 1, 0, 0.005, 1));
  const auto limit_of = [&](const char* law) {
    Json json = panel_campaign();
    json["dispersions"][0]["distribution"] = parse_json(law);
    const Campaign campaign = campaign_of(json);
    Json tests = parse_json(one_way);
    tests["fit"]["samples"] = 100, tests["fit"]["parameters"] = {"spring"};
    const FitSpec spec = read_fit(tests, "", folder.path(), campaign);
    const FitResult result = fitted(campaign, spec);
    const Json fit = fit_json(result, spec, Json::object());
    CHECK(fit["at_limits"] == (result.parameters[0].limit ? Json{"spring"} : Json::array()));
    CHECK((fit_text(result, spec).find("\n    at the limit 0.95 of its prior") !=
           std::string::npos) == result.parameters[0].limit.has_value());
    return result.parameters[0].limit;
  };
  CHECK(
      limit_of(R"({ "type": "normal", "mean": 1, "std": 0.05, "truncate": { "lower": 0.95 } })") ==
      0.95);
  CHECK_FALSE(limit_of(R"({ "type": "lognormal", "mu_log": 0, "sigma_log": 0.05 })"));
  // 3 standard deviations below its mean a normal law has faded out, wherever its zero is
  CHECK_FALSE(
      limit_of(R"({ "type": "normal", "mean": 1, "std": 0.05, "truncate": { "lower": 0.85 } })"));
}

TEST_CASE("the findings name the laws of cases that the written campaign does not have") {
  const Folder folder;
  folder.write("t1.csv", panel_trace(1.02, 1.1, 0, 0.005, 1));
  Json json = panel_campaign();
  json["cases"] = parse_json(R"([ { "name": "cold", "distributions": {
    "friction": { "type": "normal", "mean": 2, "std": 0.3 } } } ])");
  const Campaign campaign = campaign_of(json);
  Json tests = parse_json(one_way);
  tests["fit"]["samples"] = 100;
  const FitSpec spec = read_fit(tests, "", folder.path(), campaign);
  const FitResult result = fitted(campaign, spec);
  REQUIRE_FALSE(fit_findings(result, spec).empty());
  CHECK(fit_findings(result, spec).back().ends_with(": cold: friction"));
}

namespace {

/// The spring fitted to one latch time.
FitSpec timed_once(const Campaign& campaign, const Folder& folder) {
  return read_fit(parse_json(R"({ "tests": [ { "name": "timer",
      "values": [ { "output": "root.latch_time", "value": 2.3, "std": "1 ms" } ] } ],
    "fit": { "parameters": ["spring"], "samples": 100, "starts": 2 } })"),
                  "", folder.path(), campaign);
}

} // namespace

// To first order the spring moves by 0.15 of what the friction is off, whatever the friction's law.
TEST_CASE("what is held widens by the standard deviation of its law, whatever the law") {
  const Folder folder;
  const double half = 0.2 * std::sqrt(3.0);
  const std::vector<std::pair<Json, double>> laws{
      {{{"type", "uniform"}, {"lower", 1 - half}, {"upper", 1 + half}}, 0.2},
      {{{"type", "discrete"}, {"values", {0.8, 1.2}}, {"weights", {1, 1}}}, 0.2},
      {{{"type", "discrete"}, {"values", {1, 2}}, {"weights", {0.99, 0.01}}}, std::sqrt(0.0099)},
      {{{"type", "empirical"}, {"values", {0.8, 0.8, 1.2, 1.2}}}, 0.2},
      {{{"type", "triangular"}, {"lower", 0.5}, {"mode", 1}, {"upper", 1.5}},
       0.5 / std::sqrt(6.0)}};
  for (const auto& [law, std] : laws) {
    Json json = panel_campaign(0.5, 0.2);
    for (Json& each : json["dispersions"])
      if (each["name"] == "friction") each["distribution"] = law;
    const Campaign campaign = campaign_of(json);
    const FitSpec spec = timed_once(campaign, folder);
    const FitResult result = fitted(campaign, spec);
    CAPTURE(law.dump());
    REQUIRE(result.held.size() == 1);
    CHECK(result.held[0].prior_std == Approx(std).epsilon(1e-9));
    const FittedParameter& spring = result.parameters[0];
    CHECK(spring.widening * spring.std == Approx(std::hypot(spring.std, 0.15 * std)).epsilon(0.02));
  }
}

// The torque is 2 N·m spring − 0.3 N·m − a − b: an error of a + b moves the spring by half of it.
TEST_CASE("columns of held rows widen together, as far as they go with each other") {
  const Folder folder;
  const auto widened = [&](double sign) {
    Json json = panel_campaign(0.5, 0.2);
    json["dispersions"].erase(1);
    json["dispersions"].push_back(parse_json(R"({ "name": "shop", "rows": { "apply": "add",
      "columns": { "a": "hinges.root.friction.coulomb", "b": "hinges.root.friction.coulomb" } } })"));
    Json a = Json::array(), b = Json::array();
    for (int k = -2; k <= 2; ++k) a.push_back(0.02 * k), b.push_back(sign * 0.02 * k);
    json["dispersions"][1]["rows"]["values"] = {{"a", a}, {"b", b}};
    const Campaign campaign = campaign_of(json);
    const FitSpec spec = timed_once(campaign, folder);
    const FitResult result = fitted(campaign, spec);
    REQUIRE(result.held.size() == 2);
    const FittedParameter& spring = result.parameters[0];
    return std::pair(spring.widening * spring.std, spring.std);
  };
  const double std = 0.02 * std::sqrt(2.0); // of −2 … 2
  const auto [together, alone] = widened(1);
  CHECK(together == Approx(std::hypot(alone, std)).epsilon(0.02));
  const auto [against, own] = widened(-1);
  CHECK(against == Approx(own).epsilon(0.02));
}

TEST_CASE("a prior's moments are those of its law, also where it is cut") {
  CHECK(moments_of({Normal{3, 0.03}, std::nullopt}).standard_deviation == 0.03);
  const LawMoments wide = moments_of({Lognormal{0, 1}, std::nullopt});
  CHECK(wide.mean == Approx(std::exp(0.5)).epsilon(1e-12));
  CHECK(wide.standard_deviation ==
        Approx(std::sqrt((std::exp(1) - 1) * std::exp(1))).epsilon(1e-12));
  const LawMoments half = moments_of({Normal{0, 1}, Truncation{0}});
  CHECK(half.mean == Approx(std::sqrt(2 / std::numbers::pi)).epsilon(1e-3));
  CHECK(half.standard_deviation == Approx(std::sqrt(1 - 2 / std::numbers::pi)).epsilon(1e-3));
}

// The numbers that the tests lack are the priors': one measured spring teaches nothing of the friction.
TEST_CASE("fewer numbers than parameters leave the rest to the priors, and are told") {
  const Folder folder;
  const Campaign campaign = campaign_of(panel_campaign());
  const FitSpec spec = read_fit(parse_json(R"({ "tests": [ { "name": "bench", "values": [
      { "parameter": "hinges.root.spring.scale", "value": 1.1, "std": 0.05 } ] } ],
    "fit": { "parameters": ["spring", "friction"], "samples": 2000, "starts": 2 } })"),
                                "tests.json", folder.path(), campaign);
  const FitResult result = fitted(campaign, spec);
  REQUIRE(result.finished);
  CHECK(result.parameters[0].mean == Approx(1.05).margin(4 * 0.036 / std::sqrt(2000.0)));
  CHECK(result.parameters[0].std == Approx(0.05 / std::sqrt(2.0)).epsilon(0.08));
  CHECK(result.parameters[1].mean == Approx(1).margin(4 * 0.3 / std::sqrt(2000.0)));
  CHECK(result.parameters[1].std == Approx(0.3).epsilon(0.08));
  const std::vector<std::string> findings = fit_findings(result, spec);
  CHECK(std::ranges::any_of(findings, [](const std::string& finding) {
    return finding.find("1 measured number for 2 parameters") != std::string::npos;
  }));
}
