#include "montecarlo/model/campaign/campaign_settings.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

struct Case {
  const char *json, *message;
};

} // namespace

TEST_CASE("Sampling is read over its defaults, and written in full", "[campaign_settings]") {
  const auto [sampling, problems] =
      read(R"({"runs": 1e4, "seed": 18446744073709551615})", Sampling{}, read_sampling);
  CHECK(problems.empty());
  CHECK(sampling.runs == 10000);
  CHECK(write_sampling(sampling).dump() ==
        R"({"design":"random","runs":10000,"seed":18446744073709551615,"replicates":1})");
  CHECK(read(R"({"design": "sobol"})", Sampling{}, read_sampling).settings.design ==
        DesignKind::sobol);
  CHECK(read(R"({"replicates": 16})", Sampling{}, read_sampling).settings.replicates == 16);
  CHECK(read(R"({"replicates": 16, "runs": 8})", Sampling{}, read_sampling).problems.empty());
}

TEST_CASE("Each fault of the sampling is told", "[campaign_settings]") {
  const auto [json, message] = GENERATE(values<Case>(
      {{"1000", "found 1000, expected an object with the sampling"},
       {R"({"runs": 0})", "/runs: found 0, expected an integer, ≥ 1"},
       {R"({"runs": 2147483648})", "/runs: found 2147483648, expected at most 2147483647"},
       {R"({"runs": 1.5})", "/runs: found 1.5, expected an integer, ≥ 1"},
       {R"({"seed": -1})", "/seed: found -1, expected an integer from 0 to 2^64 - 1"},
       {R"({"replicates": "2"})", "/replicates: found string \"2\", expected an integer, ≥ 1"},
       {R"({"design": "sobol", "runs": 8, "replicates": 9})",
        "/replicates: found 9, expected at most the number of runs, 8"},
       {R"({"design": "latin_hypercube", "runs": 8000000, "replicates": 1000001})",
        "/replicates: found 1000001, expected at most 1000000"},
       {R"({"design": "lhs"})",
        "/design: found string \"lhs\", expected \"random\", \"latin_hypercube\" or \"sobol\""},
       {R"({"run": 1})",
        "/run: found the unknown key \"run\", expected \"design\", \"runs\", \"seed\", "
        "\"replicates\" or \"extended_from\" (did you mean \"runs\"?)"}}));
  CHECK(facts_of(read(json, Sampling{}, read_sampling).problems) == facts_of(message));
}

TEST_CASE("A tolerance is a number, and the refusal of \"auto\" shows one", "[campaign_settings]") {
  CHECK(read(R"({"rtol": "auto"})", Integration{}, read_integration).problems ==
        "/rtol: found string \"auto\", expected a number, ≥ 1e-15 and < 1, for example 1e-8");
}

TEST_CASE("Integration is read over its defaults, and written in full", "[campaign_settings]") {
  const auto [integration, problems] =
      read(R"({"rtol": 1e-6, "latch": {"smoothed": 0.01}})", Integration{}, read_integration);
  CHECK(problems.empty());
  CHECK(integration.rtol == 1e-6);
  CHECK(integration.smoothing == 0.01);
  CHECK(write_integration(integration).dump() ==
        R"({"method":"auto","rtol":1e-06,"atol":1e-10,"latch":{"smoothed":0.01},"t_end":60.0,)"
        R"("max_steps":1000000})");
  CHECK(write_integration({}).at("latch") == "event");
  for (const MethodInfo& method : methods()) {
    const Json json{{"method", method.name}, {"latch", "event"}};
    CHECK(read(json.dump().c_str(), integration, read_integration).settings.method == method.name);
    CHECK_FALSE(read(json.dump().c_str(), integration, read_integration).settings.smoothing);
  }
}

TEST_CASE("A step is written for the method that takes it, and for no other",
          "[campaign_settings]") {
  Integration integration;
  CHECK_FALSE(write_integration(integration).contains("step"));
  integration.method = "runge_kutta4";
  integration.step = 0.002;
  CHECK(write_integration(integration).at("step") == 0.002);
  CHECK(has_fixed_step("runge_kutta4"));
  CHECK_FALSE(has_fixed_step("auto"));
}

