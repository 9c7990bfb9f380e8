#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A campaign's file, and results folders beside it.
struct Setting {
  Folder folder{};
  std::string campaign{};

  explicit Setting(const Json& json) : campaign(folder.write("campaign.json", json.dump())) {}

  [[nodiscard]] std::string at(const char* name) const { return (folder.path() / name).string(); }
  [[nodiscard]] Finished run(const char* to, std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {"run", campaign, "--out", at(to)});
    return run_program(folder, options);
  }
  [[nodiscard]] Json summary(const char* name) const {
    return parse_json_file(folder.path() / name / summary_file);
  }
};

Json latch_campaign(int runs) {
  Json json = quick_campaign(runs);
  json["outputs"] = {"latch_time"};
  return json;
}

} // namespace

TEST_CASE("a campaign says what its integration contributes") {
  const Setting setting(latch_campaign(60));
  const auto [code, out, error] = setting.run("r", {"--table"});
  CHECK(code == 0);
  CHECK(error.empty());
  const Json summary = setting.summary("r");
  const Json& accuracy = summary["accuracy"];
  CHECK(accuracy["runs"] == 6);
  CHECK(accuracy["method"] == "auto");
  CHECK(accuracy["rtol"] == 1e-6);
  CHECK(accuracy["reference_method"] == "dopri5");
  CHECK(accuracy["reference_rtol"] == 1e-8);
  CHECK(accuracy["beyond_largest"] ==
        Json{{"runs", 0}, {"share_at_most", accuracy["beyond_largest"]["share_at_most"]}});
  CHECK(accuracy["beyond_largest"]["share_at_most"].get<double>() ==
        Approx(1 - std::pow(0.05, 1 / 6.)).epsilon(1e-12));
  CHECK(accuracy["moved"]["runs"] == 0);
  CHECK(accuracy["order_in_doubt"] == 0);
  CHECK(accuracy["outputs"].size() == summary["outputs"].size());
  for (const Json& each : accuracy["outputs"]) {
    CHECK(each["standard_error"] == summary["outputs"][each["output"]]["mean_error"]);
    CHECK(each["rms"] <= each["largest"]);
    if (each["output"] == "tip.latch_time") CHECK((each["rms"] > 1e-12 && each["largest"] < 1e-6));
  }
  CHECK_THAT(out, HasFacts({"\nACCURACY  integration errors ≤ ",
                            "% of a standard error in ≥ 60.6 % of runs "}));
  CHECK(parse_json_file(setting.folder.path() / "r" / timing_file)["accuracy"]["runs"] == 6);
}

TEST_CASE("how many runs are made again can be set, and switched off") {
  Json json = latch_campaign(60);
  json["statistics"]["accuracy_runs"] = 3;
  const Setting few(json);
  CHECK(few.run("r").code == 0);
  CHECK(few.summary("r")["accuracy"]["runs"] == 3);
  json["statistics"]["accuracy_runs"] = 0;
  const Setting off(json);
  const auto [code, out, error] = off.run("off", {"--table"});
  CHECK(code == 0);
  CHECK_FALSE(off.summary("off").contains("accuracy"));
  CHECK(out.find("ACCURACY") == std::string::npos);
  json["statistics"]["accuracy_runs"] = -1;
  const Setting wrong(json);
  const auto refused = wrong.run("wrong");
  CHECK(refused.code == 2);
  CHECK(refused.error == "error: " + wrong.campaign +
                             ": /statistics/accuracy_runs: found -1, expected an integer from 0 "
                             "(none) to 10000\n");
}

TEST_CASE("a campaign of rattling wings says in how many runs an output moves by more than 1 %") {
  Json json = latch_campaign(20);
  json["scene"] = parse_json_file(three_panel_file());
  for (Json& hinge : json["scene"]["hinges"])
    hinge["latch"] = {{"stiffness", 1e7}, {"damping", 1}, {"backlash", 0.004}};
  json["outputs"] = {"latch_rate"};
  json["integration"] = {{"rtol", 1e-8}, {"atol", 1e-10}, {"t_end", 12}};
  json["statistics"]["accuracy_runs"] = 5;
  const Setting setting(json);
  const auto [code, out, error] = setting.run("r", {"--table"});
  const Json accuracy = setting.summary("r")["accuracy"];
  const long moved = accuracy["moved"]["runs"], doubt = accuracy["order_in_doubt"];
  REQUIRE(moved > 0);
  CHECK(accuracy["moved"]["which"].size() == static_cast<std::size_t>(moved));
  CHECK(accuracy["moved"]["share_at_most"] > static_cast<double>(moved + doubt) / 5);
  CHECK_THAT(out, HasFacts({"ACCURACY  integration errors", "by more than 1 %", "WARNING",
                            fmt::format("in {} of the 5 runs", moved)}));
}

TEST_CASE("accuracy is of all runs: of no shard, no part, and no rows of another tool",
          "[parallel]") {
  const Setting setting(latch_campaign(80));
  CHECK(setting.run("whole", {"--threads", "1"}).code == 0);
  CHECK(setting.run("one", {"--shard", "1/2"}).code == 0);
  CHECK(setting.run("two", {"--shard", "2/2", "--threads", "2"}).code == 0);
  CHECK_FALSE(setting.summary("one").contains("accuracy"));
  const Finished merged = run_program(
      setting.folder, {"merge", setting.at("two"), setting.at("one"), "--out", setting.at("both")});
  CHECK(merged.code == 0);
  CHECK(contents(setting.at("both")) == contents(setting.at("whole")));
  const auto before = contents(setting.at("whole"));
  CHECK(run_program(setting.folder, {"analyze", setting.at("whole")}).code == 0);
  CHECK(contents(setting.at("whole")) == before);
  Json unstamped = parse_json_file(setting.folder.path() / "whole" / campaign_file);
  unstamped.erase(stamp_key);
  std::filesystem::create_directory(setting.at("foreign"));
  (void)setting.folder.write("foreign/campaign.json", unstamped.dump());
  std::filesystem::copy(setting.folder.path() / "whole" / runs_file,
                        setting.folder.path() / "foreign" / runs_file);
  CHECK(run_program(setting.folder, {"analyze", setting.at("foreign")}).code == 0);
  CHECK_FALSE(setting.summary("foreign").contains("accuracy"));
}

TEST_CASE("a campaign that leaves its tolerance open is told to write a number") {
  Json json = latch_campaign(80);
  json["integration"]["rtol"] = "auto";
  const Setting setting(json);
  const Finished refused = setting.run("r");
  CHECK(refused.code == 2);
  CHECK(refused.error.find("/integration/rtol: found string \"auto\"") != std::string::npos);
  CHECK(refused.error.find("for example 1e-8") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(setting.at("r")));
}
