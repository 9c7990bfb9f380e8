// What the page says of a set of runs, key by key against the set's summary.
#include "montecarlo/model/input_checks/check_input.hpp"
#include "montecarlo/report/data/page_numbers.hpp"
#include "montecarlo/report/data/set_json.hpp"
#include "tests/montecarlo/report/data/page_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a set says whose runs it has and how they are made again", "[page]") {
  const auto source = made(quick_campaign(20));
  const auto json = [&] { return set_json(*source, {}, 1); };
  const Json whole = json();
  CHECK(whole["label"] == "set");
  CHECK(whole["folder"] == "results/set");
  CHECK(whole["case"].is_null());
  CHECK(whole["seed"] == "7");
  CHECK(whole["hash"] == source->stored.stamp.hash);
  CHECK((whole["runs"] == 20 && whole["planned"] == 20));
  CHECK((whole["partial"] == false && whole["stopped"] == false && whole["foreign"] == false));
  CHECK(whole["rows"] == true);
  CHECK(whole["shard"].is_null());
  CHECK(whole["confidence"] == source->summary.confidence);
  CHECK(whole["made_by"] ==
        "wingspread run results/set/campaign.json --seed 7 --runs 20 --out again");
  source->summary.runs = 19;
  CHECK(json()["partial"] == true);
  source->summary.stopped = true; // by its goals: no run is missing
  CHECK((json()["partial"] == false && json()["stopped"] == true));
  source->stored.stamp.shard = Shard{2, 3};
  source->stored.campaign.of_case = "cold";
  source->made_cases = {"cold", "hot"};
  CHECK((json()["shard"] == "2/3" && json()["case"] == "cold"));
  CHECK(json()["made_by"] == "wingspread run results/set/campaign.json --seed 7 --runs 20 "
                             "--case cold --case hot --shard 2/3 --out again");
  source->stored.foreign = true;
  CHECK((json()["made_by"] == "" && json()["foreign"] == true));
}

TEST_CASE("a set has its summary's statuses, reasons and places where hinges stopped", "[page]") {
  const auto source = made(quick_campaign(20));
  Summary& summary = source->summary;
  const auto json = [&] { return set_json(*source, {}, 1); };
  CHECK(!json().contains("stalled_at")); // none stopped
  CHECK(json()["reasons"].empty());
  const Json statuses = json()["statuses"];
  REQUIRE(statuses.size() == summary.statuses.size());
  for (std::size_t k = 0; k < statuses.size(); ++k) {
    CHECK(statuses[k]["status"] == to_string(summary.statuses[k].status));
    CHECK(statuses[k]["count"] == summary.statuses[k].count);
    CHECK(statuses[k]["rate"] == page_number(summary.statuses[k].rate));
  }
  summary.stalled_at = {{"root", 3, 0.5, 0.25, 0.75}, {"tip", 1, 1, 1, 1}};
  CHECK(json()["stalled_at"] == parse_json(R"([
    { "hinge": "root", "count": 3, "median": 0.5, "least": 0.25, "largest": 0.75 },
    { "hinge": "tip", "count": 1, "median": 1.0, "least": 1.0, "largest": 1.0 } ])"));
  for (long k = 0; k < 60; ++k)
    summary.reasons.push_back({Status::stalled, "reason " + std::to_string(k), 60 - k});
  const Json reasons = json()["reasons"];
  REQUIRE(reasons.size() == 50);
  CHECK(reasons[49] == Json{{"status", "stalled"}, {"reason", "reason 49"}, {"count", 11}});
}

TEST_CASE("a set counts the orders of latching, and warns of outputs that the page leaves out",
          "[page]") {
  const auto source = made(quick_campaign(20));
  const Json json = set_json(*source, {}, 1);
  long runs = json["without_latch"].get<long>();
  REQUIRE(!json["orders"].empty());
  for (const Json& order : json["orders"]) {
    runs += order["count"].get<long>();
    CHECK(order["gaps"].size() == 2); // of three hinges
  }
  CHECK(runs == 20);
  CHECK(json["order_kinds"] == json["orders"].size());
  CHECK(json["wing_orders"].empty()); // one wing
  const std::size_t warned = json["warnings"].size();
  PageDetail few;
  few.outputs = source->results.outputs.size() - 1;
  const Json fewer = set_json(*source, few, 1);
  REQUIRE(fewer["warnings"].size() == warned + 1);
  CHECK(fewer["warnings"].back() == "the page shows " + std::to_string(few.outputs) + " of " +
                                        std::to_string(few.outputs + 1) +
                                        " outputs, first those with a requirement; "
                                        "results/set/summary.json has all");
  source->stored.own_requirements.emplace();
  CHECK(set_json(*source, {}, 1)["warnings"].size() == warned + 1);
  for (const char* elsewhere : {"static_margins", "margin", "rare"})
    CHECK(json[elsewhere].is_null());
}

