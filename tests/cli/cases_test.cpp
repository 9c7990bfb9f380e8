#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "tests/cli/program.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A quick campaign with a temperature and three cases: cold (weaker springs), ambient (the nominal wing) and heavy.
Json campaign_with_cases(int runs) {
  Json campaign = quick_campaign(runs);
  campaign["dispersions"].push_back(parse_json(R"({
    "name": "temperature", "distribution": { "type": "normal", "mean": 20, "std": 5 },
    "through": [ { "to": ["hinges.*.friction.viscous"], "apply": "add",
                   "table": { "at": [-100, 20], "value": [0.8, 0] } } ] })"));
  campaign["cases"] = parse_json(R"([
    { "name": "cold", "distributions": { "temperature": { "type": "normal", "mean": -60, "std": 5 } } },
    { "name": "ambient" },
    { "name": "heavy", "scale": { "bodies.*.inertia": 1.5 } } ])");
  campaign["requirements"] = parse_json(R"([
    { "name": "T-1", "output": "deployment_time", "max": 9, "probability": 0.8, "confidence": 0.9 },
    { "output": "deployed", "probability": 0.8, "confidence": 0.9 } ])");
  return campaign;
}

/// The bytes of every file of the folder and of those in it, less the timings.
std::map<std::string, std::string> all_contents(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename() != timing_file)
      files[entry.path().lexically_relative(folder)] = read_text(entry.path()).value_or("");
  return files;
}

struct Cases {
  Folder folder{};
  std::string file, out = folder.path() / "r";
  explicit Cases(int runs) : file(folder.write("c.json", campaign_with_cases(runs).dump())) {}

  [[nodiscard]] Finished program(std::vector<std::string> arguments) const {
    return run_program(folder, arguments);
  }
};

} // namespace

TEST_CASE("run makes a results folder for each case, and holds them side by side", "[cases]") {
  const Cases cases(40);
  const auto [code, text, error] = cases.program({"run", cases.file, "--out", cases.out});
  CHECK(code == 1); // the worst
  CHECK(lines_of(text).front() == cases.out + "/campaign.json");
  CHECK(lines_of(text)[1] == cases.out + "/cases.json");
  CHECK(lines_of(text)[3] == cases.out + "/cold/runs.csv");
  CHECK_THAT(error, HasFacts({"not met: cold: T-1: deployment_time ≤ 9 s, 80 % at 90 %", "fail",
                              "20 of 40", "4"}));
  REQUIRE(lines_of(error).size() ==
          2); // a warning before: 20 is where the temperatures' table ends
  CHECK_THAT(lines_of(error)[0], HasFacts({"/dispersions/", "50 % of the draws", "temperature"}));

  const auto [checked, described, warned] = cases.program({"check", cases.file});
  CHECK(checked == 0);
  CHECK_THAT(described, Catch::Contains("120 runs in 3 cases"));
  const Json side_by_side = parse_json_file(cases.folder.path() / "r" / cases_file);
  const Json& late = side_by_side["requirements"][0];
  CHECK(late["name"] == "T-1");
  CHECK(late["worst"] == "cold");
  CHECK(late["verdict"] == "fail");
  CHECK(late["cases"]["ambient"]["verdict"] == "pass");
  CHECK(side_by_side["requirements"][1]["verdict"] == "pass");
  CHECK(side_by_side["joint_confidence"] == Approx(1 - 6 * 0.1).epsilon(1e-12));
  for (const char* name : {"cold", "ambient", "heavy"}) {
    const Json summary = parse_json_file(std::filesystem::path(cases.out) / name / summary_file);
    CHECK(side_by_side["cases"][name]["runs"] == 40);
    CHECK(side_by_side["cases"][name]["status"] == summary["status"]);
    CHECK(side_by_side["outputs"]["root.latch_time"][name] ==
          summary["outputs"]["root.latch_time"]);
  }
}

TEST_CASE("Each case has the same draws, and is a campaign that can be run by itself", "[cases]") {
  const Cases cases(12);
  CHECK(cases.program({"run", cases.file, "--out", cases.out}).code == 1);
  const auto rows = [&](const std::string& name) {
    const StoredCampaign stored = read_stored_campaign(std::filesystem::path(cases.out) / name);
    return read_stored_results(stored).results;
  };
  const Results ambient = rows("ambient"), heavy = rows("heavy"), cold = rows("cold");
  for (std::size_t k = 0; k < 12; ++k) {
    CHECK(heavy.row(k).draws == ambient.row(k).draws);
    CHECK(cold.row(k).draws[0] == ambient.row(k).draws[0]);
    CHECK(cold.draws[4].values[k] == Approx(ambient.draws[4].values[k] - 80).epsilon(1e-14));
    CHECK(heavy.row(k).outputs != ambient.row(k).outputs);
  }
  const std::string alone = cases.folder.path() / "alone";
  (void)cases.program({"run", cases.out + "/heavy/campaign.json", "--out", alone});
  CHECK(contents(alone) == contents(cases.out + "/heavy"));
}

