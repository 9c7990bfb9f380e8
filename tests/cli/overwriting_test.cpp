#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A campaign that was run into the folder `path`.
struct RunCampaign {
  Folder folder{};
  std::string path = folder.path() / "r";
  explicit RunCampaign(const Json& json) { (void)run_into(path, campaign_of(json)); }
  [[nodiscard]] Finished program(const std::vector<std::string>& arguments) const {
    return run_program(folder, arguments);
  }
};

/// The quick campaign with a law and rows from tables: dispersions may name files under several keys.
Json campaign_of_tables() {
  Json campaign = quick_campaign(3);
  campaign["dispersions"] = Json::array(
      {{{"name", "measured"},
        {"distribution", {{"type", "empirical"}, {"file", "meas.csv"}, {"column", "x"}}},
        {"to", {"hinges.root.spring.scale"}},
        {"apply", "scale"}},
       {{"name", "rows"},
        {"rows",
         {{"file", "posterior.csv"},
          {"apply", "scale"},
          {"columns", {{"a", "hinges.mid.spring.scale"}, {"b", "hinges.tip.spring.scale"}}}}}}});
  return campaign;
}

} // namespace

TEST_CASE("the file of --out is none that the command reads, by any path and under any key") {
  const Folder folder;
  const std::string meas = folder.write("meas.csv", "x\n1\n1.01\n0.99\n");
  const std::string rows = folder.write("posterior.csv", "a,b\n1,1\n1.01,0.99\n0.99,1.02\n");
  const std::string campaign = folder.write("c.json", campaign_of_tables().dump());
  const std::string link = folder.path() / "link.csv";
  std::filesystem::create_symlink("posterior.csv", link);
  const std::string around = folder.path().string() + "/./posterior.csv";
  REQUIRE(run_program(folder, {"sample", campaign}).code == 0);
  for (const char* command : {"simulate", "sample"})
    for (const std::string& out : {meas, rows, link, around}) {
      CAPTURE(command, out);
      const auto refused = run_program(folder, {command, campaign, "--out", out});
      CHECK(refused.code == 2);
      CHECK(refused.error ==
            "error: --out: found \"" + out +
                "\", which this command reads, expected another file: this one would be lost\n");
    }
  CHECK(read_text(meas) == "x\n1\n1.01\n0.99\n");
  CHECK(read_text(rows) == "a,b\n1,1\n1.01,0.99\n0.99,1.02\n");
  CHECK(run_program(folder, {"sample", campaign, "--out", folder.path() / "new.csv"}).code == 0);
}

TEST_CASE(
    "the file of --out is none of a results folder, whether the command reads the folder or not") {
  const RunCampaign done(quick_campaign(4));
  const std::string scene = three_panel_file(), link = done.folder.path() / "link.csv";
  const std::string campaign = done.folder.write("other.json", quick_campaign(2).dump());
  std::filesystem::create_symlink(done.path + "/runs.csv", link);
  const auto before = contents(done.path);
  for (const std::string& out : {done.path + "/runs.csv", done.path + "/histograms.csv",
                                 done.path + "/broken_runs.csv", link})
    for (const std::vector<std::string>& words :
         std::vector<std::vector<std::string>>{{"simulate", scene},
                                               {"sample", campaign},
                                               {"check", scene, "--draw", out},
                                               {"report", done.path}}) {
      std::vector<std::string> all = words;
      if (words.size() < 4) all.insert(all.end(), {"--out", out});
      CAPTURE(all);
      const auto refused = done.program(all);
      CHECK(refused.code == 2);
      CHECK_THAT(refused.error, Catch::Contains("results folder, expected another file: this one "
                                                "would be lost"));
    }
  CHECK(contents(done.path) == before);
  // other names are free, and so is any name elsewhere
  CHECK(done.program({"simulate", scene, "--out", done.path + "/trajectory.csv"}).code == 0);
  CHECK(done.program({"simulate", scene, "--out", done.folder.path() / "runs.csv"}).code == 0);
}

TEST_CASE("a file of --out by a path that leads nowhere is refused by name") {
  const RunCampaign done(quick_campaign(2));
  const std::string loop = done.folder.path() / "loop", out = loop + "/t.csv";
  std::filesystem::create_symlink("loop",
                                  loop); // as a folder that nobody may enter, for the superuser too
  const auto refused = done.program({"replay", done.path, "--run", "0", "--out", out});
  CHECK(refused.code == 2);
  CHECK(refused.error == "error: " + out +
                             ": found Too many levels of symbolic links, expected a file that can "
                             "be written\n");
  const auto read = done.program({"replay", loop + "/r", "--run", "0"});
  CHECK(read.code == 2);
  CHECK(read.error == "error: " + loop +
                          "/r/campaign.json: found Too many levels of symbolic links, expected a "
                          "path that can be opened\n");
}
