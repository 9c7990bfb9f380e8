#include "montecarlo/analyses/sensitivity/design_folder.hpp"
#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace wingspread;
using namespace wingspread::test;

namespace {

std::string file_with(const Folder& folder, const Json& json) {
  const std::string path = folder.path() / "campaign.json";
  std::ofstream(path) << json.dump();
  return path;
}

} // namespace

TEST_CASE("sensitivity of a results folder: a table, two files, and JSON") {
  const Folder folder;
  const std::string path = folder.path() / "r";
  (void)run_into(path, campaign_of(full_campaign(60)));
  const auto [code, out, error] = run_program(folder, {"sensitivity", path});
  CHECK(code == 0);
  CHECK(out.starts_with("three_panel · 60 runs · rank correlations\n"));
  const std::string all = run_program(folder, {"sensitivity", path, "--all"}).out;
  CHECK(all.find(" without a value") != std::string::npos); // invalid draws have no outputs
  const std::string written = *read_text(path + "/sensitivity.json");
  CHECK(run_program(folder, {"sensitivity", path, "--json"}).out == written);
  CHECK(parse_json(written)["wingspread"]["hash"] ==
        parse_json_file(path + "/summary.json")["wingspread"]["hash"]);
  CHECK(std::filesystem::exists(path + "/sensitivity.csv"));
  const Json other =
      parse_json(run_program(folder, {"sensitivity", path, "--json", "--confidence", "0.5"}).out);
  CHECK(other["confidence"] == 0.5);
  const auto refused = run_program(folder, {"sensitivity", path, "--samples", "8", "--resume"});
  CHECK(refused.code == 2);
  CHECK(lines_of(refused.error).size() == 2);
  using Option = std::vector<std::string>;
  for (const Option& option :
       {Option{"--samples", "8"}, {"--seed", "3"}, {"--resume"}, {"--shard", "1/2"}}) {
    std::vector<std::string> words{"sensitivity", path};
    words.insert(words.end(), option.begin(), option.end());
    const auto done = run_program(folder, words);
    CHECK(done.code == 2);
    CHECK_THAT(done.error, Catch::StartsWith("error: " + option[0] + ": found "));
  }
}

TEST_CASE(
    "sensitivity of a results folder names the draws that are rows of one file, and no others") {
  const Folder folder;
  std::string posterior = "a,b\n";
  for (int k = 0; k < 40; ++k)
    posterior += std::to_string(1 + 0.001 * k) + ',' + std::to_string(1.1 - 0.002 * k) + '\n';
  folder.write("posterior.csv", posterior);
  Json json = quick_campaign(60);
  json["dispersions"].push_back(parse_json(R"({ "name": "fitted", "rows": { "file": "posterior.csv",
    "apply": "scale", "columns": { "a": "hinges.mid.spring.scale", "b": "hinges.tip.spring.scale" } } })"));
  const std::string file = file_with(folder, json), path = folder.path() / "r";
  REQUIRE(run_program(folder, {"run", file, "--out", path}).code == 0);
  const Json found = parse_json(run_program(folder, {"sensitivity", path, "--json"}).out);
  CHECK(found["rows"] == parse_json(R"({ "fitted": ["a", "b"] })"));
  const auto warned = found["warnings"].get<std::vector<std::string>>();
  CHECK(std::ranges::count_if(warned, [](const std::string& each) {
          return each.find("\"a\", \"b\" are drawn together, as rows of \"fitted\"") !=
                 std::string::npos;
        }) == 1);
}