TEST_CASE("Cases can be made one by one, stopped, shared out and extended, to the same bytes",
          "[cases]") {
  const Cases cases(24);
  (void)cases.program({"run", cases.file, "--out", cases.out, "--threads", "2"});
  const auto whole = all_contents(cases.out);
  CHECK(whole.size() == 2 + 3 * 5);

  const std::string parts = cases.folder.path() / "parts";
  (void)cases.program({"run", cases.file, "--out", parts, "--case", "heavy", "--case", "cold"});
  CHECK(!std::filesystem::exists(parts + "/ambient"));
  CHECK(parse_json_file(parts + "/cases.json")["cases"].size() == 2);
  std::filesystem::resize_file(parts + "/cold/runs.csv", 3000); // as a crash leaves it
  (void)cases.program({"run", cases.file, "--out", parts, "--resume"});
  CHECK(all_contents(parts) == whole);

  const std::string a = cases.folder.path() / "a", b = cases.folder.path() / "b";
  const std::string merged = cases.folder.path() / "merged";
  CHECK(cases.program({"run", cases.file, "--out", a, "--shard", "1/2"}).code == 0);
  const auto early = cases.program({"merge", a, "--out", merged});
  CHECK(early.code == 2);
  CHECK_THAT(early.error,
             HasFacts({"runs 12 to 23", "24 runs", "1 command", "--preview",
                       "\n  wingspread run " + a + "/campaign.json --out " +
                           cases.folder.path().string() + "/shard_2_of_2 --shard 2/2\n"}));
  CHECK(!std::filesystem::exists(merged));
  CHECK(cases.program({"run", cases.file, "--out", b, "--shard", "2/2"}).code == 0);
  CHECK(cases.program({"merge", b, a, "--out", merged}).code == 1);
  CHECK(all_contents(merged) == whole);
}

TEST_CASE("A case that stopped with its goals met is whole; one that was cut is partial",
          "[cases]") {
  const Cases cases(1010);
  const auto made = [&] { return parse_json_file(cases.out + "/cases.json")["cases"]; };
  (void)cases.program({"run", cases.file, "--out", cases.out, "--case", "heavy", "--case",
                       "ambient", "--until", "deployed 0.5"});
  REQUIRE(made().size() == 2);
  for (const Json& one : made()) CHECK((one["runs"] == 1000 && !one.contains("partial")));
}

TEST_CASE("goals of --until make the folder that the same goals in the campaign make", "[cases]") {
  const Folder folder;
  Json json = campaign_with_cases(1000);
  json["motorization"] = {{"springs_per_hinge", 4}};
  const std::string file = folder.write("c.json", json.dump()), given = folder.path() / "given";
  (void)run_program(folder, {"run", file, "--out", given, "--until", "deployed 0.5"});
  json["until"] = parse_json(R"([{ "output": "deployed", "width": 0.5 }])");
  const std::string own = folder.path() / "own";
  (void)run_program(folder, {"run", folder.write("u.json", json.dump()), "--out", own});
  CHECK(all_contents(given) == all_contents(own));
  CHECK(run_program(folder, {"analyze", given}).error ==
        run_program(folder, {"analyze", own}).error);
}

TEST_CASE("A folder of cases is one whole: another campaign, and a second writer, are refused",
          "[cases]") {
  const Cases cases(6);
  (void)cases.program({"run", cases.file, "--out", cases.out});
  const auto before = all_contents(cases.out);
  const auto other = cases.program(
      {"run", cases.file, "--out", cases.out, "--resume", "--set", "bodies.panel_1.inertia=0.6"});
  CHECK(other.code == 2);
  CHECK_THAT(other.error, Catch::Contains("error: " + cases.out +
                                          "/campaign.json: /scene/bodies/0/inertia: found "));
  const FolderLock lock(cases.out);
  const auto second = cases.program({"run", cases.file, "--out", cases.out, "--resume"});
  CHECK(second.code == 4);
  CHECK_THAT(second.error, Catch::Contains("expected a folder that no other process writes to"));
  auto after = all_contents(cases.out);
  after.erase(".lock");
  CHECK(after == before);
}

