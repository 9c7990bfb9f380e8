#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// The seed scene, with a latch that holds nothing.
std::string spoilt_scene(const Folder& folder) {
  Json scene = parse_json_file(three_panel_file());
  scene["hinges"][1]["latch"]["stiffness"] = 0;
  return folder.write("scene.json", scene.dump());
}

const std::string found = "/hinges/1/latch/stiffness: found 0 N·m/rad, ";
const std::string usual = "> 0: a latch without stiffness does not hold the hinge\n";

} // namespace

TEST_CASE("check, run and simulate warn on standard error, and go on") {
  const Folder folder;
  const std::string scene = spoilt_scene(folder);
  const std::string warning = "warning: " + scene + ": " + found + "usual is " + usual;
  const auto checked = run_program(folder, {"check", scene});
  CHECK((checked.code == 0 && checked.error == warning));
  const auto simulated = run_program(folder, {"simulate", scene, "--json", "--t-end", "8"});
  CHECK((simulated.code == 0 && simulated.error == warning));
  CHECK(parse_json(simulated.out)["status"] == "deployed");
  Json campaign = quick_campaign(5);
  campaign["scene"] = "scene.json";
  const std::string file = folder.write("campaign.json", campaign.dump());
  const auto ran = run_program(folder, {"run", file, "--out", folder.path() / "r"});
  CHECK((ran.code == 0 && ran.error == warning));
  CHECK(std::filesystem::exists(folder.path() / "r" / summary_file));
}

TEST_CASE("with --strict, errors are made of warnings, and nothing is done") {
  const Folder folder;
  const std::string scene = spoilt_scene(folder);
  const std::string error = "error: " + scene + ": " + found + "expected " + usual;
  for (const char* command : {"check", "simulate"}) {
    const auto refused = run_program(folder, {command, scene, "--strict"});
    CHECK((refused.code == 2 && refused.error == error && refused.out.empty()));
  }
  Json campaign = quick_campaign(5);
  campaign["scene"] = "scene.json";
  const std::string file = folder.write("campaign.json", campaign.dump());
  const auto refused = run_program(folder, {"run", file, "--out", folder.path() / "r", "--strict"});
  CHECK((refused.code == 2 && refused.error == error));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "r"));
  const auto fine = run_program(folder, {"check", three_panel_file(), "--strict"});
  CHECK((fine.code == 0 && fine.error.empty()));
}

TEST_CASE("check says where every body is, and how much they weigh") {
  const Folder folder;
  const std::string out = run_program(folder, {"check", three_panel_file()}).out;
  CHECK(out.find("  panel_3                     0.1000      0.5050     90.00      2.5250") !=
        std::string::npos);
  CHECK(out.find("mass of 3 bodies: 30 kg\n") != std::string::npos);
}

TEST_CASE("check names each case whose nominal wing does not deploy, and how it ends") {
  const Folder folder;
  Json campaign = quick_campaign(5);
  campaign["cases"] = parse_json(R"([ { "name": "as_it_is" },
    { "name": "weak", "scale": { "hinges.*.spring.scale": 0.01 } } ])");
  const auto checked = [&](const Json& json) {
    return run_program(folder, {"check", folder.write("campaign.json", json.dump())});
  };
  const Finished weak = checked(campaign);
  CHECK(weak.code == 0);
  CHECK_THAT(weak.error, HasFacts({"note: ", "case weak", "does not deploy", "timed out"}));
  CHECK(weak.error.find("as_it_is") == std::string::npos);
  campaign.erase("cases");
  CHECK(checked(campaign).error.empty());
  campaign["integration"]["t_end"] = 1;
  CHECK_THAT(checked(campaign).error, HasFacts({"note: ", "does not deploy", "timed out"}));
}

TEST_CASE("the pages quote the program's own error") {
  const Folder folder;
  Json scene = parse_json_file(three_panel_file());
  Json& latch = scene["hinges"][0]["latch"];
  latch["stifness"] = 1;
  const std::string file = folder.write("scene.json", scene.dump());
  std::string said = run_program(folder, {"check", file}).error;
  REQUIRE(said.starts_with("error: " + file));
  said.replace(7, file.size(), "scene.json");
  for (const char* page : {"README.md", "montecarlo/README.md"}) {
    CAPTURE(page);
    const std::string text = read_text(std::filesystem::path(source_folder) / page).value();
    CHECK(text.find("    " + said) != std::string::npos); // the whole line
  }
}
