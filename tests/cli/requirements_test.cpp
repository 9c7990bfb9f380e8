#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

Json requirement(double max) {
  return {{"output", "root.latch_time"}, {"max", max}, {"probability", 0.9}, {"confidence", 0.9}};
}

/// A campaign of 60 runs that requires root to latch in time: all do within 6 s, none within 1 s.
Json requiring(std::initializer_list<double> limits) {
  Json json = quick_campaign(60);
  json["requirements"] = Json::array();
  for (const double max : limits) json["requirements"].push_back(requirement(max));
  return json;
}

/// A folder to run campaigns in and read their results from.
struct RequirementsPlace {
  Folder folder{};
  std::string out = (folder.path() / "r").string();

  [[nodiscard]] Finished operator()(const std::vector<std::string>& arguments) const {
    return run_program(folder, arguments);
  }
  [[nodiscard]] std::string file(const Json& json) const {
    return folder.write("campaign.json", json.dump());
  }
  [[nodiscard]] Json summary() const {
    return parse_json_file(std::filesystem::path(out) / summary_file);
  }
};

} // namespace

TEST_CASE("size answers the table's questions") {
  const RequirementsPlace program;
  const auto size = [&](std::vector<std::string> options) {
    options.insert(options.begin(), "size");
    return program(options);
  };
  const auto wilks = size({"--probability", "0.9973", "--confidence", "0.9", "--order", "2"});
  CHECK((wilks.code == 0 && wilks.error.empty()));
  CHECK_THAT(wilks.out,
             HasFacts({"1440 runs", "0.9973", "confidence 0.9", "1 ", "one-sided", "order 2"}));
  const auto number = [&](std::vector<std::string> options, const char* key) {
    options.emplace_back("--json");
    const auto [code, out, error] = size(options);
    CHECK((code == 0 && error.empty()));
    return parse_json(out)[key];
  };
  CHECK(number({"--probability", ".95", "--confidence", ".95"}, "runs") == 59);
  CHECK(number({"--probability", ".95", "--confidence", ".95", "--failures", "2"}, "runs") == 124);
  CHECK(number({"--probability", ".95", "--confidence", ".95", "--two-sided"}, "runs") == 93);
  CHECK(number({"--probability", ".99", "--confidence", ".9", "--runs", "10000"}, "failures") ==
        86);
  CHECK(number({"--probability", ".99865", "--confidence", ".9", "--runs", "1000"}, "failures")
            .is_null());
  CHECK(number({"--width", ".1", "--confidence", ".95"}, "runs") == 402);
  CHECK(number({"--width", ".01", "--confidence", ".95", "--proportion", ".02"}, "runs") == 3221);
  CHECK_THAT(size({"--probability", ".99865", "--confidence", ".9", "--runs", "1000"}).out,
             HasFacts({"1000 runs cannot show", "0.99865", "confidence 0.9", "1705\n"}));
}

// Two-sided limits of order r leave out 2r − 1 runs, one-sided ones r − 1.
TEST_CASE("size gives back the order that it is asked for, on one side or on both") {
  const RequirementsPlace program;
  for (const bool both : {false, true})
    for (const long order : {1L, 2L, 5L}) {
      std::vector<std::string> words{"size",    "--probability",      "0.95", "--confidence", "0.9",
                                     "--order", std::to_string(order)};
      if (both) words.emplace_back("--two-sided");
      CAPTURE(both, order);
      const std::string text = program(words).out;
      words.emplace_back("--json");
      const Json json = parse_json(program(words).out);
      CHECK(json["order"] == order);
      CHECK(json["two_sided"] == both);
      CHECK(json["failures"] == (both ? 2 * order : order) - 1);
      CHECK_THAT(text,
                 HasFacts({std::to_string(json["runs"].get<long>()) + " runs",
                           both ? "two-sided" : "one-sided", "order " + std::to_string(order)}));
    }
}

