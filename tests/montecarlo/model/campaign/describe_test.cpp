#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/describe.hpp"
#include "tests/montecarlo/sample_support.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <set>

using namespace wingspread;

TEST_CASE("A campaign is described with what varies and how it is run", "[describe]") {
  Json document = test::small_campaign();
  document["dispersions"].push_back(parse_json(
      R"({ "name": "rate", "distribution": { "type": "empirical", "values": [1, 2, 3, 4, 5] },
           "apply": "add", "to": ["hinges.root.initial_rate"] })"));
  document["dispersions"].push_back(parse_json(
      R"({ "name": "stop", "apply": "add", "to": ["hinges.root.angle.latched"],
           "distribution": { "type": "exponential", "rate": 9, "truncate": { "upper": 0.1 } } })"));
  const std::string text = describe(read_campaign(document.dump(), ""));
  CHECK_THAT(text, Catch::StartsWith("campaign\nscene small\n"));
  CHECK(
      text.substr(text.find("5 dispersions")) ==
      "5 dispersions\n"
      "  spring: normal (mean 1, std 0.05), scale hinges.root.spring.torque_stowed (nominal 2 "
      "N·m), "
      "hinges.root.spring.torque_latched (nominal 1.4 N·m)\n"
      "  mass.inner: uniform (lower 7, upper 9), set bodies.inner.mass (10 kg as written, "
      "nominal 8 kg)\n"
      "  mass.outer: uniform (lower 7, upper 9), set bodies.outer.mass (nominal 8 kg)\n"
      "  rate: empirical (values 5 numbers), add hinges.root.initial_rate (-0.1 rad/s as written, "
      "nominal 2.9 rad/s)\n"
      "  stop: exponential (rate 9) within [-inf, 0.1], add hinges.root.angle.latched (0 deg "
      "as written, nominal 2.241 deg)\n"
      "sampling: random, 1000 runs, seed 1\n"
      "integration: method auto, rtol 1e-08, atol 1e-10, latch event, up to 60 s and 1000000 "
      "steps\n"
      "outputs: latch_time, latch_rate, peak_moment, peak_force, overtravel, peaks_final\n"
      "statistics: quantiles 0.01 0.5 0.99, confidence 0.95, bins auto\n");
}

TEST_CASE("A fixed step is described with its method", "[describe]") {
  Campaign campaign = read_campaign(test::small_campaign().dump(), "");
  campaign.integration.method = "runge_kutta4";
  campaign.integration.step = 0.002;
  CHECK_THAT(describe(campaign),
             Catch::Contains("integration: method runge_kutta4, step 0.002 s, rtol 1e-08"));
}

TEST_CASE("Replicates and correlations are described", "[describe]") {
  Json document = test::small_campaign();
  document["correlations"] =
      parse_json(R"([{"between": ["spring", "mass.inner"], "spearman": 0.5}])");
  const auto sampling = [&](const char* design, long runs, long replicates) {
    document["sampling"] = {{"design", design}, {"runs", runs}, {"replicates", replicates}};
    const std::string text = describe(read_campaign(document.dump(), ""));
    CHECK_THAT(text, Catch::Contains("1 correlation\n  spring and mass.inner: Spearman 0.5\n"));
    const std::size_t start = text.find("sampling: ") + 10;
    return text.substr(start, text.find('\n', start) - start);
  };
  CHECK(sampling("sobol", 4096, 16) == "sobol, 4096 runs, seed 1, 16 replicates of 256 runs");
  CHECK(sampling("sobol", 4100, 16) ==
        "sobol, 4100 runs, seed 1, 16 replicates of 256 or 257 runs; Sobol' points are most "
        "accurate with powers of two");
  CHECK(sampling("sobol", 1000, 1) == "sobol, 1000 runs, seed 1; Sobol' points are most accurate "
                                      "with powers of two; one replicate, so no bounds");
  CHECK(sampling("latin_hypercube", 100, 3) ==
        "latin_hypercube, 100 runs, seed 1, 3 replicates of 33 or 34 runs");
  CHECK(sampling("random", 100, 1) == "random, 100 runs, seed 1");
}

TEST_CASE("What a campaign sets otherwise is described too", "[describe]") {
  const Json document{{"scene", test::small_scene()},
                      {"sampling", {{"runs", 1}, {"replicates", 2}}},
                      {"integration", {{"latch", {{"smoothed", 0.5}}}}},
                      {"outputs", Json::array()},
                      {"statistics", {{"bins", 8}}}};
  const std::string text = describe(read_campaign(document.dump(), ""));
  CHECK_THAT(text, Catch::Contains("0 dispersions\n") &&
                       Catch::Contains("sampling: random, 1 run, seed 1\n") &&
                       Catch::Contains("latch smoothed over 0.5 rad") &&
                       Catch::Contains("outputs: overtravel\n") && Catch::Contains("bins 8\n"));
}

