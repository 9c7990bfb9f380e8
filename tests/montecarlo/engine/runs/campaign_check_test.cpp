// Unphysical draws are found before a campaign is run, wherever they come from.
#include "montecarlo/engine/runs/campaign_check.hpp"
#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/engine/runs/runner.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <regex>
#include <set>

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

std::smatch matched(const std::string& text, const char* pattern) {
  std::smatch found;
  std::regex_match(text, found, std::regex(pattern));
  return found;
}

/// A warning as it would be of a wing alone, and the cases that it names.
struct Told {
  std::string pointer, found;
  std::set<std::string> cases;
};

Told told_of(const InputWarning& warning, const Json& cases) {
  Told told{warning.pointer, warning.found, {}};
  if (const std::smatch of = matched(told.found, "^in cases? ([^:]*): (.*)$"); !of.empty()) {
    const std::string names = of[1];
    told.found = std::string(of[2]);
    static const std::regex name("[^, ]+");
    for (std::sregex_iterator each(names.begin(), names.end(), name), end; each != end; ++each)
      told.cases.insert(each->str());
    if (const std::smatch at = matched(told.found, "^at (/[^ ]*) (.*)$"); !at.empty()) {
      CHECK(warning.pointer.starts_with("/cases/"));
      const std::string pointer = at[1], found = at[2];
      told.pointer = pointer, told.found = found;
    }
  } else if (const std::smatch law = matched(told.pointer, "^/cases/([0-9]+)/.*$"); !law.empty()) {
    told.cases.insert(cases[std::stoul(law[1])]["name"]);
  }
  return told;
}

bool names_case(const InputWarning& warning) {
  return warning.found.find(" in case") != std::string::npos; // "12 of 300 draws in case hot"
}

/// Checks that `check` warns of what `check --case` warns of in any case, and of nothing else.
void check_union(const Json& json) {
  const Campaign campaign = campaign_of(json);
  const std::vector<InputWarning> all = check_campaign(campaign, "");
  std::map<std::string, std::vector<InputWarning>> of;
  for (const CaseSpec& spec : campaign.cases)
    of[spec.name] = check_campaign(campaign, "", {&spec.name, 1});
  for (const auto& [name, own] : of)
    for (const InputWarning& each : own) {
      const Told one = told_of(each, json["cases"]);
      CAPTURE(name, to_string(each));
      CHECK((one.cases.empty() || one.cases == std::set<std::string>{name}));
      CHECK(std::ranges::any_of(all, [&](const InputWarning& other) {
        const Told both = told_of(other, json["cases"]);
        return both.pointer == one.pointer &&
               (one.cases.empty() ? both.found == one.found || names_case(each)
                                  : both.cases.contains(name));
      }));
    }
  for (const InputWarning& each : all) {
    const Told one = told_of(each, json["cases"]);
    CAPTURE(to_string(each));
    const auto is_told = [&](const std::string& name) {
      return std::ranges::any_of(of[name], [&](const InputWarning& other) {
        const Told both = told_of(other, json["cases"]);
        return both.pointer == one.pointer &&
               (both.found == one.found || one.cases.size() > 1 || names_case(each));
      });
    };
    for (const std::string& name : one.cases) CHECK(is_told(name));
    CHECK(std::ranges::any_of(campaign.cases,
                              [&](const CaseSpec& spec) { return is_told(spec.name); }));
  }
}

/// A campaign with a temperature that acts on friction and a gap, and these laws of the base and of cases.
Json with_temperatures(const char* base, const char* cases) {
  Json json = with_dispersion(R"({ "name": "temperature", "through": [
    { "to": ["hinges.*.friction.scale"], "apply": "scale",
      "table": { "at": [180, 213, 293, 343], "value": [300, 2.3, 1, 1.3] } },
    { "to": ["hinges.tip.latch.backlash"], "apply": "add",
      "table": { "at": [180, 200, 350], "value": ["0.2 deg", 0, 0] } } ] })");
  json["outputs"] = {"latch_time", "latch_rate", "peak_moment"};
  for (Json& hinge : json["scene"]["hinges"])
    hinge["friction"] = parse_json(R"({ "model": "exact", "coulomb": 0.01, "viscous": 0.02 })");
  json["dispersions"].back()["distribution"] = parse_json(base);
  json["dispersions"].push_back(
      parse_json(R"({ "name": "misalign", "apply": "add", "to": ["hinges.tip.angle.stowed"],
        "distribution": { "type": "normal", "mean": 0, "std": "0.5 deg" } })"));
  json["cases"] = parse_json(cases);
  json["requirements"] = Json::array();
  for (const double max : {900.0, 0.9})
    json["requirements"].push_back(
        {{"output", "root.peak_moment"}, {"max", max}, {"probability", 0.9}, {"confidence", 0.9}});
  return json;
}

constexpr const char* cold_and_hot = R"([
  { "name": "cold", "distributions": { "temperature": { "type": "normal", "mean": 230, "std": 5 } } },
  { "name": "hot", "distributions": { "temperature": { "type": "normal", "mean": 320, "std": 5 } } } ])";

} // namespace