TEST_CASE("A step is read with the method that takes it", "[campaign_settings]") {
  const auto [integration, problems] =
      read(R"({"step": 0.002, "method": "runge_kutta4"})", Integration{}, read_integration);
  CHECK(problems.empty());
  CHECK(integration.step == 0.002);
  // An option that follows the file's settings: the method is the file's.
  CHECK(read(R"({"step": 0.001})", integration, read_integration).settings.step == 0.001);
  CHECK(read(R"({"method": "runge_kutta4"})", Integration{}, read_integration).settings.step ==
        1e-4);
  const auto [json, message] = GENERATE(values<Case>(
      {{R"({"method": "runge_kutta4", "step": 0})", "/step: found 0, expected a number, s, > 0"},
       {R"({"method": "runge_kutta4", "step": -1e-3})",
        "/step: found -0.001, expected a number, s, > 0"},
       {R"({"method": "runge_kutta4", "step": "0 ms"})",
        "/step: found string \"0 ms\", expected a number, s, > 0"},
       {R"({"method": "runge_kutta4", "step": "1 m"})",
        "/step: found string \"1 m\", expected a number, s, > 0, or a string of a number and its "
        "unit: \"s\", \"ms\", \"min\" or \"h\""}}));
  CHECK(facts_of(read(json, Integration{}, read_integration).problems) == facts_of(message));
}

TEST_CASE("Times and angles of the integration may have their units", "[campaign_settings]") {
  const auto [integration, problems] =
      read(R"({"t_end": "2 min", "step": "0.5 ms", "method": "runge_kutta4",
               "latch": {"smoothed": "0.1 mrad"}})",
           Integration{}, read_integration);
  CHECK(problems.empty());
  CHECK(integration.t_end == 120);
  CHECK(integration.step == 0.0005);
  CHECK(integration.smoothing == 0.0001);
  CHECK(write_integration(integration)["t_end"] == 120); // SI in what is written
}

TEST_CASE("Each fault of the integration is told", "[campaign_settings]") {
  const auto [json, message] = GENERATE(values<Case>(
      {{"[]", "found an array of 0, expected an object with the integration"},
       {R"({"rtol": 0})", "/rtol: found 0, expected a number, ≥ 1e-15 and < 1, for example 1e-8"},
       {R"({"rtol": 1e-40})",
        "/rtol: found 1e-40, expected a number, ≥ 1e-15 and < 1, for example 1e-8"},
       {R"({"rtol": 9e-16, "atol": 1e-40})",
        "/rtol: found 9e-16, expected a number, ≥ 1e-15 and < 1, for example 1e-8"},
       {R"({"rtol": 1})", "/rtol: found 1, expected a number, ≥ 1e-15 and < 1, for example 1e-8"},
       {R"({"atol": -1e-9})", "/atol: found -1e-09, expected a number, > 0"},
       {R"({"t_end": 0})", "/t_end: found 0, expected a number, s, > 0"},
       {R"({"t_end": "-1 min"})", "/t_end: found string \"-1 min\", expected a number, s, > 0"},
       {R"({"t_end": "2 deg"})", "/t_end: found string \"2 deg\", expected a number, s, > 0, or a "
                                 "string of a number and its "
                                 "unit: \"s\", \"ms\", \"min\" or \"h\""},
       {R"({"latch": {"smoothed": "1 s"}})",
        "/latch/smoothed: found string \"1 s\", expected a "
        "number, rad, > 0, or a string of a number "
        "and its unit: \"rad\", \"mrad\", \"deg\", \"°\" or \"rev\""},
       {R"({"step": 1e-3})",
        "/step: found 0.001, expected no step with the method \"auto\" (only used by a method with "
        "a fixed step: runge_kutta4)"},
       {R"({"method": "dopri5", "step": 0})",
        "/step: found 0, expected no step with the method \"dopri5\" (only used by a method with a "
        "fixed step: runge_kutta4)"},
       {R"({"max_steps": 0})", "/max_steps: found 0, expected an integer, ≥ 1"},
       {R"({"latch": "smooth"})", "/latch: found string \"smooth\", expected \"event\" or { "
                                  "\"smoothed\": a number, rad, > 0 }"},
       {R"({"latch": {}})", "/latch/smoothed: found nothing, expected a number, rad, > 0"},
       {R"({"latch": {"smoothed": 0, "x": 1}})",
        "/latch/smoothed: found 0, expected a number, rad, > 0\n"
        "/latch/x: found the unknown key \"x\", expected \"smoothed\""},
       {R"({"tend": 1})",
        "/tend: found the unknown key \"tend\", expected \"method\", \"step\", "
        "\"rtol\", \"atol\", \"latch\", \"t_end\" or \"max_steps\" (did you mean \"t_end\"?)"}}));
  CHECK(facts_of(read(json, Integration{}, read_integration).problems) == facts_of(message));
}

