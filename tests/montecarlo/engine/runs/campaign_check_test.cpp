// Unphysical draws are found before a campaign is run, wherever they come from.
#include "montecarlo/engine/runs/campaign_check.hpp"
#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/engine/runs/runner.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdio>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr int runs = 300;

/// Runs that a runner calls invalid.
long invalid_runs(const Campaign& campaign) {
  const RunPlan plan(campaign);
  Runner runner(plan);
  long count = 0;
  for (long k = 0; k < runs; ++k) count += runner.run(k).status == Status::invalid;
  return count;
}

/// quick_campaign with one more dispersion.
Json with_dispersion(const char* dispersion) {
  Json json = quick_campaign(runs);
  json["dispersions"].push_back(parse_json(dispersion));
  return json;
}

const InputWarning* at(const std::vector<InputWarning>& warnings, const std::string& pointer) {
  const auto found = std::ranges::find(warnings, pointer, &InputWarning::pointer);
  return found == warnings.end() ? nullptr : &*found;
}

} // namespace

TEST_CASE("draws that are invalid runs are warned of with their number", "[warnings]") {
  struct {
    const char *what, *dispersion, *path;
  } const kinds[]{{"a nominal value of 0",
                   R"({ "name": "x", "apply": "add", "to": ["hinges.mid.friction.viscous"],
            "distribution": { "type": "normal", "mean": 0.01, "std": 0.01 } })",
                   "hinges.mid.friction.viscous"},
                  {"a table",
                   R"({ "name": "x", "distribution": { "type": "normal", "mean": 20, "std": 10 },
            "through": [ { "apply": "scale", "to": ["hinges.*.spring.scale"],
                           "table": { "at": [-40, 80], "value": [1, 1.1] } },
                         { "apply": "add", "to": ["hinges.root.latch.stiffness"],
                           "table": { "at": [-40, 10, 80], "value": [-9e9, -9e9, 0] } } ] })",
                   "hinges.root.latch.stiffness"},
                  {"a parameter that must fit another one",
                   R"({ "name": "x", "apply": "set", "to": ["hinges.mid.friction.coulomb"],
            "distribution": { "type": "uniform", "lower": 0.02, "upper": 0.04 } })",
                   "hinges.mid.friction.static"},
                  {"an angle on another one",
                   R"({ "name": "x", "apply": "set", "to": ["hinges.mid.angle.latched"],
            "distribution": { "type": "discrete", "values": [0, 0.01], "weights": [9, 1] } })",
                   "hinges.mid.angle.latched"}};
  for (const auto& [what, dispersion, path] : kinds) {
    Json json = with_dispersion(dispersion);
    Json& hinge = json["scene"]["hinges"][1];
    if (std::string(path).ends_with("viscous")) hinge["friction"]["viscous"] = 0;
    if (std::string(path).ends_with("static"))
      hinge["friction"] = {{"model", "exact"}, {"coulomb", 0.025}, {"static", 0.03}};
    if (std::string(path).ends_with("angle.latched"))
      json["dispersions"].back()["distribution"]["values"][1] = hinge["angle"]["stowed"];
    const Campaign campaign = campaign_of(json);
    const std::vector<InputWarning> warnings = check_campaign(campaign, "");
    const InputWarning* drawn = nullptr;
    for (const InputWarning& each : warnings)
      if (each.found.starts_with("unphysical draws")) drawn = &each;
    CAPTURE(what);
    REQUIRE(drawn != nullptr);
    CAPTURE(drawn->found);
    CHECK(drawn->pointer == "/dispersions/2");
    CHECK_THAT(drawn->found, Catch::Contains(std::string(path) + " is "));
    long count = 0, of = 0;
    REQUIRE(std::sscanf(drawn->found.c_str(), "unphysical draws, %ld of %ld draws", &count, &of) ==
            2);
    CHECK((of == runs && count > 0 && count == invalid_runs(campaign)));
  }
}