TEST_CASE("check warns of what the wings of its cases are warned of, and of no other wing",
          "[warnings]") {
  constexpr const char* unused = R"({ "type": "constant", "value": 0 })";
  constexpr const char* ambient = R"({ "type": "normal", "mean": 290, "std": 5 })";
  Json cases = parse_json(cold_and_hot);
  check_union(with_temperatures(unused, cold_and_hot));
  for (const InputWarning& each :
       check_campaign(campaign_of(with_temperatures(unused, cold_and_hot)), "")) {
    CAPTURE(to_string(each));
    CHECK(each.pointer == "/requirements/1/max"); // of both cases
    CHECK_THAT(each.found, Catch::Contains("in cases cold, hot: "));
  }
  cases.push_back(parse_json(R"({ "name": "frozen", "distributions": {
    "temperature": { "type": "normal", "mean": 181, "std": 0.2 } } })"));
  for (const char* base : {unused, ambient}) {
    const Json json = with_temperatures(base, cases.dump().c_str());
    check_union(json);
    const auto warnings = check_campaign(campaign_of(json), "");
    const InputWarning* frozen = at(warnings, "/cases/2");
    REQUIRE(frozen != nullptr);
    CHECK_THAT(frozen->found, Catch::Contains("in case frozen: at /hinges/") &&
                                  Catch::Contains("net static torque"));
  }
  cases.push_back(parse_json(R"({ "name": "plain" })"));
  check_union(with_temperatures(ambient, cases.dump().c_str()));
  cases.push_back(parse_json(R"({ "name": "rigged", "set": { "hinges.mid.latch.stiffness": 0,
    "environment.gravity.1": -50 }, "distributions": { "mass": { "type": "normal", "mean": 10, "std": 6 } } })"));
  check_union(with_temperatures(ambient, cases.dump().c_str()));
}

TEST_CASE("a case's law is checked as the campaign's, at its place", "[warnings]") {
  const Json json = with_temperatures(R"({ "type": "normal", "mean": 290, "std": 5 })", R"([
    { "name": "ambient" },
    { "name": "hot", "distributions": { "misalign": { "type": "normal", "mean": 0, "std": 0.5 } } },
    { "name": "old", "distributions": { "root_spring": { "type": "normal", "mean": 1, "std": 0.45 } } },
    { "name": "weak", "distributions": { "root_spring": { "type": "normal", "mean": 0.05, "std": 0.001 } } } ])");
  check_union(json);
  const auto warnings = check_campaign(campaign_of(json), "");
  for (const auto& [pointer, found] :
       {std::pair("/cases/1/distributions/misalign", "±0.98 rad"),
        {"/cases/2/distributions/root_spring", "probability of 0.0131"},
        {"/cases/3/distributions/root_spring", "a factor of 0.05"}}) {
    CAPTURE(pointer);
    REQUIRE(at(warnings, pointer) != nullptr);
    CHECK_THAT(at(warnings, pointer)->found, Catch::Contains(found));
  }
}

TEST_CASE("a correlation with a case's constant is told, once with all such cases", "[warnings]") {
  Json json = with_temperatures(R"({ "type": "normal", "mean": 290, "std": 5 })", R"([
    { "name": "ambient" },
    { "name": "lab", "distributions": { "root_spring": { "type": "constant", "value": 1 } } },
    { "name": "shop", "distributions": { "root_spring": { "type": "constant", "value": 1.01 } } } ])");
  json["correlations"] =
      parse_json(R"([ { "between": ["root_spring", "temperature"], "spearman": 0.5 } ])");
  check_union(json);
  const auto warnings = check_campaign(campaign_of(json), "");
  REQUIRE(at(warnings, "/correlations/0") != nullptr);
  CHECK_THAT(at(warnings, "/correlations/0")->found,
             Catch::StartsWith("in cases lab, shop: a correlation of root_spring"));
}

TEST_CASE("limits are compared with the nominal wings of the cases", "[warnings]") {
  Json json = with_temperatures(R"({ "type": "constant", "value": 290 })", cold_and_hot);
  json["requirements"] = parse_json(
      R"([ { "output": "root.latch_time", "max": 9, "probability": 0.9, "confidence": 0.9 } ])");
  json["scene"]["hinges"][0]["spring"]["scale"] = 1e-5; // the wing in no case hardly moves
  for (Json& each : json["cases"]) each["set"] = {{"hinges.root.spring.scale", 1}};
  check_union(json);
  CHECK(at(check_campaign(campaign_of(json), ""), "/requirements/0/max") == nullptr);
  json["cases"][1].erase("set");
  json["requirements"] = parse_json(
      R"([ { "output": "root.latch_rate", "max": 30, "abs": true, "probability": 0.9, "confidence": 0.9 } ])");
  const auto warnings = check_campaign(campaign_of(json), "");
  REQUIRE(at(warnings, "/requirements/0/max") != nullptr);
  CHECK_THAT(at(warnings, "/requirements/0/max")->found, Catch::StartsWith("in case cold: "));
  json["cases"][1]["set"] = {{"hinges.root.spring.scale", 10}}; // there the limit is near
  check_union(json);
  CHECK(at(check_campaign(campaign_of(json), ""), "/requirements/0/max") == nullptr);
}

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