TEST_CASE("What is about one campaign asks for the case that is meant", "[cases]") {
  const Cases cases(6);
  (void)cases.program({"run", cases.file, "--out", cases.out});
  const HasFacts missing{"error: --case: found nothing", "\"cold\"", "\"ambient\"", "\"heavy\""};
  CHECK_THAT(cases.program({"replay", cases.out, "--run", "3"}).error, missing);
  CHECK_THAT(cases.program({"sensitivity", cases.out}).error, missing);
  CHECK_THAT(cases.program({"sensitivity", cases.file, "--samples", "2"}).error, missing);
  CHECK_THAT(cases.program({"rare", cases.file}).error, missing);
  const auto unknown = cases.program({"run", cases.file, "--out", cases.out, "--case", "cod"});
  CHECK(unknown.code == 2);
  CHECK_THAT(unknown.error, HasFacts({"error: --case: found \"cod\"", "\"ambient\"", "\"heavy\"",
                                      "did you mean \"cold\"?"}));
  const std::string plain = cases.folder.write("plain.json", quick_campaign(4).dump());
  CHECK_THAT(cases.program({"rare", plain, "--case", "cold"}).error,
             HasFacts({"error: --case: found \"cold\"", "no case"}));

  const auto named = cases.program({"replay", cases.out, "--run", "3", "--case", "heavy"});
  CHECK(named.code == 0);
  CHECK(named.out == cases.program({"replay", cases.out + "/heavy", "--run", "3"}).out);
  CHECK(cases.program({"sensitivity", cases.out, "--case", "heavy"}).code == 0);
  const auto draws = cases.program({"sample", cases.file, "--runs", "3", "--case", "ambient"});
  CHECK(draws.out == cases.program({"sample", cases.file, "--runs", "3"}).out);
  CHECK(draws.out != cases.program({"sample", cases.file, "--runs", "3", "--case", "cold"}).out);
}

// By hand, of a spring of 2 N·m. Cold: friction 0.2 · 1.5 · 3 and harness 0.1 · 2 N·m; ambient: 0.2 · 1.5 and 0.1 N·m.
TEST_CASE("the nominal wing of every command is the case's, with its tables and laws", "[cases]") {
  const Folder folder;
  Json campaign = one_panel_margin(20);
  Json& hinge = campaign["scene"]["hinges"][0];
  hinge["spring"] = {{"torque_stowed", 2}, {"torque_latched", 2}};
  hinge["friction"] = {{"model", "exact"}, {"coulomb", 0.2}, {"static", 0.2}};
  hinge["harness"] = {{"torque_stowed", 0.1}, {"torque_latched", 0.1}};
  campaign["dispersions"] = parse_json(R"([
    { "name": "temperature", "distribution": { "type": "normal", "mean": 20, "std": 5 }, "through": [
        { "to": ["hinges.*.friction.scale"], "apply": "scale",
          "table": { "at": [-60, 20], "value": [3, 1] } },
        { "to": ["hinges.*.harness.scale"], "apply": "scale",
          "table": { "at": [-60, 20], "value": [2, 1] } } ] },
    { "name": "lot", "distribution": { "type": "discrete", "values": [1, 1.5], "weights": [0.4, 0.6] },
      "apply": "scale", "to": ["hinges.*.friction.scale"] } ])");
  campaign["cases"] = parse_json(R"([ { "name": "ambient" },
    { "name": "cold", "distributions": { "temperature": { "type": "normal", "mean": -60, "std": 5 } } } ])");
  campaign["requirements"] =
      parse_json(R"([{ "output": "deployed", "probability": 0.8, "confidence": 0.9 }])");
  const std::string file = folder.write("c.json", campaign.dump()), out = folder.path() / "r";
  const auto program = [&](std::vector<std::string> arguments) {
    return run_program(folder, arguments);
  };

  const auto checked = program({"check", file});
  CHECK_THAT(checked.out,
             HasFacts({"static margins", "root (ambient)", "-0.333", "+0.667", "+1.500", "+0.667",
                       "root (cold)", "-0.758", "-0.394", "-0.091", "-0.394"}));
  const std::string cold = program({"check", file, "--case", "cold"}).out;
  CHECK_THAT(cold, HasFacts({"root (cold)", "-0.758", "-0.394", "-0.091"}));
  CHECK_THAT(cold, !Catch::Contains("ambient"));
  CHECK(program({"check", file, "--case", "cod"}).code == 2);

  CHECK(program({"run", file, "--out", out}).code == 0);
  CHECK(program({"report", out}).code == 0);
  const Json page = page_data(out + "/report.html");
  CHECK(program({"margin", file, "--out", out + "/m"}).code != 2);
  const Json at = parse_json_file(out + "/m/margin.json")["motorization"]["at"];
  const std::vector<std::pair<std::string, double>> nasa{{"ambient", 2 / 1.2 - 1},
                                                         {"cold", 2 / 3.3 - 1}};
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& [name, margin] = nasa[k];
    CHECK(page["sets"][k]["static_margins"]["hinges"][0]["least"] == Approx(margin).epsilon(1e-4));
    CHECK(at[k]["case"] == name);
    CHECK(at[k]["least_over_travel"][0]["nasa"]["nominal"] == Approx(margin).epsilon(1e-12));
    const Json run = parse_json(program({"simulate", file, "--case", name, "--json"}).out);
    const Json summary = parse_json_file(out + "/" + name + "/summary.json");
    CHECK(summary["outputs"]["root.latch_time"]["nominal"] == run["latches"][0]["time"]);
    CHECK(page["sets"][k]["outputs"][0]["nominal"] ==
          Approx(run["latches"][0]["time"]).epsilon(1e-5));
  }
}