TEST_CASE("size refuses what it cannot answer") {
  struct Case {
    std::vector<std::string> options;
    const char* error;
  };
  const RequirementsPlace program;
  for (auto& [options, error] : std::vector<Case>{
           {{"--confidence", ".9"}, "found neither --probability nor --width, expected one"},
           {{"--probability", ".9"}, "--confidence is required"},
           {{"--probability", "1", "--confidence", ".9"},
            "found 1, expected a number, > 0 and < 1"},
           {{"--probability", ".9", "--confidence", "nan"}, "found nan, expected a number"},
           {{"--probability", ".9", "--confidence", ".9", "--order", "0"}, "--order: "},
           {{"--probability", ".9", "--confidence", ".9", "--width", ".1"}, "excludes"},
           {{"--width", ".1", "--confidence", ".9", "--proportion", "2"}, "from 0 to 1"},
           {{"--probability", "0.999999999999999", "--confidence", ".9"},
            "found more than 1000000000000 runs"}}) {
    options.insert(options.begin(), "size");
    const Finished finished = program(options);
    CHECK(finished.code == 2);
    CHECK(finished.out.empty());
    CHECK_THAT(finished.error, Catch::StartsWith("error: ") && Catch::Contains(error));
  }
}

TEST_CASE("a requirement that is met, one that is not, and one that cannot be decided") {
  const RequirementsPlace program;
  CHECK(program({"run", program.file(requiring({6})), "--out", program.out}).code == 0);
  CHECK(program.summary()["requirements"][0]["verdict"] == "pass");

  const auto failed =
      program({"run", program.file(requiring({6, 1})), "--out", program.out + "2", "--table"});
  CHECK(failed.code == 1);
  CHECK_THAT(failed.error,
             HasFacts({"not met: root.latch_time ≤ 1 s, 90 % at 90 %", "fail", "60 of 60", "2"}));
  CHECK_THAT(failed.out, Catch::Contains("REQUIREMENT") &&
                             Catch::Contains("    wingspread replay " + program.out + "2 --run "));

  const auto undecided =
      program({"run", program.file(requiring({6})), "--out", program.out + "3", "--runs", "20"});
  CHECK(undecided.code == 1);
  CHECK_THAT(undecided.error, HasFacts({"undecided", "20 runs cannot show", "22"}));
}

TEST_CASE("the run that a verdict names can be replayed as it says") {
  const RequirementsPlace program;
  CHECK(program({"run", program.file(requiring({1})), "--out", program.out}).code == 1);
  const Json worst = program.summary()["requirements"][0]["broken"][0];
  const auto replay = program({"replay", program.out, "--run", worst.dump(), "--json"});
  CHECK(replay.code == 0);
  CHECK(parse_json(replay.out)["same_as_recorded"] == true);
}

TEST_CASE("runs that stall count against a requirement that their values keep to") {
  const RequirementsPlace program;
  Json json = requiring({});
  for (Json& hinge : json["scene"]["hinges"])
    hinge["friction"] = {{"model", "exact"}, {"coulomb", 2.5}, {"static", 3}};
  json["outputs"] = {"peak_moment"};
  json["requirements"].push_back(
      {{"output", "root.peak_moment"}, {"max", 1e9}, {"probability", 0.9}, {"confidence", 0.9}});
  CHECK(program({"run", program.file(json), "--out", program.out}).code == 1);
  const Json verdict = program.summary()["requirements"][0];
  CHECK(program.summary()["outputs"]["root.peak_moment"]["count"] == 60); // they have values
  CHECK(verdict["failures"]["seen"] == 60);
  CHECK(verdict["guaranteed"]["value"].is_null());
}

TEST_CASE("analyze judges again, by the campaign's requirements or by others") {
  const RequirementsPlace program;
  CHECK(program({"run", program.file(requiring({6})), "--out", program.out}).code == 0);
  const auto before = contents(program.out);
  CHECK(program({"analyze", program.out}).code == 0);
  CHECK(contents(program.out) == before);
  const std::string other = program.folder.write("q.json", Json{requirement(1)}.dump());
  CHECK(program({"analyze", program.out, "--requirements", other}).code == 1);
  CHECK(program.summary()["requirements"][0]["max"] == 1.0);
  const std::string bad = program.folder.write("q.json", Json{requirement(1), 3}.dump());
  const auto refused = program({"analyze", program.out, "--requirements", bad});
  CHECK(refused.code == 2);
  CHECK(refused.error == "error: " + bad + ": /1: found 3, expected a requirement: an object\n");
}

