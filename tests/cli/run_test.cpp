#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

#include <chrono>
#include <csignal>
#include <thread>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A campaign's file and a place for its results.
struct RunSetting {
  Folder folder{};
  std::string campaign{};
  std::string out = (folder.path() / "r").string();

  explicit RunSetting(const Json& json) : campaign(folder.write("campaign.json", json.dump())) {}

  [[nodiscard]] Finished run(const std::string& to, std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"run", campaign, "--out", to});
    return run_program(folder, options);
  }
};

std::string paths(const std::string& folder) {
  std::string text;
  for (const char* file :
       {campaign_file, runs_file, summary_file, histograms_json_file, histograms_csv_file})
    text += folder + "/" + file + "\n";
  return text;
}

/// Waits until the file has that many lines. @return whether it came to that
bool wait_for_lines(const std::filesystem::path& file, long lines) {
  for (int i = 0; i < 3000; ++i) {
    if (std::ranges::count(read_text(file).value_or(""), '\n') > lines) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

} // namespace

TEST_CASE("a run writes its folder, and its paths to a pipe", "[parallel]") {
  const RunSetting setting(quick_campaign(40));
  const auto [code, out, error] = setting.run(setting.out, {"--threads", "2"});
  CHECK(code == 0);
  CHECK(error.empty());
  CHECK(out == paths(setting.out));
  const auto direct = setting.folder.path() / "direct";
  (void)run_into(direct, campaign_of(quick_campaign(40)));
  CHECK(contents(setting.out) == contents(direct));
  const Json timing = parse_json_file(setting.folder.path() / "r" / timing_file);
  CHECK(timing["ranks"] == 1);
  CHECK(timing["threads"] == 2);
  CHECK(timing["runs"] == 40);
  CHECK(timing["interrupted"] == false);
}

TEST_CASE("lanes that no processor has are refused, with cases and with --resume too") {
  Json json = quick_campaign(4);
  const RunSetting plain(json);
  json["cases"] = parse_json(R"([ { "name": "as_it_is" } ])");
  const RunSetting with_cases(json);
  CHECK(plain.run(plain.out).code == 0);
  const std::vector<std::string> asked{"--isa", "scalar", "--lanes", "8"},
      resumed{"--isa", "scalar", "--lanes", "8", "--resume"};
  for (const Finished& refused : {plain.run(plain.out + "2", asked), plain.run(plain.out, resumed),
                                  with_cases.run(with_cases.out, asked)}) {
    CHECK(refused.code == 2);
    CHECK_THAT(refused.error, HasFacts({"--isa scalar --lanes 8", "processor", "scalar (1)"}));
  }
  CHECK_FALSE(std::filesystem::exists(plain.out + "2"));
  for (const char* lanes : {"2", "4"}) { // whatever else this processor has, "scalar" has one
    const Finished refused = plain.run(plain.out + "2", {"--isa", "scalar", "--lanes", lanes});
    CHECK(refused.code == 2);
    CHECK_THAT(refused.error, HasFacts({"--isa scalar --lanes", lanes, "scalar (1)"}));
  }
  CHECK(plain.run(plain.out + "2", {"--isa", "scalar", "--lanes", "1"}).code == 0);
}

TEST_CASE("the table and the histograms, when asked for") {
  const RunSetting setting(quick_campaign(20));
  const auto [code, out, error] = setting.run(setting.out, {"--histograms"});
  CHECK(code == 0);
  CHECK(error.empty());
  CHECK(out.starts_with("three_panel · 20 runs · random, seed 7\n\nOUTCOME"));
  CHECK(out.find("\nroot.latch_time, s\n") != std::string::npos);
  const auto other = setting.run(setting.out + "2", {"--table"});
  CHECK(other.out.find("OUTCOME") != std::string::npos);
  CHECK(other.out.find("root.latch_time, s") == std::string::npos);
}

TEST_CASE("the table of cases says of each whether its stopping goals were reached") {
  Json json = quick_campaign(1010);
  json["cases"] = parse_json(
      R"([ { "name": "as_it_is" }, { "name": "weak", "scale": { "hinges.*.spring.scale": 0.9 } } ])");
  const RunSetting setting(json);
  const std::vector<std::string> goals{"--until", "deployed 0.5", "--until",
                                       "root.latch_time@0.5 0.000001"};
  const auto shown = [&](const std::string& to, std::vector<std::string> more) {
    more.insert(more.end(), goals.begin(), goals.end());
    const Finished end = setting.run(setting.out + to, more);
    CHECK_THAT(end.error, HasFacts({"weak: goal not reached in 1010 runs: root.latch_time@0.5 "
                                    "1e-06 s"}));
    CHECK_THAT(end.error, !Catch::Contains("deployed 0.5"));
    return end.out;
  };
  for (const char* table : {"--table", "--all"})
    CHECK_THAT(shown(table, {table}),
               HasFacts({"STOPPING GOAL", "deployed", "as_it_is", "yes", "weak", "yes",
                         "root.latch_time", "as_it_is", " s ", "no", "weak", " s ", "no"}));
  const std::string one = shown("one", {"--table", "--case", "weak"});
  CHECK_THAT(one, HasFacts({"STOPPING GOAL", "deployed", "weak", "yes", "weak", "no"}));
  CHECK_THAT(one, !Catch::Contains("as_it_is"));
}

TEST_CASE("a campaign of one run is made, and one more run is added to it") {
  const RunSetting setting(quick_campaign(20));
  for (const char* runs : {"1", "2"}) {
    CAPTURE(runs);
    CHECK(setting.run(setting.out, {"--runs", runs, "--resume"}).code == 0);
    const Results made = read_stored_results(read_stored_campaign(setting.out)).results;
    CHECK(std::to_string(made.size()) == runs);
  }
}

TEST_CASE("the number of runs and the seed can be given") {
  const RunSetting setting(quick_campaign(20));
  CHECK(setting.run(setting.out, {"--runs", "5", "--seed", "99"}).code == 0);
  const StoredCampaign stored = read_stored_campaign(setting.out);
  CHECK(stored.campaign.sampling.runs == 5);
  CHECK(stored.stamp.seed == 99);
  CHECK(read_stored_results(stored).results.size() == 5);
}

TEST_CASE("a bad campaign is refused with all of its problems, and nothing is written") {
  Json json = quick_campaign(20);
  json["sampling"]["runs"] = 0;
  json["scene"]["bodies"][1]["mass"] = -1;
  const RunSetting setting(json);
  const auto [code, out, error] = setting.run(setting.out);
  CHECK(code == 2);
  CHECK(out.empty());
  CHECK_THAT(error,
             HasFacts({"error: " + setting.campaign + ": /scene/bodies/1/mass: found -1",
                       "> 0\nerror: " + setting.campaign + ": /sampling/runs: found 0", "≥ 1\n"}));
  CHECK_FALSE(std::filesystem::exists(setting.out));
}

TEST_CASE("a folder in use is refused, and one that cannot be made") {
  const RunSetting setting(quick_campaign(5));
  CHECK(setting.run(setting.out).code == 0);
  const auto [code, out, error] = setting.run(setting.out);
  CHECK(code == 2);
  CHECK(out.empty());
  CHECK_THAT(error,
             HasFacts({"error: " + setting.out + ": found a folder with files in it", "--resume"}));
  const auto below_file = setting.run(setting.campaign + "/r");
  CHECK(below_file.code == 2);
  CHECK_THAT(below_file.error,
             HasFacts({"error: " + setting.campaign + "/r: found Not a directory"}));
}

TEST_CASE("runs that fail numerically are counted, and told by the exit code") {
  Json json = full_campaign(30);
  json["integration"]["max_steps"] = 300;
  json["integration"]["method"] = "dopri5"; // others need fewer
  const RunSetting setting(json);
  const auto [code, out, error] = setting.run(setting.out);
  CHECK(code == 3);
  CHECK(out == paths(setting.out));
  const Json summary = parse_json_file(setting.folder.path() / "r" / summary_file);
  long sum = 0;
  for (const auto& [status, share] : summary["status"].items()) sum += share["count"].get<long>();
  CHECK(sum == 30);
  // Φ(−10/6), by scipy 1.10.1
  CHECK_THAT(error, HasFacts({"warning: " + setting.campaign + ": /dispersions/1: found",
                              "bodies.panel_1.mass", "0.0478", "1e-09", "\"truncate\"",
                              "\nerror: " + summary["status"]["failed"]["count"].dump() +
                                  " of 30 runs failed numerically",
                              setting.out + "/summary.json"}));
  // the law's tail, the draws that have it, the runs that fail
  CHECK_THAT(error, HasFacts({"unphysical draws", "2 of 30 draws", "bodies.panel_3.mass"}));
  CHECK(lines_of(error).size() == 3);
}

TEST_CASE("runs that stall are counted with their reasons, and are no failures") {
  Json json = quick_campaign(12);
  for (Json& hinge : json["scene"]["hinges"])
    hinge["friction"] = {{"model", "exact"}, {"coulomb", 2.5}, {"static", 3}};
  const RunSetting setting(json);
  const auto [code, out, error] = setting.run(setting.out);
  CHECK(code == 0);
  CHECK(lines_of(error).size() == 3); // told of each hinge before it is run
  for (const std::string& line : lines_of(error))
    CHECK_THAT(line, Catch::StartsWith("warning: ") && Catch::Contains("a net static torque of "));
  const Results results = read_stored_results(read_stored_campaign(setting.out)).results;
  CHECK(std::ranges::count(results.status, Status::stalled) == 12);
  for (std::size_t row = 0; row < results.size(); ++row) CHECK_FALSE(results.reason[row].empty());
  const Json summary = parse_json_file(setting.folder.path() / "r" / summary_file);
  CHECK(summary["status"]["stalled"]["count"] == 12);
  CHECK(summary["status"]["failed"]["count"] == 0);
  CHECK(summary["outputs"]["deployment_time"]["missing"] == 12);
}

TEST_CASE("an interrupted run keeps what is done, and resuming completes it", "[parallel]") {
  const RunSetting setting(quick_campaign(4000));
  const auto path = setting.folder.path() / "r";
  const int signal = GENERATE(SIGINT, SIGTERM, SIGHUP);
  const bool urgent = signal != SIGINT; // it ends at once: the statistics can be made later
  const Program program(setting.folder,
                        {"run", setting.campaign, "--out", setting.out, "--threads", "2"});
  REQUIRE(wait_for_lines(path / runs_file, 50));
  program.send(signal);
  const auto [code, out, error] = program.finish();
  CHECK(code == 130);
  CHECK(out == (urgent ? "" : paths(setting.out)));
  const StoredCampaign stored = read_stored_campaign(path);
  const ResultsFile file = read_stored_results(stored);
  const std::size_t done = file.results.size();
  CHECK_FALSE(file.unterminated);
  CHECK(done >= 50);
  REQUIRE(done < 4000); // else the machine was too fast to be interrupted
  CHECK(std::filesystem::exists(path / summary_file) != urgent);
  if (!urgent) {
    const Json summary = parse_json_file(path / summary_file);
    CHECK(summary["runs"] == done);
    CHECK(summary["wingspread"]["partial"] == Json{{"done", done}, {"of", 4000}});
  }
  CHECK_THAT(error, HasFacts({"interrupted: " + std::to_string(done) + " of 4000 runs are kept",
                              "--resume"}));
  CHECK(lines_of(error).size() == 1);
  CHECK(parse_json_file(path / timing_file)["interrupted"] == true);

  const auto resumed = setting.run(setting.out, {"--resume", "--threads", "2"});
  CHECK(resumed.code == 0);
  CHECK(resumed.error.empty());
  CHECK(parse_json_file(path / timing_file)["runs_before"] == done);
  const auto whole = setting.folder.path() / "whole";
  CHECK(setting.run(whole).code == 0);
  CHECK(contents(path) == contents(whole));
}

TEST_CASE("an interrupted run of cases shows what each has so far", "[parallel]") {
  Json json = quick_campaign(4000);
  json["cases"] = parse_json(R"([ { "name": "light" }, { "name": "heavy" } ])");
  const RunSetting setting(json);
  for (const bool table : {false, true}) {
    const std::string out = setting.out + (table ? "t" : "p"), light = out + "/light";
    std::vector<std::string> words{"run", setting.campaign, "--out", out, "--threads", "2"};
    if (table) words.emplace_back("--table");
    const Program program(setting.folder, words);
    REQUIRE(wait_for_lines(light + "/runs.csv", 50));
    program.send(SIGINT);
    const Finished end = program.finish();
    CHECK(end.code == 130);
    if (table)
      CHECK_THAT(lines_of(end.out).front(), HasFacts({"light", "partial, of 4000 runs"}));
    else
      CHECK_THAT(end.out, Catch::StartsWith(paths(light)));
  }
}

TEST_CASE("a run that was killed can be resumed", "[parallel]") {
  const RunSetting setting(quick_campaign(1000));
  const auto path = setting.folder.path() / "r";
  const Program program(setting.folder,
                        {"run", setting.campaign, "--out", setting.out, "--threads", "2"});
  REQUIRE(wait_for_lines(path / runs_file, 20));
  program.send(SIGKILL);
  CHECK(program.finish().code == 128 + SIGKILL);
  CHECK(setting.run(setting.out, {"--resume"}).code == 0);
  const auto whole = setting.folder.path() / "whole";
  CHECK(setting.run(whole).code == 0);
  CHECK(contents(path) == contents(whole));
}

TEST_CASE("resuming what is complete changes nothing") {
  const RunSetting setting(quick_campaign(10));
  CHECK(setting.run(setting.out).code == 0);
  const auto before = contents(setting.out);
  CHECK(setting.run(setting.out, {"--resume"}).code == 0);
  CHECK(contents(setting.out) == before);
}

TEST_CASE("sample prints the draws of each run once, in order, however many there are") {
  const Folder folder;
  const std::string file = folder.write("c.json", quick_campaign(4).dump());
  const std::string out = folder.path() / "draws.csv";
  const Finished shown = run_program(folder, {"sample", file, "--runs", "3000"});
  REQUIRE(shown.code == 0);
  REQUIRE(shown.out.size() > 3 * 65536); // several blocks of output
  const std::vector<std::string> lines = lines_of(shown.out);
  REQUIRE(lines.size() == 3001);
  for (std::size_t run = 0; run < 3000; ++run)
    REQUIRE(lines[run + 1].starts_with(std::to_string(run) + ","));
  REQUIRE(run_program(folder, {"sample", file, "--runs", "3000", "--out", out}).code == 0);
  CHECK(read_text(out).value() == shown.out);
}