TEST_CASE("analyze goes through all cases, and writes elsewhere where it is told to", "[cases]") {
  const Cases cases(24);
  (void)cases.program({"run", cases.file, "--out", cases.out});
  const auto before = all_contents(cases.out);
  CHECK(cases.program({"analyze", cases.out}).code == 1);
  CHECK(all_contents(cases.out) == before);
  const std::string other = cases.folder.write(
      "late.json",
      R"([{"output": "deployment_time", "max": 20, "probability": 0.8, "confidence": 0.9}])");
  const std::string late = cases.folder.path() / "late";
  CHECK(cases.program({"analyze", cases.out, "--requirements", other, "--out", late}).code == 0);
  CHECK(all_contents(cases.out) == before); // the first verdicts stay
  const Json side_by_side = parse_json_file(late + "/cases.json");
  REQUIRE(side_by_side["requirements"].size() == 1);
  CHECK(side_by_side["requirements"][0]["verdict"] == "pass");
  CHECK(parse_json_file(late + "/heavy/summary.json")["requirements"][0]["max"] == 20);
  CHECK(cases.program({"report", late}).code == 0);
  for (const Json& set : page_data(late + "/report.html")["sets"])
    CHECK(set["requirements"][0]["limit"] == 20);
  CHECK(cases.program({"replay", late, "--run", "3", "--case", "heavy"}).code == 0);
  // one case alone: cases.json does not know of it
  CHECK_THAT(cases.program({"analyze", cases.out + "/cold", "--requirements", other}).error,
             HasFacts({"warning: ", cases.out + "/cases.json", "keeps the earlier analysis of cold",
                       "wingspread analyze " + cases.out}));
  CHECK(read_text(cases.out + "/cases.json") == before.at("cases.json"));
  const std::string alone = cases.folder.path() / "alone";
  CHECK_THAT(cases.program({"analyze", cases.out + "/cold", "--out", alone}).error,
             !Catch::Contains("cases.json"));
}

TEST_CASE("cases that stop early are whole, and every command reads them", "[cases]") {
  const Folder folder;
  Json json = campaign_with_cases(4000);
  json["until"] = parse_json(R"([{ "output": "deployed", "width": 0.01 }])");
  const std::string file = folder.write("c.json", json.dump()), out = folder.path() / "r";
  const auto program = [&](std::vector<std::string> arguments) {
    return run_program(folder, arguments);
  };
  (void)program({"run", file, "--out", out});
  const Json cases = parse_json_file(out + "/cases.json")["cases"];
  for (const char* name : {"cold", "ambient", "heavy"}) {
    CHECK(cases[name]["runs"] == 1000);
    CHECK_FALSE(cases[name].contains("partial"));
  }
  const auto whole = all_contents(out);
  (void)program({"run", file, "--out", out, "--resume"});
  (void)program({"analyze", out});
  CHECK(all_contents(out) == whole);
  for (const char* command : {"simulate", "sample", "check", "rare", "sensitivity"})
    CHECK_THAT(program({command, file, "--case", "cod"}).error,
               HasFacts({"error: --case: found \"cod\"", "did you mean \"cold\"?"}));
  CHECK_THAT(program({"replay", out, "--run", "3", "--case", "cod"}).error,
             Catch::Contains("did you mean \"cold\"?"));
  CHECK(program({"run", file, "--out", out + "2", "--no-rows"}).code == 2);
  CHECK(program({"replay", out, "--run", "999", "--case", "cold"}).code == 0);
}

