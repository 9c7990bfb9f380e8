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
