// Numbers that commands print, against others that they print.
#include "tests/cli/program.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <regex>

using namespace wingspread;
using namespace wingspread::test;

namespace {

double seconds_of(const std::string& text) {
  const std::map<std::string, double> units{{"ms", 1e-3}, {"s", 1}, {"min", 60}, {"h", 3600}};
  std::istringstream in(text);
  double number = 0;
  std::string unit;
  in >> number >> unit;
  return number * units.at(unit);
}

} // namespace

TEST_CASE("warnings that are not shown are counted: with those shown they are all of them") {
  const Folder folder;
  for (const int hinges : {5, 20, 40}) {
    Json scene = parse_json(
        R"({ "name": "fast", "base": { "motion": "fixed" }, "bodies": [], "hinges": [] })");
    for (int k = 0; k < hinges; ++k) { // each begins faster than a wing does
      const std::string number = std::to_string(k);
      scene["bodies"].push_back({{"name", "body_" + number}, {"mass", 10}, {"inertia", 0.5}});
      Json hinge = parse_json(R"({ "parent": "base", "child_point": [-0.5, 0],
        "angle": { "stowed": 1.5, "latched": 0 }, "initial_rate": -50,
        "spring": { "torque_stowed": 2, "torque_latched": 2 }, "latch": { "stiffness": 1e4, "damping": 100 } })");
      hinge["name"] = "hinge_" + number, hinge["child"] = "body_" + number;
      hinge["parent_point"] = {1.2 * k, 0};
      scene["hinges"].push_back(hinge);
    }
    const std::string file = folder.write("s.json", scene.dump());
    const auto count = [](const std::string& text, const std::string& word) {
      long found = 0;
      for (const std::string& line : lines_of(text)) found += line.starts_with(word) ? 1 : 0;
      return found;
    };
    const std::string shown = run_program(folder, {"check", file}).error;
    const long all = count(run_program(folder, {"check", file, "--strict"}).error, "error: ");
    CAPTURE(hinges, shown);
    CHECK(all >= hinges);
    std::smatch more;
    const bool some_left = std::regex_search(shown, more, std::regex("warning: and (\\d+) more\n"));
    CHECK(some_left == (all > 30));
    if (some_left) CHECK(count(shown, "warning: ") - 1 + std::stol(more[1]) == all);
  }
}

TEST_CASE("the times of margin's fewest and most runs that check prints are as their numbers") {
  const Folder folder;
  const std::string told =
      run_program(folder, {"check", folder.write("c.json", one_panel_margin(4000).dump())}).out;
  std::string line; // check wraps its lines
  for (const char c : told) line += c == '\n' ? ' ' : c;
  line = std::regex_replace(line, std::regex(" +"), " ");
  std::smatch found;
  CAPTURE(told);
  REQUIRE(std::regex_search(
      line, found,
      std::regex("at least (\\d+) runs \\(about ([^)]*)\\), at most (\\d+) \\(about ([^)]*)\\)")));
  const double least = seconds_of(found[2]) / std::stod(found[1]),
               most = seconds_of(found[4]) / std::stod(found[3]);
  CHECK(std::stod(found[3]) > 3 * std::stod(found[1]));
  CHECK(most / least == Approx(1).epsilon(0.2)); // each time has one or two digits
}

TEST_CASE(
    "analyze takes a campaign that stopped at its goals for complete, and one that was cut not") {
  const Folder folder;
  Json json = quick_campaign(2000);
  json["outputs"] = {"latch_time"};
  const std::string file = folder.write("c.json", json.dump()), out = folder.path() / "r",
                    cut = folder.path() / "cut";
  REQUIRE(run_program(folder, {"run", file, "--out", out, "--until", "deployed 0.1"}).code == 0);
  REQUIRE(parse_json_file(out + "/summary.json")["runs"] < 2000);
  CHECK(run_program(folder, {"analyze", out}).error.empty());
  std::filesystem::create_directory(cut);
  for (const char* name : {campaign_file, runs_file})
    std::filesystem::copy_file(out + "/" + name, cut + "/" + name);
  const std::string rows = read_text(cut + "/runs.csv").value();
  std::filesystem::resize_file(cut + "/runs.csv", rows.find('\n', rows.size() / 2) + 1);
  CHECK_THAT(run_program(folder, {"analyze", cut}).error, Catch::Contains("incomplete"));
}

TEST_CASE("export too says that what it reads is a preview") {
  const Folder folder;
  const std::string part = folder.path() / "part", out = folder.path() / "out";
  (void)run_into(part, campaign_of(quick_campaign(10)), {.shard = Shard{1, 2}});
  REQUIRE(run_program(folder, {"merge", part, "--out", out, "--preview"}).code == 0);
  for (const auto& [read, told] : {std::pair(out, true), std::pair(part, false)}) {
    const std::string error =
        run_program(folder, {"export", read, "--out", folder.path() / "t.h5"}).error;
    CHECK((error.find("PREVIEW") != std::string::npos) == told);
  }
}