TEST_CASE("shards of cases: what is missing of any case, a preview, and the whole", "[cases]") {
  const Cases cases(12);
  const auto part = [&](int i) {
    return (cases.folder.path() / ("part" + std::to_string(i))).string();
  };
  for (const int i : {1, 2})
    CHECK(cases.program({"run", cases.file, "--out", part(i), "--shard", std::to_string(i) + "/2"})
              .code == 0);
  (void)cases.program({"run", cases.file, "--out", cases.out});
  std::filesystem::remove_all(part(2) + "/heavy"); // it was not begun
  std::filesystem::remove(part(2) + "/cases.json");
  const std::string out = cases.folder.path() / "out";
  const auto refused = cases.program({"merge", part(2), part(1), "--out", out});
  CHECK(refused.code == 2);
  CHECK_THAT(refused.error, HasFacts({"error: " + part(2) + "/heavy: found no runs 6 to 11",
                                      "shard 2/2", "1 command", "--preview",
                                      "\n  wingspread run " + part(2) + "/campaign.json --out " +
                                          part(2) + " --shard 2/2 --resume\n"}));
  CHECK_FALSE(std::filesystem::exists(out));
  const auto preview = cases.program({"merge", part(1), part(2), "--out", out, "--preview"});
  CHECK(preview.code == 1);
  CHECK_THAT(preview.error, HasFacts({out + "/heavy", "PREVIEW", "6 of", "12 runs"}));
  CHECK(parse_json_file(out + "/campaign.json")["wingspread"]["preview"] ==
        Json{{"runs", 30}, {"of", 36}});
  CHECK(parse_json_file(out + "/cases.json")["cases"]["heavy"]["partial"] == true);
  CHECK_FALSE(parse_json_file(out + "/cases.json")["cases"]["cold"].contains("partial"));
  CHECK(cases
            .program(
                {"run", part(2) + "/campaign.json", "--out", part(2), "--shard", "2/2", "--resume"})
            .code == 0);
  CHECK(cases.program({"merge", part(2), part(1), "--out", out}).code == 1);
  CHECK(all_contents(out) == all_contents(cases.out));
}

TEST_CASE("on a terminal one line tells of all cases, and does not run backwards", "[cases]") {
  const Cases cases(2000);
  const std::string typed = cases.folder.path() / "typed";
  const std::string command = std::string("script -qec '") + program_path + " run " + cases.file +
                              " --out " + cases.out + " --threads 1' " + typed + " > /dev/null";
  (void)std::system(command.c_str());
  std::istringstream text(read_text(typed).value());
  long last = 0, lines = 0;
  for (std::string line; std::getline(text, line, '\r');) {
    const std::size_t of = line.find("/6000 runs");
    if (of == std::string::npos) continue;
    const long done = std::stol(line.substr(line.rfind(' ', of) + 1));
    CHECK(done >= last);
    last = done;
    ++lines;
  }
  CHECK(last == 6000);
  CHECK(lines >= 3); // a beginning and two cases at least
  CHECK(read_text(typed).value().find("/2000 runs") == std::string::npos);
}

TEST_CASE("the commands for missing shards of some cases make what merges with the others",
          "[cases]") {
  const Cases cases(30);
  const auto run = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> words{"run",    cases.file, "--out",  out,
                                   "--case", "cold",     "--case", "heavy"};
    words.insert(words.end(), more.begin(), more.end());
    return cases.program(words).code;
  };
  const auto part = [&](int i) { return cases.folder.path() / ("part" + std::to_string(i)); };
  const std::string whole = cases.folder.path() / "whole", merged = cases.folder.path() / "merged";
  CHECK(run(whole, {}) == 1);
  for (const int i : {1, 3}) CHECK(run(part(i), {"--shard", std::to_string(i) + "/3"}) == 0);
  const Finished missing = cases.program({"merge", part(1), part(3), "--out", merged});
  CHECK(missing.code == 2);
  CHECK(run_named(cases.folder, missing.error) == std::vector<int>{0});
  CHECK(!std::filesystem::exists(part(2) / "ambient"));
  CHECK(cases.program({"merge", part(1), part(2), part(3), "--out", merged}).code == 1);
  CHECK(all_contents(merged) == all_contents(whole));
}