TEST_CASE("analyze takes the runs of another tool, with a campaign beside them") {
  const RequirementsPlace program;
  std::filesystem::create_directory(program.out);
  const std::filesystem::path there = program.out;
  Json json = requiring({6});
  json["outputs"] = {"latch_time"};
  json["dispersions"] = Json::array();
  json["sampling"]["runs"] = 30;
  std::ofstream(there / campaign_file) << json.dump();
  std::string csv = "run,root.latch_time,mid.latch_time,tip.latch_time,deployment_time,latch_order,"
                    "status";
  for (int run = 0; run < 30; ++run) {
    csv += '\n';
    csv += std::to_string(run);
    csv += run == 7 ? ",,,,,,stalled" : ",5,6,7,7,root>mid>tip,deployed";
  }
  std::ofstream(there / runs_file) << csv; // without a last line feed
  CHECK(program({"analyze", program.out}).code == 1);
  const Json verdict = program.summary()["requirements"][0];
  CHECK(verdict["runs"] == 30);
  CHECK(verdict["broken"] == Json::parse("[7]"));
  CHECK(verdict["verdict"] == "fail");
  std::string contradictory = csv;
  contradictory.replace(csv.find("5,6,7,7,root"), 1, "");
  std::ofstream(there / runs_file) << contradictory;
  const auto contradicted = program({"analyze", program.out});
  CHECK(contradicted.code == 2);
  CHECK(contradicted.error ==
        "error: " + (there / runs_file).string() +
            ": line 2, column 'root.latch_time': found nothing in a deployed "
            "run, expected a time: every latch of a deployed run is engaged\n");
  std::ofstream(there / runs_file) << csv.substr(0, csv.rfind('\n'));
  const auto refused = program({"analyze", program.out});
  CHECK(refused.code == 2);
  CHECK_THAT(refused.error,
             HasFacts({"error: " + (there / runs_file).string() + ": found 29 runs", "30"}));
}

TEST_CASE("a shard is not held to requirements, and what is merged of them is") {
  const RequirementsPlace program;
  const std::string campaign = program.file(requiring({1}));
  const std::string a = program.folder.path() / "a", b = program.folder.path() / "b";
  CHECK(program({"run", campaign, "--out", a, "--shard", "1/2"}).code == 0);
  CHECK(program({"run", campaign, "--out", b, "--shard", "2/2"}).code == 0);
  const Json alone = parse_json_file(a + "/summary.json")["requirements"][0];
  CHECK(alone["verdict"] == "undecided");
  CHECK_THAT(alone["evidence"].get<std::string>(), Catch::StartsWith("not judged: "));
  CHECK(alone["margin"].is_null());
  CHECK(alone["failures"]["seen"] > 0);
  CHECK(program({"merge", a, b, "--out", program.out}).code == 1);
  CHECK(program({"run", campaign, "--out", program.out + "2"}).code == 1);
  CHECK(contents(program.out) == contents(program.out + "2"));
}

TEST_CASE("runs that fail numerically come before a requirement that is not met") {
  const RequirementsPlace program;
  Json json = requiring({1});
  json["integration"]["max_steps"] = 10;
  const auto finished = program({"run", program.file(json), "--out", program.out});
  CHECK(finished.code == 3);
  CHECK_THAT(finished.error,
             Catch::StartsWith("not met: ") && Catch::Contains("\nerror: 60 of 60"));
}

TEST_CASE("a bad requirement is refused with its place, and nothing is written") {
  const RequirementsPlace program;
  Json json = requiring({6, 7});
  json["requirements"][1]["probability"] = 1.5;
  const std::string campaign = program.file(json);
  const auto [code, out, error] = program({"run", campaign, "--out", program.out});
  CHECK(code == 2);
  CHECK(error == "error: " + campaign +
                     ": /requirements/1/probability: found 1.5, expected a number, > 0 and < 1\n");
  CHECK_FALSE(std::filesystem::exists(program.out));
}

