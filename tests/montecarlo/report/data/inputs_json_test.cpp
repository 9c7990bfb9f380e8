#include "montecarlo/model/scene_file/scene_json.hpp"
#include "montecarlo/report/data/inputs_json.hpp"
#include "tests/montecarlo/report/data/page_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

const Json& entry(const Json& list, const char* key, const std::string& value) {
  const auto found = std::ranges::find(
      list, value, [key](const Json& each) { return each[key].get<std::string>(); });
  REQUIRE(found != list.end());
  return *found;
}

} // namespace

TEST_CASE("inputs say what a case changes, of the scene and of laws", "[page]") {
  Json json = quick_campaign(5);
  json["scene"]["hinges"][1]["initial_rate"] = -0.125;
  json["cases"] = parse_json(R"([ { "name": "heavy", "scale": { "bodies.panel_1.inertia": 1.5 },
    "set": { "hinges.root.harness.offset": 0.25, "hinges.mid.initial_rate": 0 },
    "distributions": { "root_spring": { "type": "constant", "value": 0.9 } } } ])");
  const Campaign whole = campaign_of(json);
  const Campaign heavy = campaigns_of(whole).front();
  const auto source = source_of(heavy, rows_of(RunPlan(heavy), {0, 5}));
  source->before_case = whole;
  const Json inputs = inputs_json(*source, {});
  const Json& inertia = entry(inputs["scene"], "path", "bodies.panel_1.inertia");
  CHECK(inertia["label"] == "panel 1 inertia");
  CHECK(inertia["unit"] == "kg·m²");
  CHECK(inertia["value"] == whole.scene.bodies[0].inertia);
  CHECK(inertia["case_value"].get<double>() == Approx(1.5 * whole.scene.bodies[0].inertia));
  CHECK(entry(inputs["scene"], "path", "bodies.panel_1.mass")["case_value"].is_null());
  const Json& added = entry(inputs["scene"], "path", "hinges.root.harness.offset");
  CHECK((added["value"] == 0 && added["case_value"] == 0.25));
  const Json& taken = entry(inputs["scene"], "path", "hinges.mid.initial_rate");
  CHECK((taken["value"] == -0.125 && taken["case_value"] == 0));
  for (const Json& each : inputs["scene"]) CHECK(each["path"] != "hinges.tip.harness.offset"); // 0
  const Json& spring = entry(inputs["dispersions"], "draw", "root_spring");
  CHECK(spring["law"] == "constant (value 0.9)");
  CHECK(spring["law_before_case"] == "normal (mean 1, std 0.05)");
  CHECK(spring["paths"].size() == 2);
  CHECK(spring["apply"] == "scale");
  CHECK(spring["unit"] == "");
  const Json& mass = entry(inputs["dispersions"], "draw", "mass.panel_2");
  CHECK(mass["law"] == "uniform (lower 9, upper 11)");
  CHECK(mass["law_before_case"].is_null());
  CHECK(mass["low"] == 9.02); // 1 % and 99 % of it
  CHECK(mass["high"] == 10.98);
  CHECK(mass["unit"] == "kg");
  CHECK(mass["nominal"] == 10.0);
  CHECK(entry(inputs["settings"], "label", "seed")["value"] == "7");
}

TEST_CASE("the settings are those of the runs; a step only where the method has one", "[page]") {
  Json json = quick_campaign(5);
  const auto setting = [&](const std::string& label) -> std::string {
    const auto source = source_of(campaign_of(json), rows_of(RunPlan(campaign_of(json)), {0, 2}));
    const Json inputs = inputs_json(*source, {});
    for (const Json& each : inputs["settings"])
      if (each["label"] == label) return each["value"];
    return "";
  };
  json["integration"]["max_steps"] = 54321;
  CHECK(setting("trial steps of a run, at most") == "54321");
  CHECK(setting("step").empty());
  json["integration"]["method"] = "runge_kutta4";
  json["integration"]["step"] = 0.002;
  CHECK(setting("method") == "runge_kutta4");
  CHECK(setting("step") == "0.002 s");
}

TEST_CASE("each rank correlation has a label of its own, whatever the order of its names",
          "[page]") {
  Json json = quick_campaign(5);
  json["correlations"] = parse_json(
      R"([ { "between": ["root_spring", "mass.panel_2"], "spearman": 0.5 },
           { "between": ["mass.panel_2", "mass.panel_1"], "spearman": -0.25 } ])");
  const auto source = source_of(campaign_of(json), rows_of(RunPlan(campaign_of(json)), {0, 2}));
  const Json inputs = inputs_json(*source, {});
  CHECK(entry(inputs["settings"], "label", "rank correlation mass.panel_2, root_spring")["value"] ==
        "0.5");
  CHECK(entry(inputs["settings"], "label",
              "rank correlation mass.panel_1, mass.panel_2")["value"] == "-0.25");
}

