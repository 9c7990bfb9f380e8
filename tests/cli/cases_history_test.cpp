// Folders of cases that were made in several sessions: what they keep, and what the last session says of all.
#include "montecarlo/results/results_folder/cases_folder.hpp"
#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Two cases of 24 runs: all wings deploy in time in `light`, none does in `heavy`.
struct Sessions {
  Folder folder{};
  std::string file, out = folder.path() / "r";

  Sessions() {
    Json campaign = quick_campaign(24);
    campaign["cases"] = parse_json(R"([ { "name": "light" },
      { "name": "heavy", "scale": { "bodies.*.inertia": 60 } } ])");
    campaign["requirements"] = parse_json(R"([
      { "output": "deployment_time", "max": 12, "probability": 0.8, "confidence": 0.9 } ])");
    file = folder.write("c.json", campaign.dump());
  }
  [[nodiscard]] Finished run(std::vector<std::string> options) const {
    options.insert(options.begin(), {"run", file, "--out", out});
    return run_program(folder, options);
  }
  [[nodiscard]] Json compared() const { return parse_json_file(out + '/' + cases_file); }
};

} // namespace

TEST_CASE(
    "an extended folder of cases keeps the analyses of its cases, and a rerun judges as it does",
    "[cases]") {
  const Sessions sessions;
  (void)sessions.run({});
  (void)sessions.run({"--resume", "--runs", "40", "--case", "heavy"});
  CHECK(sessions.compared()["cases"]["light"]["partial"] == true); // 16 runs are missing
  CHECK_FALSE(sessions.compared()["cases"]["heavy"].contains("partial"));
  (void)sessions.run({"--resume", "--runs", "40"});
  CHECK_FALSE(sessions.compared()["cases"]["light"].contains("partial"));
  const Json whole = parse_json_file(sessions.out + "/campaign.json");
  CHECK(whole["sampling"]["extended_from"] == Json{24});
  const std::string again = sessions.folder.path() / "again";
  (void)run_program(sessions.folder, {"run", sessions.out + "/campaign.json", "--out", again});
  for (const std::string name : {"/light", "/heavy"})
    CHECK(contents(again + name) == contents(sessions.out + name));
  CHECK(read_text(again + "/cases.json") == read_text(sessions.out + "/cases.json"));
  CHECK(sessions.run({"--resume", "--runs", "40"}).code == 1); // nothing to do, and not refused
}

TEST_CASE("a folder of cases that were extended unevenly goes on by its own campaign.json",
          "[cases]") {
  const Sessions sessions;
  const auto on = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words{"run", sessions.out + "/campaign.json", "--out", sessions.out,
                                   "--resume"};
    words.insert(words.end(), options.begin(), options.end());
    return run_program(sessions.folder, words);
  };
  const auto analyses = [&](const char* of_case) {
    const Json campaign = parse_json_file(sessions.out + of_case + "/campaign.json");
    return campaign["sampling"].value("extended_from", Json::array());
  };
  SECTION("each case keeps the analyses that it had") {
    (void)sessions.run({});
    (void)sessions.run({"--resume", "--runs", "40", "--case", "heavy"});
    (void)sessions.run({"--resume", "--runs", "50"});
    CHECK(on({}).code == 1); // 1: `heavy` does not meet its requirement
    CHECK(on({"--runs", "60"}).code == 1);
    CHECK(analyses("/heavy") == Json{24, 40, 50});
    CHECK(analyses("/light") == Json{24, 50});
    CHECK(analyses("") == Json{24, 40, 50});
    for (const char* name : {"light", "heavy"})
      CHECK(sessions.compared()["cases"][name]["runs"] == 60);
  }
  SECTION("a case that is made later") {
    (void)sessions.run({"--case", "heavy"});
    (void)sessions.run({"--resume", "--runs", "40", "--case", "heavy"});
    (void)sessions.run({"--resume", "--runs", "40"});
    CHECK(analyses("/light") == Json::array());
    CHECK(on({"--runs", "50"}).code == 1);
    CHECK(analyses("/light") == Json{40});
  }
}

TEST_CASE("a case that cannot go on is refused before a run of any case is made", "[cases]") {
  const Sessions sessions;
  (void)sessions.run({});
  const std::string file = sessions.out + "/heavy/campaign.json";
  std::string text = *read_text(file);
  const std::string stamp = "\"version\": \"";
  text.insert(text.find(stamp) + stamp.size(), "9.");
  std::ofstream(file) << text;
  const auto before = contents(sessions.out), light = contents(sessions.out + "/light");
  const Finished refused = sessions.run({"--resume", "--runs", "40"});
  CHECK(refused.code == 2);
  CHECK_THAT(refused.error, HasFacts({file, "/wingspread/version", "found 9."}));
  CHECK(contents(sessions.out) == before);
  CHECK(contents(sessions.out + "/light") == light);
}

TEST_CASE("cases.json stays where a folder is refused", "[cases]") {
  const Sessions sessions;
  (void)sessions.run({});
  const std::string before = *read_text(sessions.out + "/cases.json");
  const std::string rows = sessions.out + "/heavy/runs.csv";
  const std::string text = *read_text(rows);
  const auto second = text.find('\n', text.find('\n') + 1) + 1;
  std::ofstream(rows) << text.substr(0, second) + text.substr(text.find('\n', second) + 1);
  CHECK(sessions.run({"--resume"}).code == 2);
  CHECK(read_text(sessions.out + "/cases.json") == before);
}