TEST_CASE("sensitivity of a campaign: the same for any threads, kept and gone on with") {
  const Folder folder;
  const std::string file = file_with(folder, quick_campaign(10)), out = folder.path() / "s";
  const auto one = run_program(folder, {"sensitivity", file, "--samples", "16", "--threads", "1",
                                        "--resamples", "50", "--json"});
  CHECK(one.code == 0);
  const auto kept = run_program(folder, {"sensitivity", file, "--samples", "16", "--threads", "3",
                                         "--resamples", "50", "--json", "--out", out});
  CHECK(kept.out == one.out);
  CHECK(*read_text(out + "/sensitivity.json") == one.out);
  CHECK(run_program(folder, {"sensitivity", out, "--resamples", "50", "--json"}).out == one.out);
  CHECK(run_program(folder, {"sensitivity", file, "--samples", "16", "--out", out}).code == 2);
  const auto again = run_program(folder, {"sensitivity", file, "--samples", "16", "--resamples",
                                          "50", "--json", "--out", out, "--resume"});
  CHECK(again.code == 0);
  CHECK(again.out == one.out);
  CHECK(parse_json(one.out)["runs"] == 16 * 6);
  CHECK(run_program(folder, {"sensitivity", file, "--samples", "16", "--seed", "9", "--resamples",
                             "50", "--json"})
            .out != one.out);
  CHECK(run_program(folder, {"sensitivity", file, "--samples", "1"}).code == 2);
  CHECK(run_program(folder, {"analyze", out}).code == 2); // it is no sample of the campaign
}

TEST_CASE("rare says how likely, by which levels, and whether counting would have done") {
  const Folder folder;
  Json json = quick_campaign(10);
  const std::string file = file_with(folder, json);
  const std::vector<std::string> asked{"rare",      file, "--output",  "root.latch_time",
                                       "--above",   "6",  "--samples", "100",
                                       "--repeats", "2",  "--json"};
  const auto with = [&](const std::vector<std::string>& crew) {
    std::vector<std::string> arguments = asked;
    arguments.insert(arguments.end(), crew.begin(), crew.end());
    return run_program(folder, arguments);
  };
  const auto one = with({"--threads", "1"});
  CHECK(one.code == 0);
  CHECK(with({"--threads", "3"}).out == one.out);
  CHECK(with({"--isa", "scalar"}).out == one.out);
  CHECK(with({"--lanes", "1"}).out == one.out);
  const auto none = with({"--isa", "scalar", "--lanes", "8"});
  CHECK(none.code == 2);
  CHECK_THAT(none.error, HasFacts({"--isa scalar --lanes 8", "processor", "scalar (1)"}));
  const Json found = parse_json(one.out);
  CHECK(found["event"] == "root.latch_time > 6");
  CHECK(
      found["beyond"] ==
      parse_json(
          R"({ "output": "root.latch_time", "above": true, "abs": false, "limit": 6, "unit": "s" })"));
  CHECK(found["case"].is_null());
  CHECK(found["repeats"].size() == 2);
  CHECK(found["lower"] <= found["probability"]);
  CHECK(found["probability"] <= found["upper"]);
  double square = 0;
  for (const auto& [name, z] : found["likeliest"]["z"].items())
    square += std::pow(z.get<double>(), 2);
  CHECK(std::sqrt(square) == Approx(found["likeliest"]["distance"].get<double>()));
  const auto text = run_program(folder, {"rare", file, "--output", "root.latch_time", "--above",
                                         "5", "--samples", "100", "--repeats", "2"});
  CHECK(text.code == 0);
  CHECK(text.out.find("P(root.latch_time > 5 s) = ") != std::string::npos);
  CHECK(text.out.find("Plain sampling would have been enough") != std::string::npos);

  const std::string kept = folder.path() / "rare";
  CHECK(with({"--out", kept}).out == one.out);
  CHECK(read_text(folder.path() / "rare" / "rare.json").value() == one.out);
  const auto again = with({"--out", kept});
  CHECK(again.code == 2);
  CHECK_THAT(again.error, Catch::Contains("a new or an empty folder"));
  std::vector<std::string> other = asked; // a limit that has the same text in six digits
  std::ranges::replace(other, "6", "6.0000001");
  other.insert(other.end(), {"--out", kept, "--resume"});
  CHECK(run_program(folder, other).code == 2);
  CHECK(run_program(folder, {"report", kept}).code == 0);
  CHECK(read_text(folder.path() / "rare" / "report.html").value().find("root.latch_time > 6") !=
        std::string::npos);
  Json without = found;
  without.erase("statuses"); // then no run is known to have failed
  std::ofstream(folder.path() / "rare" / "rare.json") << without.dump();
  const auto finished = with({"--out", kept, "--resume"});
  CHECK(finished.code == 0);
  CHECK_THAT(finished.error, Catch::Contains("finished already"));
}