TEST_CASE("run --until stops at a checkpoint, the same when it was interrupted", "[parallel]") {
  const RequirementsPlace program;
  Json json = quick_campaign(2000);
  json["outputs"] = {"latch_time"};
  const std::string campaign = program.file(json);
  const std::vector<std::string> until{"--until", "root.latch_time@0.5 2%", "--until",
                                       "stalled 0.01"};
  const auto run = [&](const std::string& out, std::vector<std::string> options) {
    options.insert(options.begin(), {"run", campaign, "--out", out});
    options.insert(options.end(), until.begin(), until.end());
    return program(options);
  };
  const auto finished = run(program.out, {"--threads", "2", "--table"});
  CHECK((finished.code == 0 && finished.error.empty()));
  CHECK_THAT(
      finished.out,
      Catch::StartsWith("three_panel · 1000 runs · random, seed 7 · stopped, of at most 2000\n") &&
          Catch::Contains("root.latch_time@0.5 2%"));
  CHECK(program.summary()["runs"] == 1000);
  // Left in the middle, as by a crash.
  const std::filesystem::path left = program.out + "2", whole = program.out;
  std::filesystem::create_directory(left);
  std::filesystem::copy_file(whole / campaign_file, left / campaign_file);
  const std::string runs = read_text(whole / runs_file).value();
  std::ofstream(left / runs_file, std::ios::binary) << runs.substr(0, runs.size() / 2);
  CHECK(run(left.string(), {"--threads", "2", "--resume"}).code == 0);
  CHECK(contents(left) == contents(whole));
  CHECK(program({"analyze", program.out}).code == 0);
  CHECK(contents(left) == contents(whole));
}

TEST_CASE("run --until refuses what cannot be reached for, by its option") {
  const RequirementsPlace program;
  const std::string campaign = program.file(quick_campaign(20));
  const auto refusal = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"run", campaign, "--out", program.out});
    const Finished finished = program(options);
    CHECK(finished.code == 2);
    CHECK_FALSE(std::filesystem::exists(program.out));
    return finished.error;
  };
  CHECK(refusal({"--until", "root.latch_tim@0.5 1"}) ==
        "error: --until: found string \"root.latch_tim\", expected an output of the campaign, or a "
        "status (did you mean \"root.latch_time\"?)\n");
  CHECK_THAT(
      refusal({"--until", "root.latch_time 2%"}),
      HasFacts({"error: --until: found nothing, expected a number, > 0 and < 1: the quantile"}));
  CHECK_THAT(refusal({"--until", "root.latch_time@0.5 3 deg"}),
             HasFacts({"error: --until: found string \"3 deg\", expected a number, s, > 0",
                       "\"s\", \"ms\", \"min\" or \"h\""}));
  CHECK_THAT(refusal({"--until", "soon"}),
             Catch::StartsWith("error: --until: found \"soon\", expected e.g. "));
  CHECK_THAT(refusal({"--until", "deployed 0.1", "--shard", "1/2"}),
             HasFacts({"error: found shard 1/2 of a campaign that may stop early"}));
}

