#include "montecarlo/analyses/margin/margin_report.hpp"
#include "tests/cli/program.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <csignal>
#include <fstream>
#include <regex>
#include <thread>

using namespace wingspread;
using namespace wingspread::test;

namespace {

struct Place {
  Folder folder{};
  std::string out = (folder.path() / "m").string();

  [[nodiscard]] Finished operator()(const std::vector<std::string>& arguments) const {
    return run_program(folder, arguments);
  }
  [[nodiscard]] std::string file(const Json& json, const char* name = "campaign.json") const {
    return folder.write(name, json.dump());
  }
  [[nodiscard]] Finished margin(const Json& json) const {
    return (*this)({"margin", file(json), "--out", out});
  }
  [[nodiscard]] Json found() const { return parse_json_file(out + "/" + margin_json_file); }
};

} // namespace

TEST_CASE("margin, from a requirement missed to new springs that meet it") {
  const Place program;
  Json json = one_panel_margin(300);
  for (Json& torque : json["scene"]["hinges"][0]["spring"]) torque = 0.75 * torque.get<double>();
  json["sampling"]["extended_from"] = {200};
  const std::string campaign = program.file(json), out = program.out;
  CHECK(program({"run", campaign, "--out", out + "1"}).code == 1); // missed
  const auto [code, text, error] = program({"margin", campaign, "--out", out});
  CHECK(code == 0);
  CHECK_THAT(error, Catch::Contains("warning: at the recommended scale ") && // by every standard
                        Catch::Contains("static margins are below 0: ECSS margin of root -") &&
                        Catch::Contains("; AIAA margin of root -"));
  CHECK_THAT(text, Catch::StartsWith("one_panel · margin · 300 runs per scale") &&
                       Catch::Contains("weakest springs") && Catch::Contains("strongest springs") &&
                       Catch::Contains("all requirements are met") &&
                       Catch::Contains("ECSS-E-ST-33-01C") && Catch::Contains("NASA-STD-5017B"));
  for (const std::string& line : lines_of(text)) // characters, not bytes
    CHECK(std::ranges::count_if(line, [](char c) { return (c & 0xC0) != 0x80; }) <= 100);
  const Json found = program.found(), search = found["searches"][0];
  CHECK(found["met"] == true);
  CHECK(found["warnings"].size() == 1);
  CHECK(search["present"]["passes"] == false);
  CHECK(search["present"]["failing"][0]["output"] == "deployed");
  CHECK(search["window"]["lower"]["set_by"][0]["requirement"] == "deployed, 97 % at 90 %");
  CHECK(search["window"]["upper"]["set_by"][0]["requirement"] ==
        "root.latch_rate ≥ -0.8 rad/s, 97 % at 90 %");
  CHECK(search["recommended"]["confirmation"]["passes"] == true);
  const double scale = search["recommended"]["scale"];
  for (const auto& [end, torque] : json["scene"]["hinges"][0]["spring"].items())
    CHECK(search["recommended"]["values"]["hinges.root.spring." + end].get<double>() ==
          Approx(scale * torque.get<double>()));
  // the new springs meet the requirements, with the campaign's draws and with others
  const std::string resized = out + "/recommended.json";
  CHECK_FALSE(parse_json_file(resized)["sampling"].contains("extended_from")); // not analysed yet
  CHECK(program({"run", resized, "--out", out + "2"}).code == 0);
  CHECK(program({"run", resized, "--out", out + "3", "--seed", "99"}).code == 0);
  CHECK(program({"check", resized}).code == 0);
}

TEST_CASE("campaigns at a hair's breadth of the edges, one by one: met within, missed outside") {
  const Place program;
  const Json json = one_panel_margin(300);
  CHECK(program.margin(json).code == 0);
  const Json window = program.found()["searches"][0]["window"];
  for (const char* edge : {"lower", "upper"})
    for (const bool within : {true, false}) {
      const double scale = window[edge][within ? "scale" : "fails_at"];
      Json sized = json;
      sized["dispersions"].push_back({{"name", "scale"},
                                      {"distribution", {{"type", "constant"}, {"value", scale}}},
                                      {"apply", "scale"},
                                      {"to", json["margin"]["scale"]}});
      const std::string there = program.out + edge + (within ? "1" : "2");
      CHECK(program({"run", program.file(sized), "--out", there}).code == (within ? 0 : 1));
    }
}

