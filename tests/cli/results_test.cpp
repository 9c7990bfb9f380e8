#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <set>
#include <utility>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("merge puts shards together, and says where the files are") {
  const Folder folder;
  const Campaign campaign = campaign_of(quick_campaign(20));
  const std::string a = folder.path() / "a", b = folder.path() / "b", out = folder.path() / "out";
  (void)run_into(a, campaign, {.shard = Shard{1, 2}});
  (void)run_into(b, campaign, {.shard = Shard{2, 2}});
  const auto refused = run_program(folder, {"merge", a, "--out", out});
  CHECK(refused.code == 2);
  CHECK_THAT(refused.error, HasFacts({"runs 10 to 19", "20 runs", "1 command", "--preview",
                                      "\n  wingspread run " + a + "/campaign.json --out " +
                                          folder.path().string() + "/shard_2_of_2 --shard 2/2\n"}));
  std::filesystem::create_directory(folder.path() / "begun");
  std::filesystem::copy_file(a + "/campaign.json", folder.path() / "begun/campaign.json");
  const auto begun = run_program(folder, {"merge", folder.path() / "begun", "--out", out});
  CHECK_THAT(begun.error, HasFacts({"no runs 0 to 9", "2 commands", "--resume"}));
  CHECK_THAT(begun.error, !Catch::Contains("--preview")); // of no runs
  const auto onto_itself = run_program(folder, {"merge", a, b, "--out", a});
  CHECK(onto_itself.code == 2);
  CHECK_THAT(onto_itself.error, HasFacts({"--out", a, "which is read", "another folder"}));
  const auto [code, text, error] = run_program(folder, {"merge", b, a, "--out", out});
  CHECK(code == 0);
  CHECK(error.empty());
  CHECK(lines_of(text).front() == out + "/campaign.json");
  const auto whole = folder.path() / "whole";
  (void)run_into(whole, campaign);
  CHECK(contents(out) == contents(whole));
}

TEST_CASE("analyze leaves an untouched folder as it is, and takes other settings") {
  const DoneCampaign done(full_campaign(30));
  const auto before = contents(done.path);
  const auto [code, out, error] = done.program({"analyze", done.path});
  CHECK(code == 0);
  CHECK(error.empty());
  CHECK(contents(done.path) == before);

  CHECK(done.program({"analyze", done.path, "--quantiles", "0.25,0.75", "--confidence", "0.5",
                      "--bins", "4"})
            .code == 0);
  const Json summary = parse_json_file(done.path / summary_file);
  CHECK(summary["confidence"] == 0.5);
  const Json quantiles = summary["outputs"]["root.latch_time"]["quantiles"];
  REQUIRE(quantiles.size() == 2);
  CHECK(quantiles[1]["p"] == 0.75);
  CHECK(parse_json_file(done.path / histograms_json_file)["root.latch_time"]["counts"].size() == 4);
}

TEST_CASE("analyze prints the path of each file that it writes, and no other") {
  namespace fs = std::filesystem;
  Json cases = full_campaign(30);
  cases["cases"] = parse_json(R"([ { "name": "cold" }, { "name": "hot" } ])");
  for (const auto& [json, option] : std::vector<std::pair<Json, std::string>>{
           {full_campaign(30), ""}, {full_campaign(30), "--no-rows"}, {cases, ""}})
    for (const bool elsewhere : {false, true}) {
      CAPTURE(option, json.contains("cases"), elsewhere);
      const Folder folder;
      const std::string made = folder.path() / "made", late = folder.path() / "late";
      std::vector<std::string> run{"run", folder.write("c.json", json.dump()), "--out", made};
      if (!option.empty()) run.push_back(option);
      REQUIRE(run_program(folder, run).code == 0);
      const auto before = fs::file_time_type::clock::now() - std::chrono::hours(1);
      for (const auto& each : fs::recursive_directory_iterator(folder.path()))
        if (each.is_regular_file()) fs::last_write_time(each.path(), before);
      std::vector<std::string> analyze{"analyze", made};
      if (elsewhere) analyze.insert(analyze.end(), {"--out", late});
      const auto [code, out, error] = run_program(folder, analyze);
      CHECK(code == 0);
      std::set<std::string> printed, written;
      for (const std::string& line : lines_of(out)) printed.insert(line);
      for (const auto& each : fs::recursive_directory_iterator(elsewhere ? late : made))
        if (each.is_regular_file() && each.last_write_time() != before)
          written.insert(each.path().string());
      CHECK(printed == written);
    }
}

