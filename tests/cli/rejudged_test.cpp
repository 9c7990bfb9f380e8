// Requirements from a file of their own: the same in every command, with the warnings that they deserve.
#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A margin study over the seed wing's springs, few runs, without requirements.
Json margin_campaign() {
  Json json = quick_campaign(40);
  json["margin"] = parse_json(
      R"({ "scale": ["hinges.*.spring.scale"], "range": [0.5, 2], "points": 3, "tolerance": 0.5 })");
  return json;
}

const Json late = parse_json(R"([
  { "name": "L-1", "output": "root.latch_time", "max": 6, "probability": 0.8, "confidence": 0.9 } ])");

/// The warnings of a command, without those of its results.
std::vector<std::string> warnings_of(const std::string& error) {
  std::vector<std::string> lines;
  for (std::size_t at = error.find("warning: "); at != std::string::npos;
       at = error.find("warning: ", at + 1))
    lines.push_back(error.substr(at, error.find('\n', at) - at));
  return lines;
}

/// Runs the commands by which a page says that its sets are made again. @return the folder that they made
std::filesystem::path made_again(const Folder& folder, const std::filesystem::path& results) {
  const std::filesystem::path page = folder.path() / "page.html", again = folder.path() / "again";
  REQUIRE(run_program(folder, {"report", results, "--out", page}).code == 0);
  std::filesystem::remove_all(again);
  std::vector<std::string> commands;
  const Json data = page_data(page);
  for (const char* key : {"made_by", "judged_by"})
    for (const Json& set : data["sets"])
      if (std::string text = set[key]; !text.empty() && std::ranges::count(commands, text) == 0)
        commands.push_back(std::move(text));
  for (const std::string& command : commands) {
    std::istringstream in(command);
    std::vector<std::string> words;
    for (std::string word; in >> word;)
      words.push_back(word.starts_with("again") ? (folder.path() / word).string() : word);
    words.erase(words.begin());
    INFO(command);
    CHECK(run_program(folder, words).code <= 1);
  }
  return again;
}

} // namespace

TEST_CASE("margin judges the requirements of a file as if they were the campaign's") {
  const Folder folder;
  const auto written = [&](const std::string& name, const Json& json) {
    return folder.write(name.c_str(), json.dump());
  };
  Json own = margin_campaign();
  const std::string bare = written("bare.json", own);
  own["requirements"] = late;
  const std::string file = written("own.json", own);
  const auto margin = [&](const std::string& campaign, const std::string& requirements) {
    const std::filesystem::path out = folder.path() / ("m" + requirements);
    std::vector<std::string> command{"margin", campaign, "--out", out};
    if (!requirements.empty())
      command.insert(command.end(), {"--requirements", (folder.path() / requirements).string()});
    CHECK(run_program(folder, command).code <= 1);
    return parse_json_file(out / "margin.json");
  };
  const Json expected = margin(file, "");
  written("list.json", late);
  CHECK(margin(bare, "list.json") == expected);
  CHECK(margin(bare, "own.json") == expected);
  REQUIRE(run_program(folder, {"run", bare, "--out", folder.path() / "r"}).code == 0);
  REQUIRE(run_program(folder, {"analyze", folder.path() / "r", "--requirements",
                               folder.path() / "list.json"})
              .code == 0);
  std::filesystem::copy(folder.path() / "r" / summary_file, folder.path() / "summary.json");
  CHECK(margin(bare, "summary.json") == expected);
  REQUIRE(run_program(folder, {"run", file, "--out", folder.path() / "judged"}).code <= 1);
  std::filesystem::copy(folder.path() / "judged" / summary_file, folder.path() / "of_run.json");
  CHECK(margin(bare, "of_run.json") == expected); // among the requirements' keys are their verdicts
  const Json summary = parse_json_file(folder.path() / "of_run.json");
  folder.write("sorted.json", nlohmann::json(summary).dump()); // as other tools write it
  CHECK(margin(bare, "sorted.json") == expected);
  CHECK(run_program(folder, {"margin", bare, "--out", folder.path() / "none"}).code == 2);
  const std::string empty = written("empty.json", Json::array());
  const auto refused = run_program(
      folder, {"margin", file, "--requirements", empty, "--out", folder.path() / "none"});
  CHECK(refused.code == 2);
  CHECK_THAT(refused.error, HasFacts({"error: " + empty, "no requirement"}));
}

TEST_CASE("what margin recommends by other requirements is a campaign that runs") {
  const Folder folder;
  Json json = margin_campaign();
  json["requirements"] = parse_json(
      R"([{ "name": "D-1", "output": "deployed", "probability": 0.8, "confidence": 0.9 }])");
  json["until"] = parse_json(R"([{ "requirement": "D-1" }])");
  Json bounded = late; // too slow with weak springs, too fast with strong ones
  bounded.push_back({{"name", "L-2"},
                     {"output", "root.latch_time"},
                     {"min", 3.5},
                     {"probability", 0.8},
                     {"confidence", 0.9}});
  const std::string file = folder.write("c.json", json.dump()),
                    list = folder.write("late.json", bounded.dump());
  const std::filesystem::path out = folder.path() / "m";
  CHECK(run_program(folder, {"margin", file, "--requirements", list, "--out", out}).code <= 1);
  const std::filesystem::path recommended = out / "recommended.json";
  REQUIRE(std::filesystem::exists(recommended));
  CHECK(parse_json_file(recommended)["requirements"].size() == 2);
  const auto ran = run_program(folder, {"run", recommended, "--out", folder.path() / "r"});
  CHECK(ran.code <= 1);
}