TEST_CASE(
    "run makes runs until a requirement is decided, and says what to do of one that is open") {
  const RequirementsPlace program;
  Json json = quick_campaign(1200);
  json["outputs"] = {"latch_time"};
  json["integration"]["t_end"] = 7; // some do not come to it
  json["requirements"] = parse_json(
      R"([{ "name": "D-1", "output": "deployed", "probability": 0.02, "confidence": 0.9 },
          { "name": "D-2", "output": "deployed", "probability": 0.9999, "confidence": 0.9 }])");
  const std::string campaign = program.file(json);
  const auto decided =
      program({"run", campaign, "--out", program.out, "--until", "requirement D-1", "--table"});
  CHECK(decided.code == 1);
  CHECK_THAT(decided.out, Catch::Contains("· 1000 runs ·") &&
                              Catch::Contains("stopped, of at most 1200") &&
                              Catch::Contains("requirement D-1"));
  CHECK_THAT(decided.error, !Catch::Contains("note: "));
  const auto unknown =
      program({"run", campaign, "--out", program.out + "2", "--until", "requirement D-3"});
  CHECK(unknown.code == 2);
  CHECK_THAT(unknown.error,
             HasFacts({"error: --until: found string \"D-3\"", "did you mean \"D-1\"?"}));
  // 13 of 20 runs deploy, which does not decide the requirement
  json["requirements"][1]["probability"] = 0.65;
  const std::string close = program.file(json);
  const auto open = program({"run", close, "--out", program.out + "3", "--runs", "20"});
  CHECK(open.code == 1);
  CHECK_THAT(open.error, HasFacts({"7 of 20 runs", "3", "\nnote: ", "--seed", "adds a risk",
                                   "--resume --runs"}));
  const auto fixed = program({"run", close, "--out", program.out + "4", "--runs", "20", "--until",
                              "deployed 0.9"}); // whose analyses are fixed: none can be added
  CHECK_THAT(fixed.error, Catch::Contains("adds a risk") && !Catch::Contains("--resume --runs"));
  const auto longer =
      program({"run", close, "--out", program.out + "3", "--runs", "40", "--resume", "--table"});
  CHECK_THAT(longer.out,
             Catch::Contains("· 40 runs ·") && Catch::Contains("· interim analysis 2, after 20"));
}

TEST_CASE("what holds for independent draws is refused with Sobol' points, by its place") {
  const RequirementsPlace program;
  Json json = quick_campaign(64);
  json["sampling"].update({{"design", "sobol"}, {"replicates", 4}});
  json["correlations"] =
      parse_json(R"([{ "between": ["root_spring", "mass.panel_2"], "spearman": 0.5 }])");
  const std::string plain = program.file(json);
  const std::string reason = " with the design \"sobol\", expected the design \"random\": these "
                             "statistics hold for independent draws only\n";
  const auto until = program({"run", plain, "--out", program.out, "--until", "stalled 0.1"});
  CHECK(until.code == 2);
  CHECK(until.error == "error: --until: found goals to stop at" + reason);
  CHECK_FALSE(std::filesystem::exists(program.out));

  CHECK(program({"run", plain, "--out", program.out}).code == 0);
  const auto before = contents(program.out);
  const std::string other = program.folder.write("q.json", Json{requirement(6)}.dump());
  const auto judged = program({"analyze", program.out, "--requirements", other});
  CHECK(judged.code == 2);
  CHECK(judged.error == "error: " + other + ": found requirements" + reason);
  CHECK(program({"analyze", program.out}).code == 0);
  CHECK(contents(program.out) == before);
  CHECK(program({"replay", program.out, "--run", "33"}).code == 0);

  json["requirements"] = Json{requirement(6)};
  const std::string required = program.file(json);
  const auto refused = program({"run", required, "--out", program.out + "2"});
  CHECK(refused.code == 2);
  CHECK(refused.error == "error: " + required + ": /requirements: found requirements" + reason);
  CHECK_FALSE(std::filesystem::exists(program.out + "2"));
}

TEST_CASE("analyze says that runs are missing, and that rows with gaps look selected") {
  const RequirementsPlace run;
  REQUIRE(run({"run", run.file(requiring({6})), "--out", run.out}).code == 0);
  const std::filesystem::path rows = std::filesystem::path(run.out) / "runs.csv";
  const std::string whole = read_text(rows).value();
  CHECK(run({"analyze", run.out}).error.empty());
  const std::size_t last = whole.rfind("\n59,") + 1, middle = whole.find("\n30,") + 1;
  REQUIRE((last > middle && middle > 1));
  write_file(rows, whole.substr(0, last));
  const auto part =
      run({"analyze", run.out}); // perhaps the last run is missing because of what it does
  CHECK_THAT(part.error,
             Catch::Contains("incomplete: 59 of 60 runs; requirements are not judged") &&
                 Catch::Contains("not judged: a part of the campaign's runs"));
  CHECK(part.code == 1);
  write_file(rows, whole.substr(0, middle) + whole.substr(whole.find('\n', middle) + 1));
  CHECK_THAT(run({"analyze", run.out}).error,
             Catch::Contains("warning: 59 of 60 runs, with gaps that no interruption leaves"));
}
