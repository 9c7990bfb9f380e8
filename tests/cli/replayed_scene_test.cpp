// `replay --scene`: the file it writes, the command it prints, and what it refuses before anything is written.
#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

#include <fstream>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// The value at a parameter's path in a scene's JSON; absent factors are 1, absent offsets 0.
double value_at(const Json& scene, const std::string& path) {
  std::istringstream in(path);
  std::string list, name, key;
  std::getline(in, list, '.');
  std::getline(in, name, '.');
  const auto named =
      std::ranges::find_if(scene[list], [&](const Json& o) { return o["name"] == name; });
  const Json* at = &*named;
  while (std::getline(in, key, '.')) {
    if (at->is_array()) return at->at(std::stoul(key)).get<double>();
    if (!at->contains(key)) return key == "scale" ? 1 : 0;
    at = &at->at(key);
  }
  return at->get<double>();
}

} // namespace

TEST_CASE("replay writes the scene of a run: simulate latches it at the same times") {
  const Folder folder;
  const std::string source = std::string(source_folder) + "/studies/campaigns/yoke_wing.json";
  const std::string out = folder.path() / "r";
  REQUIRE(
      run_program(folder, {"run", source, "--out", out, "--runs", "3", "--case", "cold"}).code <=
      1);
  const auto applied = lines_of(
      run_program(folder, {"sample", source, "--runs", "3", "--case", "cold", "--applied"}).out);
  REQUIRE(applied.size() == 4);
  for (const char* run : {"0", "2"}) {
    const std::string file = folder.path() / ("run_" + std::string(run) + ".json");
    const auto replayed = run_program(
        folder, {"replay", out, "--case", "cold", "--run", run, "--json", "--scene", file});
    REQUIRE(replayed.code == 0);
    const Json there = parse_json(replayed.out);
    REQUIRE(there["latches"].size() == 5);
    const Json here =
        parse_json(run_program(folder, {"simulate", file, "--t-end", "120", "--json"}).out);
    CHECK(here["latches"] == there["latches"]); // every bit of times and rates
    CHECK(here["peak_moment"] == there["peak_moment"]);
    // The CSV of applied parameters has the scene's values: masses, factors of tables, dampers.
    const Json scene = parse_json_file(file);
    std::istringstream names(applied[0]), values(applied[1 + std::stoul(run)]);
    std::string name, value;
    long compared = 0;
    while (std::getline(names, name, ',') && std::getline(values, value, ',')) {
      if (name == "run") continue;
      CAPTURE(name);
      CHECK(value_at(scene, name) == std::stod(value));
      ++compared;
    }
    CHECK(compared == 35);
    CHECK(value_at(scene, "hinges.root.damper.scale") > 1.5); // cold grease
  }
}

TEST_CASE("replay names the options with which simulate makes the run of its scene") {
  const DoneCampaign done(quick_campaign(4));
  const std::string file = done.folder.path() / "run.json", csv = done.folder.path() / "t.csv";
  const std::vector<std::string> words{"replay",  done.path, "--run", "2",
                                       "--scene", file,      "--out", csv};
  const auto with_dt = [&](std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    return done.program(more);
  };
  const auto [code, out, error] = with_dt({"--dt", "0.5"});
  CHECK(code == 0);
  CHECK_THAT(out, Catch::Contains("\n  wingspread simulate " + file +
                                  " --rtol 1e-06 --atol 1e-08 --t-end 20\n"));
  const auto rows = lines_of(read_text(csv).value());
  REQUIRE(rows.size() > 4);
  CHECK(rows[1].starts_with("0,"));
  CHECK(rows[2].starts_with("0.5,"));
  CHECK(rows[3].starts_with("1,"));
  CHECK(with_dt({}).code == 0); // the same scene again loses nothing
  std::ofstream(file) << "{}";
  CHECK(with_dt({}).error ==
        "error: --scene: found \"" + file +
            "\", an existing file, expected a new file: this one would be lost\n");
  CHECK(done.program({"replay", done.path, "--run", "2", "--dt", "0.5"}).error ==
        "error: --dt: found --dt without --out, expected the trajectory's file in --out\n");
}

TEST_CASE("the printed command makes the run again, whatever the campaign's integration sets") {
  const std::vector<std::pair<std::string, Json>> settings{{"method", "dop853"},
                                                           {"rtol", 1e-5},
                                                           {"atol", 1e-5},
                                                           {"latch", {{"smoothed", 1e-3}}},
                                                           {"t_end", 5},
                                                           {"max_steps", 3}, // a failed run
                                                           {"max_steps", 3'000'000}};
  for (const auto& [key, value] : settings) {
    CAPTURE(key, value.dump());
    Json json = quick_campaign(2);
    json["integration"][key] = value;
    const DoneCampaign done(json);
    const std::string file = done.folder.path() / "run.json";
    const Finished replayed = done.program({"replay", done.path, "--run", "1", "--scene", file});
    CHECK(replayed.code == (value == 3 ? 3 : 0));
    const Json there = parse_json(done.program({"replay", done.path, "--run", "1", "--json"}).out);
    std::istringstream line(
        replayed.out.substr(replayed.out.find("\n  wingspread simulate ") + 14));
    std::vector<std::string> words;
    for (std::string word; line >> word;) words.push_back(word);
    REQUIRE(words.size() > 2);
    words.emplace_back("--json");
    const Finished simulated = done.program(words);
    CHECK(simulated.code == replayed.code);
    const Json here = parse_json(simulated.out);
    CHECK(here["latches"] == there["latches"]);
    CHECK(here["reason"] == there["reason"]);
  }
}

TEST_CASE("replay writes nothing if it refuses the file of --scene") {
  const DoneCampaign done(quick_campaign(3));
  const std::string scene = done.folder.write("s.json", "{}"), csv = done.folder.write("t.csv", "");
  const auto with = [&](const std::string& out, const std::string& to) {
    const Finished refused =
        done.program({"replay", done.path, "--run", "1", "--out", out, "--scene", to});
    CHECK(refused.code == 2);
    CHECK_THAT(refused.error, HasFacts({"--scene", to}));
  };
  with(csv, scene);
  CHECK(read_text(csv) == "");
  CHECK(read_text(scene) == "{}");
  const std::string same = done.folder.path() / "same.x";
  with(same, same);
  with(same, done.folder.path().string() + "/./same.x");
  CHECK_FALSE(std::filesystem::exists(same));
}