TEST_CASE(
    "a folder that has lost its rows keeps its statistics, and is refused by all that read rows") {
  const DoneCampaign done(full_campaign(30));
  std::filesystem::remove(done.path / runs_file);
  const auto before = contents(done.path);
  const std::string page = (done.folder.path() / "page.html").string();
  for (const std::vector<std::string>& words : {std::vector<std::string>{"analyze", done.path},
                                                {"sensitivity", done.path},
                                                {"report", done.path, "--out", page}}) {
    CAPTURE(words[0]);
    const auto [code, out, error] = run_program(done.folder, words);
    CHECK(code == 2);
    CHECK_THAT(error, HasFacts({done.path.string(), "no runs.csv"}));
  }
  CHECK(contents(done.path) == before);
  CHECK_FALSE(std::filesystem::exists(page));
}

TEST_CASE("report shows what analyze was asked for, in place and elsewhere") {
  Json json = quick_campaign(30);
  json["requirements"] =
      parse_json(R"([{ "output": "deployed", "probability": 0.8, "confidence": 0.9 }])");
  const DoneCampaign done(json);
  const auto before = contents(done.path);
  const std::string late = done.folder.write("late.json", R"([
    { "name": "L-1", "output": "deployment_time", "max": 2, "probability": 0.8, "confidence": 0.9 },
    { "name": "L-2", "motorization": "NASA", "probability": 0.8, "confidence": 0.9 } ])");
  const auto shown = [&](const std::filesystem::path& folder) {
    REQUIRE(done.program({"report", folder, "--out", done.folder.path() / "page.html"}).code == 0);
    const Json set = page_data(done.folder.path() / "page.html")["sets"][0];
    std::vector<std::string> facts{std::to_string(set["outputs"][0]["quantiles"].size())};
    for (const Json& each : set["requirements"])
      facts.push_back(each["name"].get<std::string>() + " " + each["verdict"].get<std::string>());
    return facts;
  };
  const std::vector<std::string> own{"3", " passed"}, asked{"2", "L-1 failed", "L-2 passed"};
  CHECK(shown(done.path) == own);
  const std::filesystem::path other = done.folder.path() / "late";
  const std::vector<std::string> options{"--requirements", late, "--quantiles", "0.1,0.9"};
  const auto analyzed = [&](std::vector<std::string> command) {
    command.insert(command.begin(), {"analyze", done.path});
    return done.program(command).code;
  };
  CHECK(done.program({"analyze", done.path, "--requirements", late, "--quantiles", "0.1,0.9",
                      "--out", other})
            .code == 1);
  CHECK(contents(done.path) == before);
  CHECK(shown(other) == asked);
  for (const auto& command : {std::vector<std::string>{"replay", other, "--run", "7"},
                              {"sensitivity", other},
                              {"merge", other, "--out", other / "m"}})
    CHECK(done.program(command).code == 0); // it is a results folder
  CHECK(analyzed(options) == 1);
  CHECK(shown(done.path) == asked);
  CHECK(analyzed({}) == 0);
  CHECK(contents(done.path) == before);
  CHECK(shown(done.path) == own);
}

TEST_CASE("a campaign that stopped is complete, whatever it is judged by afterwards") {
  Json json = quick_campaign(4000);
  json["requirements"] = parse_json(
      R"([{ "name": "D-1", "output": "deployed", "probability": 0.9, "confidence": 0.9 }])");
  json["until"] = parse_json(R"([{ "requirement": "D-1" }])");
  const DoneCampaign done(json);
  const Json before = parse_json_file(done.path / summary_file);
  REQUIRE(before["until"]["stopped"] == true);
  CHECK(before.contains("accuracy")); // as of one that made all its runs
  const std::string late = done.folder.write(
      "late.json",
      R"([{ "name": "L-1", "output": "deployment_time", "max": 2, "probability": 0.8, "confidence": 0.9 }])");
  CHECK(done.program({"analyze", done.path, "--requirements", late, "--confidence", "0.5"}).code ==
        1);
  const Json after = parse_json_file(done.path / summary_file);
  CHECK(after["until"] == before["until"]);
  CHECK_FALSE(after["wingspread"].contains("partial"));
  CHECK(after["requirements"][0]["name"] == "L-1");
}

TEST_CASE("a list with an entry that is empty is refused") {
  const DoneCampaign done(quick_campaign(6));
  for (const char* list : {"0.1,", ",0.1", "0.1,,0.9", ","}) {
    const auto refused = done.program({"analyze", done.path, "--quantiles", list});
    CHECK(refused.code == 2);
    CHECK_THAT(refused.error, HasFacts({"--quantiles", list, "empty"}));
    const auto named = run_program(done.folder, {"modes", three_panel_file(), "--latched", list});
    CHECK(named.code == 2);
    CHECK_THAT(named.error, HasFacts({"--latched", list, "empty"}));
  }
  const auto word = done.program({"analyze", done.path, "--quantiles", "0.1,half"});
  CHECK(word.code == 2);
  CHECK_THAT(word.error, HasFacts({"--quantiles", "\"half\"", "a number"}));
  CHECK(done.program({"analyze", done.path, "--quantiles", "0.1", "0.2,0.3"}).code == 0);
}