TEST_CASE("check bounds the runs of margin, and their time") {
  const Place program;
  Json json = one_panel_margin(300);
  const Campaign campaign = campaign_of(json);
  const MarginRuns bounds = margin_runs(campaign);
  const Finished checked = program({"check", program.file(json)});
  CHECK_THAT(checked.out, HasFacts({"cost: the nominal run takes ", "cost of margin: at least ",
                                    std::to_string(bounds.least) + " runs (about ",
                                    std::to_string(bounds.most) + " (about "}));
  const long runs = margin_of(campaign).runs;
  CHECK((bounds.least <= runs && runs <= bounds.most));
  for (const char* key : {"margin", "requirements"}) {
    Json without = json;
    without.erase(key);
    const Finished told = program({"check", program.file(without)});
    CHECK_THAT(told.out, Catch::Contains("cost: ") && !Catch::Contains("cost of margin"));
  }
}

TEST_CASE("margin's files have the same bytes for any threads", "[parallel]") {
  const Place program;
  Json json = one_panel_margin(200);
  json["margin"]["cases"] = {"nominal", "one_spring_out"};
  json["margin"]["range"] = {0.5, 3};
  json["requirements"][1]["min"] = -2;
  const std::string campaign = program.file(json);
  std::map<std::string, std::string> first;
  for (const char* threads : {"1", "3"}) {
    const std::string out = program.out + threads;
    const auto finished =
        program({"margin", campaign, "--out", out, "--threads", threads, "--json"});
    CHECK(finished.code == 0);
    auto files = contents(out);
    CHECK(finished.out == files[margin_json_file]);
    files["stdout"] = finished.out;
    if (!first.empty()) CHECK(files == first);
    first = files;
  }
  CHECK(first.size() == 5); // margin.json, margin.csv, motorization.csv, recommended.json
}

TEST_CASE("margin's tables have a row for everything") {
  const Place program;
  Json json = one_panel_margin(200);
  json["margin"]["motorization"] = {{"points", 3}};
  for (Json& torque : json["scene"]["hinges"][0]["spring"]) torque = 0.75 * torque.get<double>();
  CHECK(program.margin(json).code == 0);
  const Json found = program.found();
  const std::size_t looks = found["searches"][0]["looks"];
  const auto rows = lines_of(*read_text(program.out + "/margin.csv"));
  CHECK(rows.size() == 1 + 2 * looks);
  CHECK(rows[0] == "search,scale,case,runs,deployed,deployed_lower,deployed_upper,requirement,"
                   "output,limit,probability,confidence,verdict,broken,allowed,share,"
                   "guaranteed_share,observed,guaranteed");
  CHECK_THAT(rows[1], Catch::StartsWith("joint,0.5,nominal,200,0,0,") &&
                          Catch::Contains(",fail,200,2,0,0,,"));
  const auto places = lines_of(*read_text(program.out + "/motorization.csv"));
  CHECK(places.size() == 1 + 2 * 3); // at scale 1 and the recommended one
  CHECK_THAT(places[0], Catch::StartsWith("scale,case,hinge,travel,angle,available,") &&
                            Catch::Contains(",ecss,ecss@0.01,ecss@0.5,ecss@0.99,"));
  CHECK(places[1].starts_with("1,nominal,root,0,1.570796326794896"));
}

TEST_CASE("margin says which requirements leave no window, and exits 1") {
  const Place program;
  Json json = one_panel_margin(200);
  json["requirements"][1] = {
      {"output", "root.peak_moment"}, {"max", 40}, {"probability", 0.97}, {"confidence", 0.9}};
  const auto [code, text, error] = program.margin(json);
  CHECK(code == 1);
  CHECK_THAT(error, HasFacts({"not met: joint: no scale", "meets all requirements\n"}));
  CHECK_THAT(text, Catch::Contains("EMPTY: no scale that was run meets all requirements.\n"));
  const Json search = program.found()["searches"][0];
  CHECK(search["window"].is_null());
  CHECK(search["closed_by"][0]["requirement"] == "root.peak_moment ≤ 40 N·m, 97 % at 90 %");
  CHECK_FALSE(std::filesystem::exists(program.out + "/recommended.json"));
}

TEST_CASE("margin, hinge by hinge, reports each") {
  const Place program;
  Json json = quick_campaign(60);
  json["requirements"] =
      parse_json(R"([{ "output": "deployed", "probability": 0.9, "confidence": 0.9 }])");
  json["margin"] = parse_json(R"({ "scale": ["hinges.*.spring.torque_stowed"],
                                   "range": [0.9, 1.1], "points": 2, "mode": "each" })");
  const auto finished = program.margin(json);
  CHECK(finished.code == 1);
  CHECK_THAT(finished.out, Catch::Contains("hinge root alone") &&
                               Catch::Contains("hinge mid alone") && Catch::Contains("no edge"));
  CHECK_THAT(finished.error, HasFacts({"not met: root: nothing fails up to 8.8", "no edge"}));
  CHECK(program.found()["searches"].size() == 3);
}

