#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

std::vector<double> frequencies_of(const Folder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "modes");
  arguments.emplace_back("--json");
  const Finished finished = run_program(folder, arguments);
  CHECK(finished.code == 0);
  CHECK(finished.error.empty());
  std::vector<double> frequencies;
  const Json json = parse_json(finished.out);
  for (const Json& mode : json["modes"]) frequencies.push_back(mode["frequency"].get<double>());
  return frequencies;
}

} // namespace

TEST_CASE("modes counts the hinges that are named as latched, and no others") {
  const Folder folder;
  const std::string scene = three_panel_file();
  const auto all = frequencies_of(folder, {scene});
  REQUIRE(all.size() == 3);
  CHECK(frequencies_of(folder, {scene, "--latched", "root", "mid", "tip"}) == all);
  CHECK(frequencies_of(folder, {scene, "--latched", "root", "mid"}) != all);
  CHECK(frequencies_of(folder, {scene, "--latched", "tip"}) !=
        frequencies_of(folder, {scene, "--latched", "root"}));
}

TEST_CASE("modes refuses every name that is no latched hinge's, with the names that are") {
  const Folder folder;
  Json json = parse_json(read_text(three_panel_file()).value());
  json["hinges"][1].erase("latch");
  const std::string scene = folder.write("scene.json", json.dump());
  const Finished refused = run_program(folder, {"modes", scene, "--latched", "mid", "root", "tap"});
  CHECK(refused.code == 2);
  CHECK(refused.out.empty());
  CHECK_THAT(refused.error,
             HasFacts({"--latched", "\"mid\"", "a latch", "\"tap\"", "did you mean \"tip\"?"}));
  CHECK_THAT(refused.error, !Catch::Contains("\"root\", expected"));
}
