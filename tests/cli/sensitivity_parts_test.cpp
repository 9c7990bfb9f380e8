// `sensitivity` of folders that have a part of the runs, and options that it does not use.
#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("sensitivity of a shard or of an interrupted folder says so") {
  const Folder folder;
  const Campaign campaign = campaign_of(quick_campaign(40));
  const std::string shard = folder.path() / "shard", cut = folder.path() / "cut";
  (void)run_into(shard, campaign, {.shard = Shard{1, 2}});
  CHECK_THAT(run_program(folder, {"sensitivity", shard}).out,
             Catch::StartsWith("three_panel · 20 runs · shard 1/2 · rank correlations\n"));
  CHECK(parse_json_file(shard + "/sensitivity.json")["wingspread"]["shard"] ==
        Json{{"index", 1}, {"of", 2}});
  (void)run_into(cut, campaign);
  const std::string rows = *read_text(cut + "/runs.csv");
  std::size_t end = 0;
  for (int line = 0; line <= 10; ++line) end = rows.find('\n', end) + 1;
  std::filesystem::resize_file(cut + "/runs.csv", end);
  CHECK_THAT(
      run_program(folder, {"sensitivity", cut}).out,
      Catch::StartsWith("three_panel · 10 runs · partial, of 40 runs · rank correlations\n"));
  CHECK(parse_json_file(cut + "/sensitivity.json")["wingspread"]["partial"] ==
        Json{{"done", 10}, {"of", 40}});
}

TEST_CASE("sensitivity names the case, of a folder and of a campaign") {
  const Folder folder;
  Json json = quick_campaign(8);
  json.erase("correlations");
  json["cases"] = parse_json(R"([ { "name": "light" }, { "name": "heavy" } ])");
  const std::string file = folder.write("c.json", json.dump()), out = folder.path() / "r";
  (void)run_program(folder, {"run", file, "--out", out});
  CHECK_THAT(run_program(folder, {"sensitivity", out, "--case", "heavy"}).out,
             Catch::StartsWith("three_panel · heavy · 8 runs"));
  CHECK_THAT(run_program(folder, {"sensitivity", file, "--case", "heavy", "--samples", "4"}).out,
             Catch::StartsWith("three_panel · heavy · 4 samples"));
}

TEST_CASE("merge of a design's shards prints a table where one is asked for, before its warnings") {
  const Folder folder;
  Json json = quick_campaign(8);
  json.erase("correlations");
  const std::string file = folder.write("c.json", json.dump());
  std::vector<std::string> words{"merge"};
  for (const char* part : {"1", "2"}) {
    words.push_back(folder.path() / part);
    REQUIRE(run_program(folder, {"sensitivity", file, "--samples", "4", "--shard",
                                 std::string(part) + "/2", "--out", words.back()})
                .code == 0);
  }
  const auto merged = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> all = words;
    all.insert(all.end(), {"--out", folder.path() / out});
    all.insert(all.end(), more.begin(), more.end());
    return run_program(folder, all);
  };
  const auto paths = lines_of(merged("files", {}).out);
  CHECK(paths.size() == 4);
  for (const std::string& path : paths) CHECK(std::filesystem::exists(path));
  const std::string table = merged("table", {"--table"}).out, all = merged("all", {"--all"}).out;
  CHECK_THAT(table, HasFacts({"4 samples"}));
  CHECK(all.size() > table.size());
}

TEST_CASE("sensitivity of runs that all failed has exit code 3, as analyze has") {
  const Folder folder;
  Json json = quick_campaign(4);
  json["integration"]["max_steps"] = 3;
  const std::string path = folder.path() / "r";
  (void)run_into(path, campaign_of(json));
  CHECK(run_program(folder, {"analyze", path}).code == 3);
  CHECK(run_program(folder, {"sensitivity", path}).code == 3);
}

TEST_CASE("sensitivity refuses options that would change nothing") {
  const Folder folder;
  const std::string results = folder.path() / "r", design = folder.path() / "d";
  (void)run_into(results, campaign_of(quick_campaign(8)));
  Json json = quick_campaign(8);
  json.erase("correlations");
  const std::string file = folder.write("c.json", json.dump());
  REQUIRE(run_program(folder, {"sensitivity", file, "--samples", "4", "--out", design}).code == 0);
  const auto refused = [&](const std::vector<std::string>& words) {
    const Finished done = run_program(folder, words);
    CHECK(done.code == 2);
    return done.error;
  };
  CHECK_THAT(refused({"sensitivity", results, "--resamples", "50"}),
             Catch::StartsWith("error: --resamples: found "));
  CHECK_THAT(refused({"sensitivity", design, "--case", "cold"}),
             Catch::Contains("--case: found \"cold\", with a design's folder"));
  CHECK_THAT(refused({"sensitivity", file, "--samples", "4", "--resume"}),
             Catch::Contains("--resume: found --resume without --out"));
}