TEST_CASE("An unknown method is told with the known ones", "[campaign_settings]") {
  CHECK_THAT(read(R"({"method": "euler?"})", Integration{}, read_integration).problems,
             Catch::StartsWith("/method: found string \"euler?\", expected \"") &&
                 Catch::Contains("\"auto\""));
  // Which method takes a step is then anyone's guess: one problem, and not two.
  CHECK_THAT(read(R"({"method": "euler?", "step": 1})", Integration{}, read_integration).problems,
             !Catch::Contains("/step"));
}

TEST_CASE("Statistics are read over their defaults, and written in full", "[campaign_settings]") {
  CHECK(write_statistics({}).dump() ==
        R"({"quantiles":[0.01,0.5,0.99],"confidence":0.95,"bins":"auto"})");
  const char* json = R"({"quantiles":[0.9,0.1,0.5],"confidence":0.5,"bins":40})";
  const auto [statistics, problems] = read(json, StatisticsSpec{}, read_statistics);
  CHECK(problems.empty());
  CHECK(write_statistics(statistics).dump() ==
        R"({"quantiles":[0.1,0.5,0.9],"confidence":0.5,"bins":40})"); // ascending
  CHECK(std::holds_alternative<AutoBins>(
      read(R"({"bins": "auto"})", statistics, read_statistics).settings.bins));
}

TEST_CASE("Each fault of the statistics is told", "[campaign_settings]") {
  const auto [json, message] = GENERATE(values<Case>(
      {{"0.95", "found 0.95, expected an object with the statistics"},
       {R"({"quantiles": 0.5})",
        "/quantiles: found 0.5, expected an array of numbers, each > 0 and < 1"},
       {R"({"quantiles": [0, 0.5, 1, 0.5, null]})", "/quantiles/4: found null, expected a number"},
       {R"({"quantiles": [0, 0.5, 1, 0.5]})",
        "/quantiles/0: found 0, expected a number, > 0 and < 1\n"
        "/quantiles/2: found 1, expected a number, > 0 and < 1\n"
        "/quantiles/3: found 0.5 a second time, expected each quantile once"},
       {R"({"confidence": 95})", "/confidence: found 95, expected a number, > 0 and < 1"},
       {R"({"bins": 0})", "/bins: found 0, expected \"auto\" or an integer from 1 to 10000"},
       {R"({"bins": 1e7})",
        "/bins: found 10000000.0, expected \"auto\" or an integer from 1 to 10000"},
       {R"({"bins": "fd"})",
        "/bins: found string \"fd\", expected \"auto\" or an integer from 1 to 10000"},
       {R"({"accuracy_runs": 10001})",
        "/accuracy_runs: found 10001, expected an integer from 0 (none) to 10000"},
       {R"({"bin": 3})",
        "/bin: found the unknown key \"bin\", expected \"quantiles\", \"confidence\", "
        "\"bins\", \"tolerance\" or \"accuracy_runs\" (did you mean \"bins\"?)"}}));
  CHECK(facts_of(read(json, StatisticsSpec{}, read_statistics).problems) == facts_of(message));
}