TEST_CASE("inputs have words for dispersions, and what a draw does through its tables in each case",
          "[page]") {
  Json json = quick_campaign(5);
  json["dispersions"].push_back(parse_json(R"({ "name": "temperature",
    "distribution": { "type": "normal", "mean": 20, "std": 5 },
    "through": [ { "to": ["hinges.*.friction.coulomb"], "apply": "scale",
                   "table": { "at": [-60, 20, 60], "value": [2, 1, 0.5] } } ] })"));
  json["cases"] = parse_json(R"([ { "name": "cold",
    "distributions": { "temperature": { "type": "normal", "mean": -60, "std": 5 } } } ])");
  const Campaign whole = campaign_of(json);
  const Campaign cold = campaigns_of(whole).front();
  for (const auto& [campaign, factor] : {std::pair(whole, 1.0), std::pair(cold, 2.0)}) {
    const auto source = source_of(campaign, rows_of(RunPlan(campaign), {0, 5}));
    source->before_case = whole;
    const Json inputs = inputs_json(*source, {});
    CHECK(entry(inputs["dispersions"], "draw", "root_spring")["words"] == "root spring");
    CHECK(entry(inputs["dispersions"], "draw", "mass.panel_2")["words"] == "panel_2 mass");
    const Json& warmth = entry(inputs["dispersions"], "draw", "temperature");
    CHECK(warmth["words"] == "temperature");
    REQUIRE(warmth["tables"].size() == 1);
    const Json& table = warmth["tables"][0];
    CHECK(table["words"] == "friction coulomb of all hinges");
    CHECK(table["paths"] == Json{"hinges.*.friction.coulomb"});
    CHECK(table["apply"] == "scale");
    CHECK(table["at"] == Json{-60.0, 20.0, 60.0});
    CHECK(table["value"] == Json{2.0, 1.0, 0.5});
    CHECK(table["of_median"].get<double>() == Approx(factor));
  }
}

TEST_CASE("inputs have every table of the scene with its numbers and units", "[page]") {
  Json json = quick_campaign(5);
  json["scene"] = parse_json_file(three_panel_file());
  json["scene"]["hinges"][1]["spring"] = parse_json(R"({ "measured": {
    "angle": [-3.2, -1.5, 0, 0.1], "deploying": [2, 1.5, 1, 1], "stowing": [3, 2, 1.25, 1.25] } })");
  json["scene"]["hinges"][2]["harness"] =
      parse_json(R"({ "table": { "angle": [3.2, 0, -0.1], "torque": [0.125, 0.25, 0.25] } })");
  json["scene"]["base"]["motion"] = "prescribed";
  json["scene"]["base"]["table"] = parse_json(R"({ "time": [1, 2], "rate": [0, 0.5] })");
  json["dispersions"] = parse_json(R"([ { "name": "scale", "to": ["hinges.root.spring.scale"],
    "apply": "set", "distribution": { "type": "uniform", "lower": 0.9, "upper": 1.1 } } ])");
  const Campaign campaign = campaign_of(json);
  const Json written = write_scene(campaign.scene);
  const Json inputs = inputs_json(*source_of(campaign, rows_of(RunPlan(campaign), {0, 5})), {});
  std::map<std::string, std::vector<std::string>> found;
  for (const Json& table : inputs["tables"])
    for (const Json& column : table["columns"])
      found[table["path"]].push_back(column["name"].get<std::string>() + " " +
                                     column["unit"].get<std::string>() + " " +
                                     column["values"].dump());
  const std::string mid = json["scene"]["hinges"][1]["name"],
                    tip = json["scene"]["hinges"][2]["name"];
  const auto row = [](const char* name_and_unit, const Json& values) {
    return std::string(name_and_unit) + " " + values.dump();
  };
  const Json& spring = written["hinges"][1]["spring"]["measured"];
  const Json& harness = written["hinges"][2]["harness"]["table"];
  CHECK(found == std::map<std::string, std::vector<std::string>>{
                     {"base.table", {row("time s", {1.0, 2.0}), row("rate rad/s", {0.0, 0.5})}},
                     {"hinges." + mid + ".spring.measured",
                      {row("angle rad", spring["angle"]), row("deploying N·m", spring["deploying"]),
                       row("stowing N·m", spring["stowing"])}},
                     {"hinges." + tip + ".harness.table",
                      {row("angle rad", harness["angle"]), row("torque N·m", harness["torque"])}}});
}