TEST_CASE("a session with one case ends with the verdicts of all", "[cases]") {
  const Sessions sessions;
  CHECK(sessions.run({"--case", "heavy"}).code == 1);
  const Finished last = sessions.run({"--case", "light", "--resume"});
  CHECK(last.code == 1);
  CHECK_THAT(last.error, Catch::Contains("not met: heavy: deployment_time"));
}

TEST_CASE("a requirement that a case does not meet names the others that do not show it either",
          "[cases]") {
  const Sessions sessions;
  Json campaign = parse_json_file(sessions.file);
  campaign["requirements"][0]["probability"] = 0.99; // 24 runs cannot show it
  (void)sessions.folder.write("c.json", campaign.dump());
  const Finished done = sessions.run({});
  CHECK(done.code == 1);
  CHECK_THAT(done.error,
             Catch::Contains("not met: heavy: ") && Catch::Contains("(nor met: light)"));
}

TEST_CASE("a session with one case says why another is not judged", "[cases]") {
  const Sessions sessions;
  (void)sessions.run({});
  const std::string rows = sessions.out + "/heavy/runs.csv", text = read_text(rows).value();
  std::size_t end = 0;
  for (int line = 0; line < 11; ++line) end = text.find('\n', end) + 1;
  write_file(rows, text.substr(0, end)); // as an interruption leaves it
  for (const char* file : {"/heavy/summary.json", "/cases.json"})
    std::filesystem::remove(sessions.out + file);
  const Finished done = sessions.run({"--resume", "--case", "light"});
  CHECK(done.code == 1);
  CHECK_THAT(done.error, Catch::Contains("not met: heavy: not judged: it has 10 of 24 runs"));
}

TEST_CASE("analyze and merge know of the runs that a case lacks, as run does", "[cases]") {
  const Sessions sessions;
  (void)sessions.run({});
  (void)sessions.run({"--resume", "--runs", "40", "--case", "heavy"});
  const std::string before = *read_text(sessions.out + "/cases.json");
  const std::string merged = sessions.folder.path() / "m";
  (void)run_program(sessions.folder, {"analyze", sessions.out});
  CHECK(read_text(sessions.out + "/cases.json") == before);
  const Finished refused = run_program(sessions.folder, {"merge", sessions.out, "--out", merged});
  CHECK(refused.code == 2);
  CHECK_THAT(refused.error, HasFacts({"/light", "no runs 24 to 39", "--preview", "--resume"}));
  CHECK_FALSE(std::filesystem::exists(merged));
  const Finished preview = run_program(
      sessions.folder, {"merge", sessions.out, "--out", merged, "--preview", "--table"});
  CHECK(preview.code == 1);
  CHECK(parse_json_file(merged + "/campaign.json")["wingspread"]["preview"] ==
        Json{{"runs", 64}, {"of", 80}});
  CHECK(parse_json_file(merged + "/cases.json")["cases"]["light"]["partial"] == true);
  CHECK_THAT(lines_of(preview.out).front(), HasFacts({"2 cases", "PREVIEW: 64 of 80 runs"}));
  // heavy has all its runs and is judged; light is a part of its runs and is not
  CHECK_THAT(preview.error, Catch::Contains("not met: heavy: deployment_time"));
  CHECK_THAT(preview.error, !Catch::Contains("light: deployment_time"));
  CHECK_THAT(preview.error, !Catch::Contains("nor met"));
  CHECK(run_named(sessions.folder, refused.error) == std::vector<int>{1});
  CHECK(run_program(sessions.folder, {"merge", sessions.out, "--out", merged}).code == 1);
  CHECK(contents(merged) == contents(sessions.out));
}

TEST_CASE("a session with one case keeps what analyze made of another", "[cases]") {
  const Sessions sessions;
  (void)sessions.run({});
  const std::string late = sessions.folder.write("late.json", R"([
    { "output": "deployed", "probability": 0.5, "confidence": 0.9 },
    { "output": "deployment_time", "max": 19, "probability": 0.5, "confidence": 0.9 } ])");
  const std::string heavy = sessions.out + "/heavy";
  (void)run_program(sessions.folder, {"analyze", heavy, "--requirements", late});
  const auto before = contents(heavy);
  CHECK(sessions.run({"--resume", "--case", "light"}).code == 1);
  CHECK(contents(heavy) == before);
  CHECK(sessions.compared()["requirements"].size() == 1); // the campaign's own
}

TEST_CASE("goals to stop at are refused for a campaign that was extended", "[cases]") {
  const Sessions sessions;
  (void)sessions.run({});
  (void)sessions.run({"--resume", "--runs", "40", "--case", "heavy"});
  const std::string again = sessions.folder.path() / "again";
  std::vector<std::string> words{
      "run", sessions.out + "/heavy/campaign.json", "--out", again, "--until", "deployed 50%"};
  const Finished refused = run_program(sessions.folder, words);
  CHECK(refused.code == 2);
  CHECK_THAT(refused.error, HasFacts({"--until", "was extended"}));
  CHECK_FALSE(std::filesystem::exists(again));
  words.insert(words.end(), {"--seed", "8"}); // other draws, which nobody has analysed
  CHECK(run_program(sessions.folder, words).code == 1);
}