TEST_CASE("each number of the settings is accepted up to its limits, and no further",
          "[campaign_settings]") {
  const auto check = [](auto defaults, auto reader, const char* good, const char* bad) {
    CAPTURE(good, bad);
    CHECK(read(good, defaults, reader).problems.empty());
    CHECK_FALSE(read(bad, defaults, reader).problems.empty());
  };
  for (const auto& [good, bad] : std::vector<std::pair<const char*, const char*>>{
           {R"({"runs": 1})", R"({"runs": 0})"},
           {R"({"runs": 2147483647})", R"({"runs": 2147483648})"},
           {R"({"replicates": 1})", R"({"replicates": 0})"},
           {R"({"design": "sobol", "runs": 8, "replicates": 8})",
            R"({"design": "sobol", "runs": 8, "replicates": 9})"},
           {R"({"design": "sobol", "runs": 2000000, "replicates": 1000000})",
            R"({"design": "sobol", "runs": 2000000, "replicates": 1000001})"},
           {R"({"runs": 9, "extended_from": [1]})", R"({"runs": 9, "extended_from": [0]})"},
           {R"({"runs": 9, "extended_from": [8]})", R"({"runs": 9, "extended_from": [9]})"},
           {R"({"runs": 9, "extended_from": [4, 5]})", R"({"runs": 9, "extended_from": [5, 5]})"}})
    check(Sampling{}, read_sampling, good, bad);
  for (const auto& [good, bad] : std::vector<std::pair<const char*, const char*>>{
           {R"({"rtol": 1e-15})", R"({"rtol": 0.99e-15})"},
           {R"({"rtol": 0.999})", R"({"rtol": 1})"},
           {R"({"atol": 1e-300})", R"({"atol": 0})"},
           {R"({"max_steps": 1})", R"({"max_steps": 0})"},
           {R"({"t_end": 1e-9})", R"({"t_end": 0})"},
           {R"({"latch": {"smoothed": 1e-9}})", R"({"latch": {"smoothed": 0}})"}})
    check(Integration{}, read_integration, good, bad);
  for (const auto& [good, bad] : std::vector<std::pair<const char*, const char*>>{
           {R"({"bins": 1})", R"({"bins": 0})"},
           {R"({"bins": 10000})", R"({"bins": 10001})"},
           {R"({"accuracy_runs": 0})", R"({"accuracy_runs": -1})"},
           {R"({"accuracy_runs": 10000})", R"({"accuracy_runs": 10001})"},
           {R"({"confidence": 1e-9})", R"({"confidence": 0})"},
           {R"({"confidence": 0.999})", R"({"confidence": 1})"},
           {R"({"tolerance": [{"probability": 0.9, "confidence": 0.999}]})",
            R"({"tolerance": [{"probability": 0.9, "confidence": 1}]})"},
           {R"({"tolerance": [{"probability": 1e-9, "confidence": 0.9}]})",
            R"({"tolerance": [{"probability": 0, "confidence": 0.9}]})"}})
    check(StatisticsSpec{}, read_statistics, good, bad);
}

TEST_CASE("Lists that nobody writes by hand are refused before anything is done",
          "[campaign_settings]") {
  Json json{{"quantiles", Json::array()}, {"tolerance", Json::array()}};
  for (int i = 1; i <= 1001; ++i) {
    json["quantiles"].push_back(i / 1002.0);
    json["tolerance"].push_back({{"probability", 0.9}, {"confidence", 0.9}});
  }
  CHECK(facts_of(read(json.dump().c_str(), StatisticsSpec{}, read_statistics).problems) ==
        facts_of("/quantiles: found an array of 1001, expected at most 1000 quantiles\n"
                 "/tolerance: found an array of 1001, expected at most 1000 of them"));
  json["quantiles"].erase(0);
  json["tolerance"].erase(0);
  CHECK(read(json.dump().c_str(), StatisticsSpec{}, read_statistics).problems.empty());
}

TEST_CASE("Tolerance limits are read, and each fault of them is told", "[campaign_settings]") {
  const char* json = R"({"tolerance": [{"probability": 0.95, "confidence": 0.9},
                                       {"probability": 0.9, "confidence": 0.5, "side": "both"}]})";
  const auto [statistics, problems] = read(json, StatisticsSpec{}, read_statistics);
  CHECK(problems.empty());
  REQUIRE(statistics.tolerance_limits.size() == 2);
  CHECK((statistics.tolerance_limits[0].side == Side::upper &&
         statistics.tolerance_limits[1].side == Side::both));
  CHECK(write_statistics(statistics)["tolerance"].dump() ==
        R"([{"probability":0.95,"confidence":0.9,"side":"upper"},)"
        R"({"probability":0.9,"confidence":0.5,"side":"both"}])");
  CHECK(facts_of(read(R"({"tolerance": [{"probability": 1, "side": "left"}, 3]})", StatisticsSpec{},
                      read_statistics)
                     .problems) ==
        facts_of(
            "/tolerance/0/probability: found 1, expected a number, > 0 and < 1\n"
            "/tolerance/0/confidence: found nothing, expected a number, > 0 and < 1\n"
            "/tolerance/0/side: found string \"left\", expected \"upper\", \"lower\" or \"both\"\n"
            "/tolerance/1: found 3, expected an object with probability and confidence"));
  CHECK(facts_of(read(R"({"tolerance": 1})", StatisticsSpec{}, read_statistics).problems) ==
        facts_of("/tolerance: found 1, expected an array of tolerance limits"));
}