TEST_CASE("the report of rejudged runs prints commands that judge by its requirements") {
  Json json = margin_campaign();
  json.erase("margin");
  json["requirements"] = parse_json(
      R"([{ "name": "D-1", "output": "deployed", "probability": 0.8, "confidence": 0.9 }])");
  const DoneCampaign done(json);
  const std::string page = done.folder.path() / "page.html";
  const auto set = [&] {
    REQUIRE(done.program({"report", done.path, "--out", page}).code == 0);
    return page_data(page)["sets"][0];
  };
  CHECK(set()["judged_by"] == "");
  const std::string file = done.folder.write("late.json", late.dump());
  REQUIRE(done.program({"analyze", done.path, "--requirements", file}).code == 0);
  std::string command = set()["judged_by"];
  CHECK(command ==
        "wingspread analyze again --requirements " + (done.path / summary_file).string());
  // made_by, then judged_by, give the same verdicts
  const std::filesystem::path again = done.folder.path() / "again";
  REQUIRE(done.program({"run", done.path / "campaign.json", "--out", again}).code == 0);
  REQUIRE(done.program({"analyze", again, "--requirements", done.path / summary_file}).code == 0);
  CHECK(parse_json_file(again / summary_file)["requirements"] ==
        parse_json_file(done.path / summary_file)["requirements"]);
}

TEST_CASE("the page's commands make every file of analysed runs again, byte for byte") {
  Json json = quick_campaign(30);
  json["statistics"] = {{"bins", 7}};
  const DoneCampaign done(json);
  const std::string file = done.folder.write("late.json", late.dump());
  for (const std::vector<std::string>& options : std::vector<std::vector<std::string>>{
           {},
           {"--confidence", "0.5"},
           {"--quantiles", "0.001,0.25,0.999"},
           {"--bins", "13"},
           {"--bins", "auto"},
           {"--requirements", file},
           {"--requirements", file, "--confidence", "0.8", "--quantiles", "0.2", "--bins", "3"}}) {
    std::vector<std::string> analyze{"analyze", done.path};
    analyze.insert(analyze.end(), options.begin(), options.end());
    REQUIRE(done.program(analyze).code <= 1);
    CHECK(contents(made_again(done.folder, done.path)) == contents(done.path));
  }
}

TEST_CASE("the page's commands make analysed cases again, whether all alike or one alone") {
  Json json = quick_campaign(12);
  json["cases"] = parse_json(R"([ { "name": "slow", "scale": { "bodies.*.inertia": 1.5 } },
                                  { "name": "plain" } ])");
  const Folder folder;
  const std::filesystem::path made = folder.path() / "r";
  REQUIRE(run_program(folder, {"run", folder.write("c.json", json.dump()), "--out", made}).code ==
          0);
  const std::string file = folder.write("late.json", late.dump());
  const auto same = [&](const std::vector<std::string>& analyze) {
    REQUIRE(run_program(folder, analyze).code <= 1);
    const std::filesystem::path again = made_again(folder, made);
    for (const char* name : {"", "slow", "plain"})
      CHECK(contents(again / name) == contents(made / name));
  };
  same({"analyze", made, "--requirements", file, "--confidence", "0.8", "--bins", "auto"});
  same({"analyze", made});
  same({"analyze", made / "slow", "--quantiles", "0.3"});
}

TEST_CASE("analyze warns of a limit that looks like degrees, at its place in the file") {
  const DoneCampaign done(quick_campaign(20));
  Json odd = late;
  odd[0]["output"] = "root.latch_rate", odd[0]["max"] = 150, odd[0]["abs"] = true;
  const auto analyzed = [&](const std::string& name, const Json& json) {
    const std::string file = done.folder.write(name.c_str(), json.dump());
    const auto warned =
        warnings_of(done.program({"analyze", done.path, "--requirements", file}).error);
    REQUIRE(warned.size() == 1);
    CHECK_THAT(warned.front(), HasFacts({file, "150", "57.3"}));
    return warned.front();
  };
  CHECK_THAT(analyzed("list.json", odd), HasFacts({": /0/max: "}));
  CHECK_THAT(analyzed("campaign.json", {{"requirements", odd}}),
             HasFacts({": /requirements/0/max: "}));
}

TEST_CASE("every command that runs a campaign warns of its input as run does") {
  const Folder folder;
  Json json = margin_campaign();
  json["scene"]["hinges"][1]["latch"]["stiffness"] = 0;
  json["requirements"] = late;
  const std::string file = folder.write("c.json", json.dump());
  const std::string place = "/scene/hinges/1/latch/stiffness";
  const auto warned = [&](std::vector<std::string> command) {
    const auto all = warnings_of(run_program(folder, command).error);
    return std::ranges::count_if(
        all, [&](const std::string& line) { return line.find(place) != std::string::npos; });
  };
  const auto out = [&](const char* name) { return (folder.path() / name).string(); };
  CHECK(warned({"run", file, "--out", out("r")}) == 1);
  CHECK(warned({"margin", file, "--out", out("m")}) == 1);
  CHECK(warned({"sensitivity", file, "--samples", "4", "--out", out("s")}) == 1);
  CHECK(warned({"rare", file, "--output", "root.latch_time", "--above", "5", "--samples", "100",
                "--repeats", "1"}) == 1);
}