TEST_CASE("a case's unphysical draws are warned of at its law, or with its name", "[warnings]") {
  Json json =
      with_dispersion(R"({ "name": "x", "apply": "set", "to": ["hinges.mid.friction.coulomb"],
       "distribution": { "type": "uniform", "lower": 0.01, "upper": 0.02 } })");
  json["dispersions"].push_back(
      parse_json(R"({ "name": "y", "apply": "add", "to": ["hinges.tip.friction.coulomb"],
       "distribution": { "type": "uniform", "lower": -0.001, "upper": 0.001 } })"));
  json["scene"]["hinges"][2]["friction"]["coulomb"] = 0.02;
  json["cases"] = parse_json(R"([ { "name": "ambient" },
    { "name": "cold", "distributions": { "x": { "type": "normal", "mean": 0.02, "std": 0.02 } } },
    { "name": "dry", "set": { "hinges.tip.friction.coulomb": 0 } } ])");
  const Campaign campaign = campaign_of(json);
  const auto warnings = check_campaign(campaign, "");
  const InputWarning* law = at(warnings, "/cases/1/distributions/x");
  REQUIRE(law != nullptr);
  CHECK_THAT(law->found, Catch::Contains("hinges.mid.friction.coulomb is -"));
  CHECK_THAT(law->found, Catch::Contains(std::to_string(invalid_runs(campaigns_of(campaign)[1])) +
                                         " of 300 draws in case cold"));
  const InputWarning* dry = at(warnings, "/dispersions/3");
  REQUIRE(dry != nullptr);
  CHECK_THAT(dry->found, Catch::Contains("in case dry"));
  CHECK_THAT(dry->found, !Catch::Contains("in case cold"));
}

TEST_CASE("physical draws are not warned of", "[warnings]") {
  CHECK(check_campaign(campaign_of(quick_campaign(runs)), "").empty());
}

// A rare value is tried with the other laws at their medians: either is physical, both together would not be.
TEST_CASE("rare values of two laws are not tried together", "[warnings]") {
  Json json =
      with_dispersion(R"({ "name": "x", "apply": "add", "to": ["hinges.mid.friction.coulomb"],
       "distribution": { "type": "discrete", "values": [0, 0.006], "weights": [1e9, 1] } })");
  json["dispersions"].push_back(
      parse_json(R"({ "name": "y", "apply": "add", "to": ["hinges.mid.friction.static"],
       "distribution": { "type": "discrete", "values": [0, -0.006], "weights": [1e9, 1] } })"));
  json["scene"]["hinges"][1]["friction"] = {
      {"model", "exact"}, {"coulomb", 0.02}, {"static", 0.03}};
  const auto told = [&] {
    for (const InputWarning& each : check_campaign(campaign_of(json), ""))
      if (each.found.starts_with("unphysical draws")) return each.pointer;
    return std::string();
  };
  CHECK(told() == "");
  json["dispersions"][3]["distribution"]["values"][1] = -0.012; // below 0.02 by itself
  CHECK(told() == "/dispersions/3");
}

TEST_CASE("a hold that half fails is warned of, however rare", "[warnings]") {
  const auto told = [](const char* law) {
    Json json = with_dispersion(
        R"({ "name": "hung_up", "apply": "set", "to": ["hinges.mid.release.fails"] })");
    json["dispersions"].back()["distribution"] = parse_json(law);
    json["scene"]["hinges"][1]["release"] = {{"time", 0.1}};
    const auto warnings = check_campaign(campaign_of(json), "");
    const InputWarning* found = at(warnings, "/dispersions/2");
    return found ? found->found : "";
  };
  CHECK(told(R"({ "type": "discrete", "values": [0, 1], "weights": [1e6, 1] })") == "");
  CHECK_THAT(told(R"({ "type": "discrete", "values": [0, 0.5], "weights": [1e6, 1] })"),
             Catch::Contains("hung_up = 0.5, a share of 1e-06") &&
                 Catch::Contains("hinges.mid.release.fails is 0.5") &&
                 Catch::Contains("expected 0 or 1"));
  CHECK_THAT(told(R"({ "type": "uniform", "lower": 0, "upper": 1 })"),
             Catch::Contains("300 of 300 draws"));
}