TEST_CASE("rare names the case, the unit and the confidence, and so does its page", "[cases]") {
  const Folder folder;
  Json json = quick_campaign(10);
  json["cases"] = parse_json(
      R"([ { "name": "as_it_is" }, { "name": "weak", "scale": { "hinges.*.spring.scale": 0.9 } } ])");
  const std::string kept = folder.path() / "rare";
  const auto [code, out, error] =
      run_program(folder, {"rare", file_with(folder, json), "--case", "weak", "--output",
                           "root.peak_moment", "--above", "1", "--samples", "100", "--repeats", "2",
                           "--confidence", "0.9", "--out", kept});
  CHECK(code == 0);
  CHECK_THAT(out, HasFacts({" · weak · ", "root.peak_moment > 1 N·m", "90 % bounds"}));
  const Json found = parse_json_file(kept + "/rare.json");
  CHECK(found["case"] == "weak");
  CHECK(found["beyond"]["unit"] == "N·m");
  CHECK(run_program(folder, {"report", kept}).error.empty());
  const Json rare = page_data(kept + "/report.html")["sets"][0]["rare"];
  CHECK(rare["case"] == "weak");
  CHECK(rare["confidence"] == 0.9);
  CHECK(rare["beyond"] == found["beyond"]);
}

TEST_CASE(
    "rare takes a limit with a unit, and lists the units of the output where it refuses one") {
  const Folder folder;
  const std::string file = file_with(folder, quick_campaign(10));
  const auto rare = [&](const char* output, const char* side, const char* limit) {
    return run_program(folder, {"rare", file, "--output", output, side, limit, "--samples", "100",
                                "--repeats", "2", "--json"});
  };
  const Finished plain = rare("root.latch_time", "--above", "5");
  CHECK(plain.code == 0);
  CHECK(rare("root.latch_time", "--above", "5000 ms").out == plain.out);
  CHECK(rare("root.latch_rate", "--below", "-1 rad/s").out ==
        rare("root.latch_rate", "--below", "-1").out);
  const Finished wrong = rare("root.peak_moment", "--above", "350 N");
  CHECK(wrong.code == 2);
  CHECK_THAT(wrong.error, Catch::StartsWith("error: --above: found \"350 N\", expected a number, "
                                            "N·m, or a string of a number and its unit: ") &&
                              Catch::Contains("\"ft*lbf\", or another one made of Nm, N, "));
  CHECK_THAT(rare("root.peak_moment", "--above", "inf").error,
             Catch::Contains("error: --above: found \"inf\", expected a finite number"));
}