TEST_CASE("margin refuses a used folder, and what it cannot show, before anything runs") {
  const Place program;
  Json json = one_panel_margin(50);
  const auto refused = program.margin(json);
  CHECK(refused.code == 2);
  CHECK_THAT(refused.error, Catch::Contains("/sampling/runs: found 50, expected at least 76"));
  CHECK_FALSE(std::filesystem::exists(program.out));
  Json unjudged = one_panel_margin(100);
  unjudged["margin"]["cases"] = {"one_spring_out"};
  unjudged["requirements"] = parse_json(
      R"([{ "motorization": "ECSS", "min": 0.3, "probability": 0.95, "confidence": 0.9 }])");
  CHECK_THAT(
      program.margin(unjudged).error,
      Catch::Contains("/margin/cases: found only cases with a lost spring, expected \"nominal\""));
  json["sampling"]["runs"] = 80;
  json["integration"]["max_steps"] = 2; // all fail
  const auto failed = program.margin(json);
  CHECK(failed.code == 3);
  CHECK_THAT(failed.error, Catch::Contains("runs failed numerically, and count against"));
  const auto used = program.margin(json);
  CHECK(used.code == 2);
  CHECK_THAT(used.error, Catch::Contains("a folder with files in it, expected a new or an empty"));
}

TEST_CASE("margin names the campaign's file and the options that stand for its margin") {
  const Place program;
  Json json = one_panel_margin(50);
  json.erase("margin");
  const std::string file = program.file(json);
  const auto told = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"margin", file, "--out", program.out});
    const Finished refused = program(options);
    CHECK((refused.code == 2 && refused.out.empty()));
    return refused.error;
  };
  const std::string path = "hinges.*.spring.scale";
  CHECK_THAT(told({}), HasFacts({"error: " + file + ": /margin: ", "--scale", "--range A B",
                                 file + ": /sampling/runs: found 50"}));
  CHECK_THAT(told({"--scale", path}), HasFacts({"error: --range: ", "two numbers", "--range A B"}));
  CHECK_THAT(told({"--scale", path, "--range", "0.5", "2"}),
             HasFacts({"error: " + file + ": /sampling/runs: found 50"}));
  const std::string shard = program.folder.path();
  CHECK_THAT(told({"--scale", path, "--range", "0.5", "2", "--from", shard, shard}),
             HasFacts({"error: " + shard + ": ", "the same folder"}));
}

TEST_CASE("margin interrupted keeps the scales that were finished", "[parallel]") {
  const Place program;
  Json json = one_panel_margin(1000);
  json["margin"]["points"] = 100;
  const std::string campaign = program.file(json), whole = program.out + "_whole";
  CHECK(program({"margin", campaign, "--out", whole}).code == 0);
  const auto all = lines_of(*read_text(whole + "/margin.csv"));
  const auto csv = program.out + "/margin.csv";
  std::vector<std::string> kept;
  for (int wait = 20; kept.size() < 2;
       wait *= 2) { // until a scale is finished by then, and not all are
    std::filesystem::remove_all(program.out);
    const Program running(program.folder,
                          {"margin", campaign, "--out", program.out, "--threads", "1"});
    std::this_thread::sleep_for(std::chrono::milliseconds(wait));
    running.send(SIGINT);
    const Finished finished = running.finish();
    if (finished.code == 128 + SIGINT && finished.error.find("interrupted") == std::string::npos)
      continue; // before it was armed
    REQUIRE(finished.code == 130);
    CHECK_THAT(finished.error, HasFacts({"interrupted: ", " runs are kept", "--resume", csv}));
    CHECK_FALSE(std::filesystem::exists(program.out + "/margin.json"));
    kept = lines_of(*read_text(csv));
    REQUIRE(kept.front() == all.front()); // the header
  }
  // both requirements of the scales that were finished, as the whole study has them, and not of all
  CHECK(kept.size() % 2 == 1);
  CHECK(kept.size() < all.size());
  for (const std::string& row : kept) CHECK(std::ranges::find(all, row) != all.end());
  CHECK_THAT(kept[1], Catch::StartsWith("joint,0.5,nominal,1000,"));
  CHECK(program({"margin", campaign, "--out", program.out, "--resume"}).code == 0);
  CHECK(contents(program.out) == contents(whole));
}