TEST_CASE("analyze shows the histograms of every case") {
  const Folder folder;
  Json json = quick_campaign(20);
  json["cases"] = parse_json(
      R"([ { "name": "as_it_is" }, { "name": "weak", "scale": { "hinges.*.spring.scale": 0.9 } } ])");
  const std::string file = folder.write("c.json", json.dump()), out = folder.path() / "r";
  REQUIRE(run_program(folder, {"run", file, "--out", out}).code == 0);
  const std::string all = run_program(folder, {"analyze", out, "--histograms"}).out;
  for (const char* name : {"/as_it_is", "/weak"}) {
    const std::string own = run_program(folder, {"analyze", out + name, "--histograms"}).out;
    CHECK_THAT(own, Catch::Contains("█"));
    CHECK_THAT(all, Catch::Contains(own));
  }
  CHECK_THAT(run_program(folder, {"analyze", out, "--table"}).out, !Catch::Contains("█"));
}

TEST_CASE("analyze counts what stalled with its reason, and takes it for no failure") {
  const DoneCampaign done(quick_campaign(6));
  const StoredCampaign stored = read_stored_campaign(done.path);
  const Results results = read_stored_results(stored).results;
  std::string csv;
  const ResultNames names = RunPlan(stored.campaign).names();
  append_header(csv, names);
  const auto missing_in = [&](ResultRow& row, const char* name) {
    const auto at = std::ranges::find(names.outputs, name) - names.outputs.begin();
    row.outputs.at(static_cast<std::size_t>(at)) = std::nan("");
  };
  for (std::size_t k = 0; k < 6; ++k) {
    ResultRow row = results.row(k);
    if (k % 2 == 0) {
      row.status = Status::stalled, row.reason = "friction holds tip", row.latch_order = "";
      missing_in(row, "deployment_time"), missing_in(row, "tip.latch_time");
    }
    append_row(csv, row);
  }
  std::ofstream(done.path / runs_file, std::ios::binary) << csv;
  const auto [code, out, error] = done.program({"analyze", done.path, "--table"});
  CHECK(code == 0);
  CHECK(error.empty());
  CHECK(out.find("\n  stalled" + std::string(50, ' ') + "3 ") != out.npos);
  CHECK(out.find("\n  stalled          3  friction holds tip\n") != out.npos);
  const Json summary = parse_json_file(done.path / summary_file);
  CHECK(summary["status"]["stalled"]["count"] == 3);
  CHECK(summary["reasons"][0]["reason"] == "friction holds tip");
}

TEST_CASE("analyze refuses settings by their options") {
  const DoneCampaign done(quick_campaign(5));
  const auto before = contents(done.path);
  const auto [code, out, error] = done.program(
      {"analyze", done.path, "--quantiles", "0.5,1.5", "--confidence", "2", "--bins", "few"});
  CHECK(code == 2);
  CHECK(out.empty());
  CHECK_THAT(error, HasFacts({"error: --quantiles: found 1.5", "> 0 and < 1\n",
                              "error: --confidence: found 2.0", "> 0 and < 1\n",
                              "error: --bins: found string \"few\"", "\"auto\"", "1 to 10000\n"}));
  CHECK(contents(done.path) == before);
}

TEST_CASE("replay makes a run again and finds it the same") {
  const DoneCampaign done(full_campaign(12));
  const Results results = read_stored_results(read_stored_campaign(done.path)).results;
  for (std::size_t k = 0; k < 12; ++k) {
    const auto [code, out, error] =
        done.program({"replay", done.path, "--run", std::to_string(k), "--json"});
    CHECK(code == 0);
    CHECK(error.empty());
    const Json json = parse_json(out);
    CHECK(json["status"] == to_string(results.status[k]));
    CHECK(json["run"] == k);
    CHECK(json["same_as_recorded"] == true);
    CHECK(json["draws"]["root_spring"] == results.draws[0].values[k]);
    if (json["latches"].empty()) continue;
    const std::string first = json["latches"][0]["hinge"];
    for (const Column& column : results.outputs)
      if (column.name == first + ".latch_time")
        CHECK(json["latches"][0]["time"] == column.values[k]);
  }
}

TEST_CASE("replay in words, and its trajectory") {
  const DoneCampaign done(quick_campaign(4));
  const auto file = done.folder.path() / "trajectory.csv";
  const auto [code, out, error] = done.program({"replay", done.path, "--run", "2", "--out", file});
  CHECK(code == 0);
  CHECK(error.empty());
  CHECK(out.find("\nRun 2 equals the one in runs.csv, bit for bit.\n") != std::string::npos);
  CHECK(out.find("mass.panel_3") != std::string::npos);
  CHECK(read_text(file).value().starts_with("t,root.angle,root.rate,root.moment,"));
}