// Two normal draws with the correlation r: the one that is first by name is its mean plus std times its coordinate z1, the
// other its mean plus std times (r z1 + √(1 − r²) z2).
TEST_CASE("rare's normal coordinates are free of the draws' correlations, and it says so") {
  const Folder folder;
  Json json = quick_campaign(10);
  json["dispersions"][1] = {{"name", "tip_spring"},
                            {"distribution", {{"type", "normal"}, {"mean", 1}, {"std", 0.05}}},
                            {"apply", "scale"},
                            {"to", {"hinges.tip.spring.scale"}}};
  const auto rare = [&](const char* form) {
    return run_program(folder, {"rare", file_with(folder, json), "--output", "root.latch_time",
                                "--above", "5.1", "--samples", "100", "--repeats", "2", form});
  };
  json["correlations"] = {{{"between", {"root_spring", "tip_spring"}}, {"spearman", 0.8}}};
  const Json run = parse_json(rare("--json").out)["likeliest"];
  const double z1 = run["z"]["root_spring"], z2 = run["z"]["tip_spring"],
               r = 2 * std::sin(3.14159265358979324 * 0.8 / 6);
  CHECK(run["draws"]["root_spring"].get<double>() == Approx(1 + 0.05 * z1).epsilon(1e-9));
  CHECK(run["draws"]["tip_spring"].get<double>() ==
        Approx(1 + 0.05 * (r * z1 + std::sqrt(1 - r * r) * z2)).epsilon(1e-9));
  const std::string text = rare("--threads=2").out;
  CHECK_THAT(text, Catch::Contains("in normal coordinates: ") &&
                       Catch::Contains("normal coordinate: 0 at the law's median") &&
                       Catch::Contains("correlated draw the part that draws before it"));
  CHECK_THAT(text, !Catch::Contains("standard deviations"));
}

TEST_CASE("rare refuses half an event, and an odd number of samples") {
  const Folder folder;
  const std::string file = file_with(folder, quick_campaign(10));
  for (const std::vector<std::string>& extra :
       {std::vector<std::string>{"--output", "root.latch_time"},
        {"--above", "3"},
        {"--abs"},
        {"--output", "root.latch_time", "--above", "3", "--below", "2"},
        {"--samples", "105"},
        {"--samples", "50"},
        {"--repeats", "0"},
        {"--confidence", "2"},
        {"--output", "root.speed", "--above", "1"}}) {
    std::vector<std::string> arguments{"rare", file};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    const auto [code, out, error] = run_program(folder, arguments);
    INFO(extra.front() << ' ' << error);
    CHECK(code == 2);
    CHECK(out.empty());
    CHECK(error.starts_with("error: "));
  }
}

TEST_CASE("shards of a design are merged to the folder that one process makes, byte for byte",
          "[parallel]") {
  const Folder folder;
  const std::string file = folder.write("c.json", quick_campaign(10).dump());
  const auto at = [&](const std::string& name) { return (folder.path() / name).string(); };
  const auto make = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words{"sensitivity", file, "--samples", "7", "--out", at(name)};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(folder, words);
  };
  const auto whole = make("whole", {"--threads", "2"});
  CHECK(whole.code == 0);
  const auto shard = make("part2", {"--shard", "2/3"}); // the design's rows are cut through
  CHECK(shard.code == 0);
  CHECK(shard.out == at("part2") + "/design.json\n" + at("part2") + "/design_runs.csv\n");
  CHECK_THAT(shard.error, HasFacts({"note: shard 2/3", "`wingspread merge`"}));
  CHECK(make("part1", {"--shard", "1/3"}).code == 0);
  CHECK_THAT(
      run_program(folder, {"sensitivity", at("part1")}).error,
      HasFacts({"error: " + at("part1") + ": found shard 1/3 of a design", "`wingspread merge`"}));
  const auto missing = run_program(folder, {"merge", at("part2"), at("part1"), "--out", at("out")});
  CHECK(missing.code == 2);
  const std::string command =
      "sensitivity " + at("part2") + "/design.json --out " + at("part3") + " --shard 3/3\n";
  CHECK_THAT(
      missing.error,
      Catch::StartsWith("error: found no folder with runs 28 to 41, expected folders with all of "
                        "the campaign's 42 runs\n") &&
          Catch::EndsWith("  wingspread " + command));
  CHECK(run_program(folder, {"merge", at("part2"), at("part1"), "--out", at("out"), "--preview"})
            .code == 2);
  CHECK(run_program(folder, {"sensitivity", at("part2") + "/design.json", "--out", at("part3"),
                             "--shard", "3/3"})
            .code == 0);
  const auto rows =
      read_text(folder.path() / "part1" / design_runs_file).value(); // and one that was cut off
  std::ofstream(folder.path() / "part1" / design_runs_file) << rows.substr(0, rows.size() / 2);
  const auto cut =
      run_program(folder, {"merge", at("part3"), at("part2"), at("part1"), "--out", at("out")});
  CHECK_THAT(cut.error, Catch::EndsWith(" --out " + at("part1") + " --shard 1/3 --resume\n"));
  CHECK_FALSE(std::filesystem::exists(at("out")));
  CHECK(make("part1", {"--shard", "1/3", "--resume"}).code == 0);
  CHECK(make("part1", {"--shard", "1/2", "--resume"}).code == 2);
  const auto merged = run_program(
      folder, {"merge", at("part3"), at("part2"), at("part1"), "--out", at("out"), "--table"});
  CHECK(merged.code == 0);
  CHECK(merged.out == whole.out);
  CHECK(contents(at("out")) == contents(at("whole")));
  CHECK(run_program(folder, {"merge", at("part1"), at("part1"), "--out", at("o2")}).code == 2);
  CHECK_THAT(run_program(folder, {"sensitivity", file, "--shard", "1/2"}).error,
             HasFacts({"error: --shard: found --shard without --out"}));
  CHECK(run_program(folder, {"sensitivity", at("part2") + "/design.json", "--samples", "9"}).code ==
        2);
}