TEST_CASE("replicates of independent draws are said to be ignored", "[warnings]") {
  Json json = quick_campaign(runs);
  json["sampling"]["replicates"] = 4;
  const auto warnings = check_campaign(campaign_of(json), "");
  REQUIRE(at(warnings, "/sampling/replicates") != nullptr);
  CHECK(at(warnings, "/sampling/replicates")->found == "4 with independent draws");
  json["sampling"]["design"] = "latin_hypercube";
  CHECK(check_campaign(campaign_of(json), "").empty());
}

TEST_CASE("a warning names the law that drew it, whatever another law's name begins with",
          "[warnings]") {
  Json json = ringing_panel(500, 20, 0.1);
  json["dispersions"][0] = {{"name", "spring"},
                            {"distribution", {{"type", "normal"}, {"mean", 1}, {"std", 0.01}}},
                            {"apply", "scale"},
                            {"to", {"hinges.root.spring.scale"}}};
  json["cases"] = parse_json(R"([ { "name": "k", "distributions": {
    "spring": { "type": "normal", "mean": 1.02, "std": 0.01 } } } ])");
  const auto warned = [&](const char* second) {
    json["dispersions"][1] = parse_json(second);
    std::vector<std::string> pointers;
    for (const InputWarning& each : check_campaign(campaign_of(json), ""))
      pointers.push_back(each.pointer);
    return pointers;
  };
  // negative friction by a law of its own, "spring.x"
  const auto unphysical = warned(R"({ "name": "spring.x", "apply": "set",
    "distribution": { "type": "normal", "mean": 0.02, "std": 0.05 },
    "to": ["hinges.root.friction.coulomb"] })");
  CHECK(std::ranges::count(unphysical, "/dispersions/1") > 0);
  CHECK(std::ranges::count(unphysical, "/cases/0/distributions/spring") == 0);
  // its table does not reach to the case's law of "spring"
  const auto through = warned(R"({ "name": "spring.x",
    "distribution": { "type": "uniform", "lower": 10, "upper": 30 },
    "through": [ { "to": ["hinges.root.friction.scale"], "apply": "scale",
                   "table": { "at": [5, 35], "value": [1.5, 1] } } ] })");
  CHECK(std::ranges::count(through, "/cases/0/distributions/spring") == 0);
  // an `each` of that name: the case's law is that of its copies
  json["dispersions"][0].erase("to");
  json["dispersions"][0]["each"] = "hinges.*.latch.stiffness";
  json["cases"][0]["distributions"]["spring"]["std"] = 0.5;
  CHECK(std::ranges::count(warned(R"({ "name": "spring.x", "apply": "scale",
    "distribution": { "type": "uniform", "lower": 0.9, "upper": 1.1 },
    "to": ["bodies.panel.mass"] })"),
                           "/cases/0/distributions/spring") > 0);
}

TEST_CASE("a limit on an overtravel that may grow after the last latch is warned of",
          "[warnings]") {
  const auto warned = [](const char* output, const char* limit, std::vector<std::string> outputs,
                         bool latch) {
    Json json = quick_campaign(20);
    json["outputs"] = std::move(outputs);
    if (!latch) json["scene"]["hinges"][0].erase("latch");
    json["requirements"] = {
        {{"output", output}, {limit, 0.1}, {"probability", 0.9}, {"confidence", 0.9}}};
    const auto warnings = check_campaign(campaign_of(json), "");
    const InputWarning* found = at(warnings, "/requirements/0");
    return found && found->found.find("up to the last latch") != std::string::npos;
  };
  CHECK(warned("root.overtravel", "max", {"latch_time", "overtravel"}, false));
  CHECK_FALSE(warned("root.overtravel", "max", {"latch_time", "overtravel"}, true));
  CHECK_FALSE(warned("root.overtravel", "min", {"latch_time", "overtravel"}, false));
  CHECK_FALSE(warned("mid.overtravel", "max", {"latch_time", "overtravel"}, false));
  CHECK_FALSE(warned("mid.latch_time", "max", {"latch_time", "overtravel"}, false));
  for (const char* on : {"peak_moment", "peak_force", "final_angle"})
    CHECK_FALSE(warned("root.overtravel", "max", {"latch_time", "overtravel", on}, false));
}