TEST_CASE("Settings of the error block and of static margins are described where they are given",
          "[describe]") {
  Json document = test::small_campaign();
  const auto described = [&] { return describe(read_campaign(document.dump(), "")); };
  CHECK_THAT(described(),
             !Catch::Contains("integration error") && !Catch::Contains("motorization"));
  document["statistics"]["accuracy_runs"] = 24;
  CHECK_THAT(described(), Catch::Contains(", integration error from 24 runs\n"));
  document["statistics"]["accuracy_runs"] = 0;
  CHECK_THAT(described(), Catch::Contains(", integration error not measured\n"));
  document["motorization"] = parse_json(
      R"({ "ecss": { "friction": 2.5 }, "rates": { "root": 0.125 }, "springs_per_hinge": 3 })");
  CHECK_THAT(described(), Catch::Contains("motorization: ecss/friction 2.5, rates/root 0.125, "
                                          "springs_per_hinge 3\n"));
}

TEST_CASE("What a campaign asks for is described with what its runs can show", "[describe]") {
  Json document = test::small_campaign();
  document["sampling"] = {{"runs", 1000}};
  document["statistics"] = {{"tolerance", {{{"probability", 0.95}, {"confidence", 0.9}}}}};
  document["requirements"] = parse_json(R"([
    { "output": "root.peak_moment", "max": 400, "probability": 0.99, "confidence": 0.9 },
    { "output": "deployed", "probability": 0.99865, "confidence": 0.9 } ])");
  const std::string text = describe(read_campaign(document.dump(), ""));
  CHECK(text.substr(text.find("tolerance")) ==
        "tolerance limits: 0.95 probability, 0.9 confidence, upper\n"
        "requirement: root.peak_moment ≤ 400 N·m, 99 % at 90 %: 5 of 1000 runs may break it\n"
        "requirement: deployed, 99.865 % at 90 %: cannot be shown with 1000 runs, it takes 1705\n");
  document["until"] = parse_json(R"([{ "output": "deployed", "width": 0.01 }])");
  CHECK_THAT(describe(read_campaign(document.dump(), "")),
             Catch::EndsWith("stop at an interval's width of: deployed 0.01\n"));
}

TEST_CASE("What no run can show in a case where nothing varies is not promised", "[describe]") {
  Json document = test::small_campaign();
  document["requirements"] = parse_json(R"([ { "output": "deployed", "probability": 0.9,
                                              "confidence": 0.9 } ])");
  document["dispersions"] = parse_json(R"([ { "name": "spring", "apply": "scale",
    "to": ["hinges.root.spring.scale"], "distribution": { "type": "normal", "mean": 1, "std": 0.1 } } ])");
  document["cases"] = parse_json(R"([ { "name": "cold" }, { "name": "amb", "distributions": {
    "spring": { "type": "constant", "value": 1 } } } ])");
  CHECK_THAT(describe(read_campaign(document.dump(), "")),
             Catch::Contains("cannot be shown") && Catch::Contains("in case amb\n"));
  document["cases"][1].erase("distributions");
  CHECK_THAT(describe(read_campaign(document.dump(), "")), !Catch::Contains("all the same"));
}

TEST_CASE("Causes, cases and draws that act on one parameter are described", "[describe]") {
  Json document = test::small_campaign();
  document["dispersions"] = parse_json(R"([
    { "name": "temperature", "distribution": { "type": "normal", "mean": 20, "std": 5 },
      "through": [ { "to": ["hinges.*.spring.scale"], "apply": "scale",
                     "table": { "at": [-100, 20, 60], "value": [3, 1, 0.8] } } ] },
    { "name": "spring", "distribution": { "type": "normal", "mean": 1, "std": 0.05 },
      "apply": "scale", "each": "hinges.*t.spring.scale" } ])");
  document["cases"] = parse_json(R"([
    { "name": "cold", "distributions": { "temperature": { "type": "constant", "value": -60 } } },
    { "name": "ambient" },
    { "name": "old", "scale": { "bodies.*.mass": 1.5 }, "add": { "hinges.mid.spring.offset": "1 N*mm" } } ])");
  const std::string text = describe(read_campaign(document.dump(), ""));
  const auto from = text.find("2 dispersions");
  CHECK(
      text.substr(from, text.find("sampling") - from) ==
      "2 dispersions\n"
      "  temperature: normal (mean 20, std 5)\n"
      "    scale by 3 to 0.8 over -100 to 60 (monotone cubic through 3 points): "
      "hinges.root.spring.scale (nominal 1), "
      "hinges.mid.spring.scale (nominal 1)\n"
      "  spring.root: normal (mean 1, std 0.05), scale hinges.root.spring.scale (nominal 1)\n"
      "parameters changed by several draws\n"
      "  hinges.root.spring.scale: temperature scales, then spring.root "
      "scales\n"
      "3 cases\n"
      "  cold: temperature: constant (value -60)\n"
      "  ambient: as it is\n"
      "  old: scale bodies.inner.mass 1.5 (10 kg as written), scale bodies.outer.mass 1.5 (8 kg as "
      "written), add hinges.mid.spring.offset 0.001 N·m (0 N·m as written)\n");
}