TEST_CASE("the looks before a campaign was extended are read, and written where there are any") {
  const auto fault = [](const char* json) {
    return read(json, Sampling{}, read_sampling).problems;
  };
  const char* good = R"({"runs": 4000, "extended_from": [1000, 2000]})";
  const auto [sampling, problems] = read(good, Sampling{}, read_sampling);
  CHECK(problems.empty());
  CHECK(sampling.extended_from == std::vector<std::int64_t>{1000, 2000});
  CHECK(write_sampling(sampling)["extended_from"] == Json::array({1000, 2000}));
  CHECK_FALSE(write_sampling(Sampling{}).contains("extended_from"));
  CHECK(fault(R"({"runs": 2000, "extended_from": [2000]})") ==
        "/extended_from/0: found 2000, expected less than the number of runs, 2000");
  CHECK(fault(R"({"runs": 2000, "extended_from": [1000, 1000]})") ==
        "/extended_from/1: found 1000, expected an array of integers ≥ 1, each less than the next");
  CHECK_THAT(fault(R"({"runs": 2000, "extended_from": [1000, "a", 900, 2500, 1500, 1400]})"),
             Catch::Contains("/extended_from/1: ") && Catch::Contains("/extended_from/2: ") &&
                 Catch::Contains("/extended_from/3: found 2500") &&
                 Catch::Contains("/extended_from/5: found 1400"));
  CHECK(fault(R"({"runs": 2000, "extended_from": 1000})") ==
        "/extended_from: found 1000, expected an array of integers ≥ 1, each less than the next");
  CHECK(fault(R"({"design": "latin_hypercube", "runs": 2000, "extended_from": [1000]})") ==
        "/extended_from: found an array of 1, expected none: a Latin hypercube of more runs has "
        "other "
        "draws");
}

TEST_CASE("The words on the report's first page are read and written", "[campaign_settings]") {
  const char* text = R"({"title": "Wing", "document": "D-1", "date": "2026-11-25"})";
  const auto [header, problems] = read(text, ReportHeader{}, read_report_header);
  CHECK(problems.empty());
  CHECK((header.title == "Wing" && header.document == "D-1" && header.author.empty()));
  CHECK(write_report_header(header) == parse_json(text));
  CHECK(read(R"({"titel": "Wing"})", ReportHeader{}, read_report_header).problems ==
        "/titel: found the unknown key \"titel\", expected \"title\", \"author\", "
        "\"organisation\", \"document\", \"revision\" or \"date\" (did you mean \"title\"?)");
  CHECK(read(R"({"revision": ""})", ReportHeader{}, read_report_header).problems ==
        "/revision: found string \"\", expected a string, not empty, without control characters");
  for (const char* broken : {R"({"title": "two\nlines"})", R"({"author": "a\ttab"})"})
    CHECK(read(broken, ReportHeader{}, read_report_header).problems.find("control characters") !=
          std::string::npos);
}

TEST_CASE("Runs to be made again are written where they are not the usual number",
          "[campaign_settings]") {
  CHECK_FALSE(write_statistics({}).contains("accuracy_runs"));
  for (const std::int64_t runs : {0, 100}) {
    const auto [statistics, problems] =
        read(Json{{"accuracy_runs", runs}}.dump().c_str(), StatisticsSpec{}, read_statistics);
    CHECK(problems.empty());
    CHECK(statistics.accuracy_runs == runs);
    CHECK(write_statistics(statistics)["accuracy_runs"] == runs);
  }
}