TEST_CASE("a design's folder keeps how its bounds were asked for, and merge uses it") {
  const Folder folder;
  const std::string file = folder.write("c.json", quick_campaign(10).dump());
  const auto at = [&](const std::string& name) { return (folder.path() / name).string(); };
  const auto make = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words{"sensitivity",  file,  "--samples", "20",    "--resamples", "50",
                                   "--confidence", "0.8", "--out",     at(name)};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(folder, words);
  };
  CHECK(make("whole", {}).code == 0);
  const auto whole = contents(at("whole"));
  CHECK(run_program(folder, {"sensitivity", at("whole")}).code == 0); // as it was made
  CHECK(contents(at("whole")) == whole);
  CHECK(make("part1", {"--shard", "1/2"}).code == 0);
  CHECK(run_program(folder, {"sensitivity", at("part1") + "/design.json", "--out", at("part2"),
                             "--shard", "2/2"})
            .code == 0);
  const auto merge = [&] {
    return run_program(folder, {"merge", at("part1"), at("part2"), "--out", at("out")});
  };
  CHECK(merge().code == 0);
  CHECK(contents(at("out")) == whole);
  const auto again = merge(); // its tables may be of another `sensitivity`
  CHECK(again.code == 2);
  CHECK_THAT(again.error, HasFacts({at("out"), "--out", "wingspread sensitivity " + at("out")}));
  CHECK(make("other", {"--shard", "2/2", "--resamples", "60"}).code != 0); // given twice
  CHECK(run_program(folder, {"sensitivity", file, "--samples", "20", "--shard", "2/2", "--out",
                             at("other")})
            .code == 0);
  const auto mixed = run_program(folder, {"merge", at("part1"), at("other"), "--out", at("mixed")});
  CHECK(mixed.code == 2);
  CHECK_THAT(mixed.error, HasFacts({at("other"), "--resamples"}));
}

TEST_CASE("sensitivity names the file of a campaign that it cannot use") {
  const Folder folder;
  Json json = quick_campaign(5);
  json["dispersions"][1] = {{"name", "tip_spring"},
                            {"distribution", {{"type", "normal"}, {"mean", 1}, {"std", 0.05}}},
                            {"apply", "scale"},
                            {"to", {"hinges.tip.spring.scale"}}};
  json["correlations"] = {{{"between", {"root_spring", "tip_spring"}}, {"spearman", 0.5}}};
  const std::string file = folder.write("campaign.json", json.dump());
  const auto refused = run_program(folder, {"sensitivity", file, "--samples", "4"});
  CHECK(refused.code == 2);
  CHECK_THAT(refused.error, Catch::StartsWith("error: " + file + ": /correlations: "));
}