TEST_CASE("The description says that final angles take every run to t_end", "[describe]") {
  Json document = test::small_campaign();
  document["outputs"] = {"latch_time", "final_angle"};
  CHECK_THAT(
      describe(read_campaign(document.dump(), "")),
      Catch::Contains("outputs: latch_time, overtravel, final_angle; for final_angle every run "
                      "goes to t_end"));
}

// A design of n runs stratifies a dispersion if each of n equal parts of its law has one draw.
TEST_CASE("A campaign names the correlated dispersions that its design does not stratify",
          "[describe]") {
  std::mt19937_64 random(8);
  const std::vector<std::string> names{"delta", "alpha", "echo", "bravo", "charlie"};
  constexpr long n = 64;
  for (int k = 0; k < 20; ++k) {
    Json document = test::small_campaign();
    document["dispersions"] = Json::array();
    for (const std::string& name : names)
      document["dispersions"].push_back(
          {{"name", name},
           {"distribution", {{"type", "uniform"}, {"lower", 0}, {"upper", 1}}},
           {"apply", "set"},
           {"to", {"hinges.root.spring.offset"}}});
    for (std::size_t i = 1; i < names.size(); ++i) // offset is set by the first, then added to
      document["dispersions"][i]["apply"] = "add";
    document["correlations"] = Json::array();
    for (std::size_t i = 0; i < names.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (test::uniform(random) < 0.25)
          document["correlations"].push_back(
              {{"between", {names[i], names[j]}}, {"spearman", 0.3}});
    document["sampling"] = {{"design", "latin_hypercube"}, {"runs", n}, {"seed", k}};
    const Campaign campaign = read_campaign(document.dump(), "");
    const RunPlan plan(campaign);
    std::vector<std::set<long>> parts(names.size());
    std::vector<double> draws(names.size());
    for (long run = 0; run < n; ++run) {
      plan.draw(run, draws);
      for (std::size_t i = 0; i < names.size(); ++i)
        parts[i].insert(static_cast<long>(std::floor(draws[i] * n)));
    }
    std::set<std::string> lost, named;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (std::ssize(parts[i]) < n) lost.insert(names[i]);
    const std::string text = describe(campaign);
    const std::size_t at = text.find(" not stratified");
    const std::string line =
        at == std::string::npos ? "" : text.substr(text.rfind('\n', at), at - text.rfind('\n', at));
    for (const std::string& name : names)
      if (line.find(name) != std::string::npos) named.insert(name);
    CAPTURE(document["correlations"].dump(), line);
    CHECK(named == lost);
  }
}

TEST_CASE("a draw has the unit that all its targets have, and a factor none", "[describe]") {
  const auto unit = [](const char* apply, const char* targets) {
    Json json = test::small_campaign();
    json["dispersions"] =
        Json::array({{{"name", "x"},
                      {"distribution", {{"type", "normal"}, {"mean", 0}, {"std", 0.01}}},
                      {"apply", apply},
                      {"to", parse_json(targets)}}});
    return std::string(unit_of_draw(read_campaign(json.dump(), "").dispersions[0]));
  };
  const char* torques =
      R"(["hinges.root.spring.torque_stowed", "hinges.root.spring.torque_latched"])";
  CHECK(unit("add", torques) == "N·m");
  CHECK(unit("scale", torques) == "");
  CHECK(unit("add", R"(["hinges.root.angle.stowed"])") == "rad");
  CHECK(unit("add", R"(["hinges.root.angle.stowed", "hinges.root.spring.torque_stowed"])") == "");
}
