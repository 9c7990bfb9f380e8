// Where no peak is ever proven final, no command advises a longer t_end: it names the reason.
#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A panel whose peaks t_end cuts; no run breaks the requirement by its value. @param how "", or why no peak is final
Json cut_panel(const std::string& how) {
  Json json = ringing_panel(100, 6, 2);
  json["integration"]["t_end"] = how.empty() ? 2.3 : 6;
  json["requirements"][0]["max"] = 500;
  Json& scene = json["scene"];
  Json& hinge = scene["hinges"][0];
  const Json turned = parse_json(R"({ "motion": "prescribed", "rate": 0 })");
  if (how != "") scene["base"] = turned;
  if (how == "acceleration") scene["base"]["angular_acceleration"] = 1e-5;
  if (how == "backlash") hinge["latch"]["backlash"] = 0.002;
  if (how == "air") {
    scene["base"]["rate"] = 0.001;
    scene["environment"]["air_density"] = 1.2;
    scene["bodies"][0]["plate"] = parse_json(
        R"({ "from": [-0.5, 0], "to": [0.5, 0], "width": 0.5, "drag_coefficient": 1.2 })");
  }
  if (how == "unheld") {
    scene["bodies"].push_back({{"name", "boom"}, {"mass", 0.1}, {"inertia", 0.01}});
    scene["hinges"].push_back(parse_json(R"({ "name": "pivot", "parent": "panel", "child": "boom",
      "parent_point": [0.5, 0], "child_point": [0, 0], "angle": { "stowed": 0, "latched": 1 },
      "spring": { "torque_stowed": 1e-3, "torque_latched": 1e-3 } })"));
  }
  if (how == "undamped") {
    hinge["latch"].erase("dissipation"), hinge["latch"]["damping"] = 0;
    scene["base"]["rate"] = 0.001, scene["base"]["acceleration"] = {0.001, 0};
  }
  if (how == "some draws") {
    json["integration"]["t_end"] = 2.3;
    json["dispersions"].push_back(parse_json(R"({ "name": "turn", "apply": "set",
      "to": ["base.angular_acceleration"],
      "distribution": { "type": "discrete", "values": [0, 1e-5], "weights": [9, 1] } })"));
  }
  if (how == "draws")
    json["dispersions"].push_back(parse_json(R"({ "name": "turn", "apply": "set",
      "to": ["base.angular_acceleration"],
      "distribution": { "type": "normal", "mean": 0, "std": 1e-5 } })"));
  return json;
}

/// Everything that the commands on a campaign print and write about t_end.
std::vector<std::pair<std::string, std::string>> all_said(const Folder& folder, const Json& json) {
  std::vector<std::pair<std::string, std::string>> all;
  const std::string file = folder.write("c.json", json.dump()), in = folder.path();
  const auto add = [&](const std::vector<std::string>& words, const std::string& written) {
    const Finished made = run_program(folder, words);
    CAPTURE(words, made.error);
    CHECK(made.code <= 1);
    all.emplace_back(words[0], made.out + made.error + read_text(in + written).value_or(""));
  };
  for (const char* name : {"/r", "/m", "/s", "/e", "/n"}) std::filesystem::remove_all(in + name);
  add({"run", file, "--out", in + "/r", "--table"}, "/r/summary.json");
  add({"run", file, "--out", in + "/n", "--no-rows", "--table"}, "/n/summary.json");
  add({"analyze", in + "/r", "--table"}, "/r/summary.json");
  add({"rare", file, "--output", "root.peak_moment", "--above", "500", "--samples", "100",
       "--repeats", "1", "--out", in + "/e"},
      "/e/rare.json");
  add({"sensitivity", in + "/r", "--all", "--out", in + "/s"}, "/s/sensitivity.json");
  add({"margin", file, "--out", in + "/m"}, "/m/margin.json");
  return all;
}

} // namespace

TEST_CASE("a longer t_end is advised only where one may do") {
  const Folder folder;
  for (const auto& [command, text] : all_said(folder, cut_panel(""))) {
    CAPTURE(command, text);
    CHECK_THAT(text, Catch::Contains("Lengthen t_end") && !Catch::Contains("No t_end will do"));
  }
  for (const auto& [how, why] :
       {std::pair("acceleration", "with a base that turns faster and faster"),
        {"draws", "with a base that turns faster and faster"},
        {"backlash", "with backlash in a latch"},
        {"unheld", "with a hinge that nothing holds"},
        {"undamped", "with latches without damping on a base that is pushed and turns"},
        {"air", "in air, with a base that moves"}}) {
    const Json json = cut_panel(how);
    for (const auto& [command, text] : all_said(folder, json)) {
      CAPTURE(how, command, text);
      CHECK_THAT(text, !Catch::Contains("engthen t_end") &&
                           Catch::Contains(std::string("No t_end will do ") + why));
    }
    const Finished checked = run_program(folder, {"check", folder.path() / "c.json"});
    CHECK_THAT(checked.error, HasFacts({"/requirements/0", why, "whatever t_end is"}));
  }
  for (const auto& [command, text] : all_said(folder, cut_panel("some draws"))) {
    CAPTURE(command, text);
    CHECK_THAT(text, Catch::Contains("Lengthen t_end, but none will do for runs with a base that"));
  }
}

TEST_CASE("check names the case in which no peak is final, and leaves a min alone") {
  const Folder folder;
  Json json = cut_panel("acceleration");
  json["scene"]["base"]["angular_acceleration"] = 0;
  json["cases"] = parse_json(
      R"([ { "name": "still" }, { "name": "spun", "add": { "base.angular_acceleration": 1e-5 } } ])");
  const auto checked = [&] {
    return run_program(folder, {"check", folder.write("c.json", json.dump()), "--strict"});
  };
  CHECK(checked().code == 2);
  CHECK_THAT(checked().error, HasFacts({"/requirements/0", "in case spun with a base that turns"}));
  json["requirements"][0].erase("max"); // a cut peak meets a min that it has reached
  json["requirements"][0]["min"] = 3;
  CHECK(checked().code == 0);
  CHECK(checked().error.empty());
  const std::string out = folder.path() / "r";
  CHECK(run_program(folder, {"run", folder.path() / "c.json", "--out", out}).code == 0);
}