TEST_CASE("a share near 1 keeps its distance, and a requirement has the unit of its output",
          "[page]") {
  Json json = quick_campaign(20);
  json["requirements"] = parse_json(
      R"([ { "output": "tip.latch_rate", "min": -9, "probability": 0.2, "confidence": 0.5 },
           { "output": "deployed", "probability": 0.2, "confidence": 0.5 } ])");
  const auto source = made(json);
  StatusShare& deployed = source->summary.statuses.front();
  deployed.rate = 0.999999925;
  deployed.bounds = {0.9999997808181891, 0.9999999845331966};
  source->summary.requirements[1].share = 1 - 1 / 4e7;
  const Json set = set_json(*source, {}, 1);
  CHECK(set["statuses"][0]["rate"] == 0.999999925);
  CHECK(set["statuses"][0]["lower"] == 0.9999997808181891);
  CHECK(set["statuses"][0]["upper"] == 0.9999999845331966);
  CHECK(set["requirements"][1]["observed"] == 1 - 1 / 4e7);
  CHECK(set["requirements"][0]["unit"] == "rad/s");
  CHECK(set["requirements"][1]["unit"] == "");
}

TEST_CASE("the gaps of an order are those of the rows, in four digits", "[page]") {
  const auto source = made(quick_campaign(20));
  const Json order = set_json(*source, {}, 1)["orders"][0];
  std::vector<std::string> hinges;
  for (const Hinge& hinge : source->stored.campaign.scene.hinges) hinges.push_back(hinge.name);
  const auto gaps = latch_gaps(source->results, hinges, order["order"].get<std::string>());
  REQUIRE((gaps.size() == 2 && order["gaps"].size() == 2));
  for (std::size_t k = 0; k < 2; ++k)
    CHECK(order["gaps"][k] == Json{{"before", gaps[k].before},
                                   {"after", gaps[k].after},
                                   {"least", rounded(gaps[k].least, 4)},
                                   {"median", rounded(gaps[k].median, 4)}});
}

TEST_CASE("a set has each requirement with its verdict, and the runs that break it", "[page]") {
  Json campaign = quick_campaign(200);
  campaign["requirements"] = parse_json(R"([
    { "output": "deployed", "probability": 0.5, "confidence": 0.9, "id": "R1" },
    { "output": "root.latch_time", "max": 1, "probability": 0.9, "confidence": 0.9 },
    { "output": "root.latch_time", "min": 1, "probability": 0.9, "confidence": 0.9, "name": "late" },
    { "output": "root.latch_rate", "max": 99, "abs": true, "probability": 0.999, "confidence": 0.9 } ])");
  const auto source = made(campaign);
  const Json all = set_json(*source, {}, 1)["requirements"];
  REQUIRE(all.size() == 4);
  const auto column = [&](const char* key) {
    Json values = Json::array();
    for (const Json& each : all) values.push_back(each[key]);
    return values.dump();
  };
  CHECK(column("kind") == R"(["status","<=",">=","<="])");
  CHECK(column("limit") == "[null,1.0,1.0,99.0]");
  CHECK(column("upper") == "[true,true,false,true]");
  CHECK(column("abs") == "[false,false,false,true]");
  CHECK(column("id") == R"(["R1","","",""])");
  CHECK(column("name") == R"(["","","late",""])");
  CHECK(column("verdict") == R"(["passed","failed","passed","open"])"); // 200 runs show no 99.9 %
  CHECK(column("broken") == "[0,200,0,0]");
  CHECK(column("beyond") == "[0,200,0,0]");
  CHECK(all[1]["beyond_runs"].size() == 5);
  const std::vector<double> times = [&] {
    std::vector<double> values;
    for (std::size_t row = 0; row < source->results.runs.size(); ++row)
      values.push_back(source->results.outputs[0].values[row]);
    return values;
  }();
  REQUIRE(source->results.outputs[0].name == "root.latch_time");
  const auto last = std::ranges::max_element(times);
  CHECK(all[1]["worst"]["run"] == last - times.begin());
  CHECK(all[1]["worst"]["value"] == page_number(*last));
  CHECK(all[2]["worst"]["run"] == std::ranges::min_element(times) - times.begin());
}

