// Which sets a page has: folders, cases of folders, and none of them twice.
#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a folder beside one of its cases is refused, and each set has its campaign's folder",
          "[report][cases]") {
  const Folder folder;
  Json json = quick_campaign(3);
  json["cases"] = parse_json(R"([ { "name": "cold" }, { "name": "hot" } ])");
  const std::string path = folder.path() / "r", copy = folder.path() / "copy", hot = path + "/hot/",
                    page = folder.path() / "p", file = folder.write("c.json", json.dump());
  REQUIRE(run_program(folder, {"run", file, "--out", path}).code == 0);
  std::filesystem::copy(path, copy, std::filesystem::copy_options::recursive);
  for (const auto& [first, second] : {std::pair(path, hot), std::pair(hot, path)}) {
    const Finished refused = run_program(folder, {"report", first, second, "--out", page});
    CHECK(refused.code == 2);
    CHECK_THAT(refused.error, HasFacts({"error: " + second + ": ", "hot", first, "once"}));
    CHECK_FALSE(std::filesystem::exists(page));
  }
  const auto folders_of = [&](const std::string& first, const std::string& second) {
    CHECK(run_program(folder, {"report", first, second, "--out", page}).code == 0);
    std::vector<int> numbers;
    const Json data = page_data(page);
    for (const Json& set : data["sets"]) numbers.push_back(set["campaign_folder"]);
    return numbers;
  };
  CHECK(folders_of(hot, path + "/hot/../cold") == std::vector{0, 0});
  CHECK(folders_of(copy, hot) == std::vector{0, 0, 1});
  CHECK(folders_of(copy + "/hot", hot) == std::vector{0, 1});
  CHECK(page_data(page)["sets"][1]["label"] == path + "/hot"); // without the slash
  folder.write("r/campaign.json", "{ \"cases\": [");           // of no folder that is named
  CHECK(run_program(folder, {"report", hot, "--out", page}).code == 0);
}

TEST_CASE("an unfinished folder leaves the verdicts of others, and the warning names it",
          "[report]") {
  const Folder folder;
  Json json = quick_campaign(40);
  json["requirements"] =
      parse_json(R"([ { "output": "deployed", "probability": 0.5, "confidence": 0.5 } ])");
  const auto whole = folder.path() / "whole", part = folder.path() / "part",
             page = folder.path() / "p.html";
  (void)run_into(whole, campaign_of(json));
  (void)run_into(part, campaign_of(json), {.stop_after = 12});
  const Finished done = run_program(folder, {"report", part, whole, "--out", page});
  CHECK(done.code == 0);
  CHECK_THAT(done.error,
             HasFacts({"incomplete: ", " of 40 runs of part; ", "of part are not judged"}));
  const Json sets = page_data(page)["sets"];
  CHECK(sets[0]["requirements"][0]["verdict"] == "open");
  CHECK(sets[1]["requirements"][0]["verdict"] == "passed");
}