// The panel's least margin by NASA is 0.2 a/(3 · 0.8) − 1, which no draw brings to 0.
TEST_CASE("run judges static margins by the side of what its runs do, and analyze too") {
  const Place program;
  Json json = one_panel_margin(100);
  json["requirements"] = parse_json(R"([
    { "output": "deployed", "probability": 0.9, "confidence": 0.9 },
    { "name": "T-1", "motorization": "NASA", "probability": 0.9, "confidence": 0.9 } ])");
  const auto [code, text, error] =
      program({"run", program.file(json), "--out", program.out, "--table"});
  CHECK(code == 1);
  CHECK_THAT(error, HasFacts({"not met: T-1: NASA margin of every hinge ≥ 0, 90 % at 90 %", "fail",
                              "100 of 100 runs", "5"}));
  const Json verdict = parse_json_file(program.out + "/summary.json")["requirements"][1];
  CHECK(verdict["motorization"] == "NASA");
  CHECK(verdict["hinge"] == "*");
  CHECK(verdict["verdict"] == "fail");
  CHECK(verdict["failures"]["seen"] == 100);
  CHECK(verdict["observed"]["value"].get<double>() < -0.9);
  const std::string others = program.folder.write(
      "others.json",
      R"([{ "motorization": "AIAA", "hinge": "root", "min": -1, "probability": 0.9, "confidence": 0.9 }])");
  CHECK(program({"analyze", program.out, "--requirements", others}).code == 0);
}

TEST_CASE("margin states its drawbacks, and holds its requirements in every case") {
  const Place program;
  Json json = one_panel_margin(300);
  for (Json& torque : json["scene"]["hinges"][0]["spring"]) torque = 0.75 * torque.get<double>();
  json["cases"] = parse_json(R"([
    { "name": "ambient", "scale": { "hinges.root.latch.stiffness": 1 } },
    { "name": "cold", "scale": { "hinges.root.friction.coulomb": 1.02,
                                 "hinges.root.friction.static": 1.02 } } ])");
  const auto [code, text, error] = program.margin(json);
  CHECK(code == 0);
  CHECK_THAT(text, Catch::Contains("  drawbacks") &&
                       Catch::Contains("root.latch_rate ≥ -0.8 rad/s, 97 % at 90 % (ambient)") &&
                       Catch::Contains("\nambient\n") && Catch::Contains("\ncold\n") &&
                       Catch::Contains("GSFC-STD-7000A (22 April 2013): critical_design · "
                                       "AIAA S-114-2005: critical_design\n"));
  const std::regex range(
      R"((\d[\d.]*) – (\d[\d.]*))"); // the scales between which an edge lies, and others
  std::sregex_iterator at(text.begin(), text.end(), range);
  CHECK(at != std::sregex_iterator());
  for (; at != std::sregex_iterator(); ++at) CHECK(std::stod((*at)[1]) < std::stod((*at)[2]));
  const Json found = program.found(), search = found["searches"][0];
  CHECK(found["cases"] == Json({"ambient", "cold"}));
  CHECK(search["window"]["lower"]["set_by"][0]["case"] == "cold");
  CHECK(search["window"]["upper"]["set_by"][0]["case"] == "ambient");
  CHECK(search["recommended"]["given_up"]["requirements"][0]["case"] == "ambient");
  CHECK(search["recommended"]["strain"].get<double>() < 1);
  REQUIRE(found["motorization"]["at"].size() == 4); // two cases, present and recommended
  CHECK(found["motorization"]["at"][1]["case"] == "cold");
  const Json& cold = found["motorization"]["at"][1]["least_over_travel"][0];
  CHECK(cold["gevs"]["nominal"].get<double>() ==
        Approx(0.75 * 0.2 / (3 * 0.8 * 1.02) - 1).epsilon(1e-12));
}

TEST_CASE("margin: --scale and --range stand for the campaign's own", "[long]") {
  const Place program;
  Json own = one_panel_margin(300);
  const Json scale = own["margin"]["scale"], range = own["margin"]["range"];
  Json without = own;
  without.erase("margin");
  std::vector<std::string> arguments{"margin", program.file(without, "without.json"), "--out",
                                     program.out + "2", "--scale"};
  for (const Json& path : scale) arguments.push_back(path);
  arguments.insert(arguments.end(), {"--range", range[0].dump(), range[1].dump()});
  own["margin"] = {{"scale", scale}, {"range", range}};
  const auto by_file = program.margin(own), by_options = program(arguments);
  CHECK(by_file.code == by_options.code);
  CHECK(read_text(program.out + "/margin.csv") == read_text(program.out + "2/margin.csv"));
  CHECK(read_text(program.out + "/recommended.json") ==
        read_text(program.out + "2/recommended.json"));
  const auto [code, text, error] =
      program({"margin", program.file(without, "without.json"), "--out", program.out + "3",
               "--scale", "hinges.none.spring.scale", "--range", "2", "1"});
  CHECK(code == 2);
  CHECK_THAT(error, Catch::Contains("--scale") && Catch::Contains("--range"));
}