TEST_CASE("replay names what differs from the record") {
  const DoneCampaign done(quick_campaign(4));
  const auto file = done.path / runs_file;
  std::string text = read_text(file).value();
  const std::size_t at = text.find("\n2,deployed,") + 12;
  text.replace(at, text.find(',', at) - at, "1.25");
  std::ofstream(file, std::ios::binary) << text;
  const auto [code, out, error] = done.program({"replay", done.path, "--run", "2", "--json"});
  CHECK(code == 3);
  CHECK(parse_json(out)["same_as_recorded"] == false);
  CHECK(error.starts_with("error: run 2, column root_spring: recorded as 1.25, computed as "));
  CHECK(lines_of(error).size() == 1);
}

TEST_CASE("replay of a run that is not there") {
  const Folder folder;
  const std::string path = folder.path() / "r";
  (void)run_into(path, campaign_of(quick_campaign(4)), {.shard = Shard{1, 2}});
  CHECK(run_program(folder, {"replay", path, "--run", "4"}).error ==
        "error: " + path + ": found no run 4, expected a run from 0 to 3\n");
  const auto [code, out, error] = run_program(folder, {"replay", path, "--run", "3"});
  CHECK(code == 0);
  CHECK(out.find("Run 3 is not in runs.csv") != std::string::npos);
  CHECK(parse_json(
            run_program(folder, {"replay", path, "--run", "3", "--json"}).out)["same_as_recorded"]
            .is_null());
}

TEST_CASE("the commands that merge names make what is missing, and then it merges to the whole") {
  const Folder folder;
  Json json = quick_campaign(20);
  json["requirements"] =
      parse_json(R"([{ "output": "deployed", "probability": 0.5, "confidence": 0.5 }])");
  const Campaign campaign = campaign_of(json);
  const auto part = [&](int i) { return (folder.path() / ("part" + std::to_string(i))).string(); };
  const std::string out = folder.path() / "out";
  (void)run_into(part(3), campaign, {.shard = Shard{3, 4}});
  (void)run_into(part(2), campaign, {.shard = Shard{2, 4}});
  const auto rows = read_text(part(2) + "/runs.csv").value(); // cut off within run 7
  std::ofstream(part(2) + "/runs.csv") << rows.substr(0, rows.find("\n7,") + 9);
  const auto refused = run_program(folder, {"merge", part(3), part(2), "--out", out});
  CHECK(refused.code == 2);
  CHECK_THAT(refused.error, Catch::Contains("made by (3 commands)") &&
                                Catch::Contains(" --out " + part(2) + " --shard 2/4 --resume\n") &&
                                Catch::Contains(" --out " + part(1) + " --shard 1/4\n") &&
                                Catch::Contains(" --out " + part(4) + " --shard 4/4\n"));
  const auto preview =
      run_program(folder, {"merge", part(3), part(2), "--out", out, "--preview", "--table"});
  const long there = parse_json_file(out + "/summary.json")["runs"];
  REQUIRE(there < 20);
  const std::string warning = "warning: " + out + " is a PREVIEW: " + std::to_string(there) +
                              " of the campaign's 20 runs; " + std::to_string(20 - there) +
                              " are missing";
  CHECK(preview.code == 1); // it meets no requirement
  CHECK_THAT(preview.error, HasFacts({warning, "\nnot met: a preview has no verdicts\n"}));
  for (const Json& requirement : parse_json_file(out + "/summary.json")["requirements"])
    CHECK(requirement["verdict"] == "undecided");
  CHECK_THAT(preview.out, Catch::Contains(" · PREVIEW: " + std::to_string(there) + " of 20 runs, " +
                                          std::to_string(20 - there) + " missing"));
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"analyze", out}, {"sensitivity", out}, {"report", out}}) {
    CAPTURE(command.front());
    const auto read = run_program(folder, command);
    CHECK_THAT(read.error, Catch::Contains(warning));
    CHECK(read.code == (command.front() == "analyze" ? 1 : 0));
  }
  CHECK_THAT(read_text(out + "/report.html").value(), Catch::Contains("\"partial\":true"));
  for (const int code : run_named(folder, refused.error)) CHECK(code <= 1);
  const auto merged =
      run_program(folder, {"merge", part(1), part(2), part(3), part(4), "--out", out});
  CHECK(merged.code == 0);
  CHECK(merged.error.empty());
  (void)run_into(folder.path() / "whole", campaign);
  CHECK(contents(out) == contents(folder.path() / "whole"));
}