TEST_CASE("the page warns of gaps between the runs, as analyze does", "[page]") {
  const Campaign campaign = campaign_of(quick_campaign(20));
  const RunPlan plan(campaign);
  const Results whole = rows_of(plan, {0, 20});
  const auto warned = [&](auto keeps) {
    Results some(plan.names());
    for (std::size_t row = 0; row < whole.size(); ++row)
      if (keeps(whole.runs[row])) some.append(whole.row(row));
    const std::string lines =
        set_json(*source_of(campaign, std::move(some)), {}, 1)["warnings"].dump();
    return lines.find("19 of 20 runs, with gaps that no interruption leaves") != std::string::npos;
  };
  CHECK(warned([](long run) { return run != 7; }));
  CHECK_FALSE(warned([](long run) { return run != 19; })); // an interruption
  CHECK_FALSE(warned([](long) { return true; }));
}

TEST_CASE("the page warns of a recorded row that its run made again contradicts", "[page]") {
  const auto source = made(quick_campaign(20));
  const auto said = [&] {
    const Json json = set_json(*source, {}, 1);
    for (const Json& motion : json["motions"]) CHECK_FALSE(motion.contains("differs"));
    return json["warnings"].dump();
  };
  CHECK(said().find("recorded as") == std::string::npos);
  const auto column = std::ranges::find(source->results.outputs, "deployment_time", &Column::name);
  REQUIRE(column != source->results.outputs.end());
  const auto edited = [&](double factor) {
    Results rows(RunPlan(source->stored.campaign).names());
    for (std::size_t row = 0; row < source->results.size(); ++row) {
      ResultRow each = source->results.row(row);
      const auto place = static_cast<std::size_t>(column - source->results.outputs.begin());
      if (row == 3) each.outputs[place] *= factor; // then the slowest run, which the page shows
      rows.append(each);
    }
    return set_json(*source_of(source->stored.campaign, std::move(rows)), {}, 1)["warnings"].dump();
  };
  CHECK(edited(1e3).find("run 3, column deployment_time: recorded as") != std::string::npos);
  CHECK(edited(1 + 1e-12).find("recorded as") == std::string::npos); // of another machine
}

TEST_CASE("the page has the warnings of the input checks", "[page]") {
  Json json = quick_campaign(20);
  const auto said = [&] { return set_json(*made(json), {}, 1)["warnings"].dump(); };
  CHECK(said().find("latch/stiffness") == std::string::npos);
  json["scene"]["hinges"][0]["latch"]["stiffness"] = 0;
  const Campaign campaign = campaign_of(json);
  const auto warnings = check_input(campaign, "");
  REQUIRE_FALSE(warnings.empty());
  for (const InputWarning& each : warnings)
    CHECK(said().find("input: " + each.pointer + ": ") != std::string::npos);
}

TEST_CASE("the page has what requirements show together, and how they were judged", "[page]") {
  Json json = quick_campaign(60);
  json["requirements"] = parse_json(R"([
    { "output": "deployed", "probability": 0.8, "confidence": 0.8 },
    { "output": "root.latch_time", "max": 20, "probability": 0.8, "confidence": 0.9, "group": "times" },
    { "output": "mid.latch_time", "max": 0.1, "probability": 0.8, "confidence": 0.9, "group": "times" } ])");
  const auto source = made(json);
  const Json set = set_json(*source, {}, 1), &together = set["together"];
  REQUIRE(together["groups"].size() == 1);
  const GroupVerdict group = judge_groups(source->summary.requirements).front();
  CHECK((group.members == 2 && group.passed == 1));
  CHECK(together["groups"][0] == Json{{"group", "times"},
                                      {"confidence", 0.9},
                                      {"requirements", 2},
                                      {"passed", 1},
                                      {"verdict", "failed"}});
  CHECK(together["confidence"] == joint_confidence(source->summary.requirements));
  CHECK(set["judged_by"] == "");
  judge_by(source->stored.campaign.requirements, source->stored);
  CHECK(set_json(*source, {}, 1)["judged_by"] ==
        "wingspread analyze again --requirements results/set/summary.json");
  for (const std::size_t argument : {1, 2}) { // the page's second and third folder: each by itself
    source->argument = argument;
    const Json other = set_json(*source, {}, 1);
    const std::string again = "again" + std::to_string(argument + 1);
    CHECK_THAT(other["made_by"].get<std::string>(), Catch::EndsWith(" --out " + again));
    CHECK_THAT(other["judged_by"].get<std::string>(),
               Catch::StartsWith("wingspread analyze " + again + " "));
  }
}
