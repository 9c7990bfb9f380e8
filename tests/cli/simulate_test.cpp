#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

#include <fstream>
#include <regex>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("simulate prints strict JSON and writes the trajectory") {
  const Folder folder;
  const auto file = folder.path() / "trajectory.csv";
  const auto [code, out, error] = run_program(
      folder, {"simulate", three_panel_file(), "--json", "--out", file, "--t-end", "8"});
  CHECK(code == 0);
  CHECK(error.empty());
  const Json json = parse_json(out);
  CHECK(json["status"] == "deployed");
  CHECK(json["t_end"] == 8);
  CHECK(json["latches"][0]["hinge"] == "root");
  const std::vector<std::string> rows = lines_of(read_text(file).value());
  CHECK(rows.front() == "t,root.angle,root.rate,root.moment,mid.angle,mid.rate,mid.moment,"
                        "tip.angle,tip.rate,tip.moment,kinetic,potential,total");
  CHECK(rows.back().starts_with("8,"));
}

TEST_CASE("simulate in words") {
  const Folder folder;
  const auto [code, out, error] =
      run_program(folder, {"simulate", three_panel_file(), "--t-end", "7", "--latch", "event",
                           "--method", "dopri5"});
  CHECK(code == 0);
  CHECK(error.empty());
  CHECK(out.starts_with("three_panel: deployed, integrated to 7 s by dopri5\n"));
  const Json energy =
      parse_json(run_program(folder, {"simulate", three_panel_file(), "--t-end", "7", "--latch",
                                      "event", "--method", "dopri5", "--json"})
                     .out)["energy"];
  std::smatch shown; // at the start, at the end, dissipated
  REQUIRE(std::regex_search(out, shown, std::regex("Energy: (\\S+) J .*, (\\S+) J .*, (\\S+) J ")));
  CHECK(std::stod(shown[3]) == Approx(energy["drift_before_first_latch"].get<double>())
                                   .epsilon(1e-5)); // six digits, as the others
}

TEST_CASE("simulate takes a campaign's nominal scene and settings") {
  const Folder folder;
  const std::string file = folder.write("campaign.json", quick_campaign(5).dump());
  const Json json = parse_json(run_program(folder, {"simulate", file, "--json"}).out);
  CHECK(json["t_end"] == 20); // the campaign's, and not the default of 60
  const Json tight = parse_json(run_program(folder, {"simulate", file, "--json", "--rtol", "1e-10",
                                                     "--atol", "1e-12", "--method", "dopri5"})
                                    .out);
  CHECK(tight["work"]["steps"] > json["work"]["steps"]);
  const Json smooth =
      parse_json(run_program(folder, {"simulate", file, "--json", "--latch", "smoothed:0.01"}).out);
  CHECK(smooth["peak_moment"]["tip"]["value"] != json["peak_moment"]["tip"]["value"]);
}

TEST_CASE("simulate takes the step of a method with a fixed one, and of no other") {
  const Folder folder;
  const auto simulate = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"simulate", three_panel_file(), "--json", "--t-end", "1"});
    return run_program(folder, options);
  };
  const auto refused = simulate({"--step", "0.001"});
  CHECK(refused.code == 2);
  CHECK(refused.error == "error: --step: found 0.001, expected no step with the method \"auto\" "
                         "(only used by a method with a fixed step: runge_kutta4)\n");
  const auto steps = [&](const char* step) {
    const auto [code, out, error] = simulate({"--method", "runge_kutta4", "--step", step});
    REQUIRE(code == 0);
    const Json json = parse_json(out);
    CHECK(json["method"] == "runge_kutta4");
    return json["work"]["steps"].get<long>();
  };
  const long coarse = steps("0.002");
  CHECK(coarse > 200);
  CHECK(std::abs(steps("0.001") - 2 * coarse) <= 2); // the last may be what rounding leaves
}

TEST_CASE("a wing that friction holds stalls, which is a result and no error") {
  const Folder folder;
  Json scene = parse_json_file(three_panel_file());
  // Springs of 0.75 to 2 N·m against at least 3.
  for (Json& hinge : scene["hinges"])
    hinge["friction"] = {{"model", "exact"}, {"coulomb", 2.5}, {"static", 3}};
  const std::string file = folder.write("scene.json", scene.dump());
  const auto [code, out, error] = run_program(folder, {"simulate", file, "--json"});
  CHECK(code == 0);
  CHECK(lines_of(error).size() == 3); // told of each hinge before it is run
  for (const std::string& line : lines_of(error))
    CHECK_THAT(line, Catch::StartsWith("warning: ") && Catch::Contains("a net static torque of "));
  const Json json = parse_json(out);
  CHECK(json["status"] == "stalled");
  CHECK(json["reason"].is_string());
  CHECK(json["latches"].empty());
  const auto check = run_program(folder, {"check", file});
  CHECK(check.code == 0);
  std::string words; // without the breaks of lines
  std::istringstream in(check.out);
  for (std::string word; in >> word;) words += word + ' ';
  CHECK(words.find("friction 2.5 N·m, 0 N·m·s/rad, exact, static 3 N·m;") != std::string::npos);
}

TEST_CASE("a wing whose springs overcome exact friction deploys") {
  const Folder folder;
  Json scene = parse_json_file(three_panel_file());
  for (Json& hinge : scene["hinges"])
    hinge["friction"] = {{"model", "exact"}, {"coulomb", 0.02}, {"static", 0.03}};
  const std::string file = folder.write("scene.json", scene.dump());
  const auto [code, out, error] =
      run_program(folder, {"simulate", file, "--json", "--t-end", "20"});
  CHECK(code == 0);
  CHECK(parse_json(out)["status"] == "deployed");
}

TEST_CASE("simulate refuses settings by their options") {
  const Folder folder;
  const auto [code, out, error] = run_program(
      folder, {"simulate", three_panel_file(), "--rtol", "2", "--atol", "0", "--t-end", "-1",
               "--latch", "smoothed:-1", "--method", "guess", "--out", folder.path() / "t.csv"});
  CHECK(code == 2);
  CHECK(out.empty());
  CHECK(error.find("error: --method: found string \"guess\", expected \"auto\"") == 0);
  CHECK(error.find("error: --rtol: found 2.0, expected a number, ≥ 1e-15 and < 1") != error.npos);
  CHECK(error.find("error: --atol: found 0.0, expected a number, > 0\n") != error.npos);
  CHECK(error.find("error: --latch: found -1.0, expected a number, rad, > 0\n") != error.npos);
  CHECK(error.find("error: --t-end: found -1.0, expected a number, s, > 0\n") != error.npos);
  CHECK(lines_of(error).size() == 5);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "t.csv"));
}

TEST_CASE(
    "a tolerance that double precision does not have is refused, as an option and in a campaign") {
  const Folder folder;
  const auto simulate = [&](const char* rtol) {
    return run_program(folder, {"simulate", three_panel_file(), "--t-end", "0.1", "--rtol", rtol});
  };
  const auto [code, out, error] = simulate("1e-40");
  CHECK(code == 2);
  CHECK(out.empty());
  CHECK(error.starts_with("error: --rtol: found 1e-40, expected a number, ≥ 1e-15 and < 1"));
  CHECK(simulate("1e-15").code == 0);
  Json campaign = quick_campaign(5);
  campaign["integration"]["rtol"] = 1e-40;
  const std::string file = folder.write("campaign.json", campaign.dump());
  const auto run = run_program(folder, {"run", file, "--out", folder.path() / "r"});
  CHECK(run.code == 2);
  CHECK(run.error.starts_with("error: " + file + ": /integration/rtol: found 1e-40"));
}

TEST_CASE("an option's number that is not finite is named as it was typed") {
  const Folder folder;
  const auto [code, out, error] = run_program(
      folder, {"simulate", three_panel_file(), "--set", "hinges.root.spring.scale=nan", "--set",
               "bodies.panel_1.mass=-inf", "--set", "bodies.panel_2.mass=inf"});
  CHECK(code == 2);
  CHECK(out.empty());
  CHECK(error == "error: --set hinges.root.spring.scale: found nan, expected a finite number\n"
                 "error: --set bodies.panel_1.mass: found -inf, expected a finite number, kg\n"
                 "error: --set bodies.panel_2.mass: found inf, expected a finite number, kg\n");
  CHECK(run_program(folder, {"simulate", three_panel_file(), "--rtol", "nan"})
            .error.starts_with("error: --rtol: found nan, expected a finite number"));
}

TEST_CASE("a simulation that fails says why") {
  const Folder folder;
  Json campaign = quick_campaign(5);
  campaign["integration"]["max_steps"] = 10;
  const auto [code, out, error] =
      run_program(folder, {"simulate", folder.write("campaign.json", campaign.dump()), "--json"});
  CHECK(code == 3);
  CHECK(parse_json(out)["status"] == "failed");
  CHECK(error.starts_with(
      "error: the run failed numerically: the limit of 10 steps (max_steps) was reached"));
}

TEST_CASE("check says what a file holds, or all that is wrong with it") {
  const Folder folder;
  const auto scene = run_program(folder, {"check", three_panel_file()});
  CHECK(scene.code == 0);
  CHECK(scene.error.empty());
  CHECK(scene.out.starts_with("scene three_panel\n"));
  const std::string file = folder.write("campaign.json", quick_campaign(5).dump());
  CHECK(run_program(folder, {"check", file}).out.starts_with("campaign\n"));

  Json bad = quick_campaign(5);
  bad["scene"]["hinges"][0]["friction"] = {{"model", "dry"}};
  bad["margin"] = {{"range", {0.5, 2}}};
  folder.write("campaign.json", bad.dump());
  const auto [code, out, error] = run_program(folder, {"check", file});
  CHECK(code == 2);
  CHECK(out.empty());
  CHECK(error == "error: " + file +
                     ": /scene/hinges/0/friction/model: found string \"dry\", expected "
                     "\"regularized\" or \"exact\"\n"
                     "error: " +
                     file +
                     ": /margin/scale: found nothing, expected the paths of the parameters to "
                     "size\n");
}

TEST_CASE("a nominal wing that the dispersions' medians make unphysical is refused") {
  const Folder folder;
  Json campaign = quick_campaign(5);
  campaign["dispersions"] = parse_json(R"([ { "name": "mass", "to": ["bodies.panel_2.mass"],
    "apply": "scale", "distribution": { "type": "uniform", "lower": -3, "upper": 1 } } ])");
  const std::string file = folder.write("c.json", campaign.dump());
  for (const char* command : {"simulate", "modes"}) {
    const auto refused = run_program(folder, {command, file});
    CHECK((refused.code == 2 && refused.out.empty()));
    CHECK_THAT(refused.error, HasFacts({"bodies.panel_2.mass", "median", "> 0"}));
  }
}

TEST_CASE("smoothed latches are refused where they would leave something out, with the place") {
  const Folder folder;
  const std::vector<std::pair<const char*, double>> laws{
      {"capture_rate", 5}, {"holding_moment", 50}, {"backlash", 0.01}};
  for (const auto& [key, value] : laws) {
    Json campaign = quick_campaign(5);
    campaign["scene"] = parse_json_file(three_panel_file());
    campaign["scene"]["hinges"][1]["latch"][key] = value;
    const std::string scene = folder.write("s.json", campaign["scene"].dump());
    const std::string path = "hinges.mid.latch." + std::string(key);
    const auto simulated = run_program(folder, {"simulate", scene, "--latch", "smoothed:1e-3"});
    CHECK((simulated.code == 2 && simulated.out.empty()));
    CHECK_THAT(simulated.error, HasFacts({"--latch: ", path, "event"}));
    campaign["integration"]["latch"] = {{"smoothed", 1e-3}};
    const std::string file = folder.write("c.json", campaign.dump());
    for (const std::vector<std::string>& command : {std::vector<std::string>{"check", file},
                                                    {"run", file, "--out", folder.path() / "r"},
                                                    {"simulate", file}}) {
      const auto refused = run_program(folder, command);
      CHECK(refused.code == 2);
      CHECK_THAT(refused.error, HasFacts({file, "/integration/latch: ", path, "event"}));
    }
    CHECK(run_program(folder, {"simulate", file, "--latch", "event", "--t-end", "1"}).code == 2);
  }
}

TEST_CASE("sample prints the draws that the runs apply") {
  const Folder folder;
  const std::string file = folder.write("campaign.json", quick_campaign(5).dump());
  const auto path = folder.path() / "r";
  (void)run_into(path, campaign_of(quick_campaign(5)));
  std::string expected = "run,root_spring,mass.panel_1,mass.panel_2,mass.panel_3\n";
  const Results results = read_stored_results(read_stored_campaign(path)).results;
  for (std::size_t i = 0; i < 5; ++i) {
    expected += std::to_string(i);
    for (const double draw : results.row(i).draws) {
      expected += ',';
      append_csv_cell(expected, draw);
    }
    expected += '\n';
  }
  const auto [code, out, error] = run_program(folder, {"sample", file});
  CHECK(code == 0);
  CHECK(error.empty());
  CHECK(out == expected);
  const auto csv = folder.path() / "draws.csv";
  CHECK(run_program(folder, {"sample", file, "--out", csv}).out.empty());
  CHECK(read_text(csv) == expected);
  CHECK(lines_of(run_program(folder, {"sample", file, "--runs", "3"}).out).size() == 4);
  CHECK(run_program(folder, {"sample", file, "--seed", "8"}).out != expected);
  CHECK(run_program(folder, {"sample", file, "--out", folder.path() / "no" / "d.csv"}).code == 2);
}

TEST_CASE("what is read, and any JSON file, is not written over") {
  const Folder folder;
  const std::string text = read_text(three_panel_file()).value();
  const std::string scene = folder.write("scene", text), other = folder.write("o.json", "{}");
  const auto same =
      run_program(folder, {"simulate", scene, "--out", folder.path() / "." / "scene"});
  CHECK(same.code == 2);
  CHECK(same.error.starts_with("error: --out: found \""));
  CHECK_THAT(same.error, HasFacts({"scene\", which this command reads"}));
  CHECK(run_program(folder, {"simulate", scene, "--out", other}).code == 2);
  CHECK(read_text(scene).value() == text);
  CHECK(read_text(other).value() == "{}");
}

TEST_CASE("what a campaign names is not written over: its scene, and the tables of its laws") {
  const Folder folder;
  const std::string text = read_text(three_panel_file()).value(), values = "x\n0.9\n1\n1.1\n";
  const std::string scene = folder.write("wing", text), table = folder.write("t.csv", values),
                    in_case = folder.write("case.csv", values);
  Json json = quick_campaign(5);
  const auto law = [](const char* file) {
    return Json{{"type", "empirical"}, {"file", file}, {"column", "x"}};
  };
  json["scene"] = "wing";
  json["dispersions"][0]["distribution"] = law("t.csv");
  json["cases"] = {
      {{"name", "worn"}, {"distributions", {{json["dispersions"][0]["name"], law("case.csv")}}}}};
  const std::string campaign = folder.write("c.json", json.dump());
  for (const char* command : {"simulate", "sample"})
    for (const std::string& file : {scene, table, in_case}) {
      const Finished done =
          run_program(folder, {command, campaign, "--case", "worn", "--out", file});
      CHECK(done.code == 2);
      CHECK_THAT(done.error,
                 HasFacts({"error: --out: found \"" + file + "\", which this command reads"}));
    }
  CHECK(read_text(scene).value() == text);
  CHECK(read_text(table).value() == values);
  CHECK(read_text(in_case).value() == values);
  const std::string fresh = folder.write("fresh.csv", "mine to replace");
  CHECK(run_program(folder, {"sample", campaign, "--case", "worn", "--out", fresh}).code == 0);

  // rows of another tool, with a campaign beside them as somebody wrote it
  const std::string there = folder.path() / "r";
  std::filesystem::create_directory(there);
  json["scene"] = "../wing";
  json["dispersions"][0]["distribution"] = law("../t.csv");
  json.erase("cases");
  std::ofstream(there + "/campaign.json") << json.dump();
  for (const char* command : {"report", "export"}) {
    const Finished done = run_program(folder, {command, there, "--out", table});
    CHECK(done.code == 2);
    CHECK_THAT(done.error, HasFacts({"which this command reads"}));
  }
  CHECK(read_text(table).value() == values);
}

TEST_CASE("no command writes over a results folder's own files") {
  const Folder folder;
  const std::string campaign = folder.write("campaign.json", quick_campaign(5).dump());
  const auto results = folder.path() / "r";
  REQUIRE(run_program(folder, {"run", campaign, "--out", results}).code == 0);
  const std::string rows = read_text(results / "runs.csv").value();
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"replay", results, "--run", "1"},
        {"report", results},
        {"export", results}})
    for (const char* file : {"runs.csv", "campaign.json"}) {
      std::vector<std::string> words = command;
      words.insert(words.end(), {"--out", results / file});
      const Finished done = run_program(folder, words);
      CHECK(done.code == 2);
      CHECK(done.error.starts_with("error: --out: found \""));
    }
  CHECK(run_program(folder, {"sample", campaign, "--out", campaign}).code == 2);
  CHECK(read_text(results / "runs.csv").value() == rows);
  CHECK(run_program(folder, {"replay", results, "--run", "1", "--out", results / "t.csv"}).code ==
        0);
}

TEST_CASE("a trajectory of more rows than a disk holds is refused") {
  const Folder folder;
  const auto done = run_program(folder, {"simulate", three_panel_file(), "--out",
                                         folder.path() / "t.csv", "--dt", "1e-12", "--t-end", "8"});
  CHECK(done.code == 2);
  CHECK_THAT(done.error, HasFacts({"error: --dt: found 1e-12", "at least 8e-08", "8 s"}));
}

TEST_CASE("simulate --check says how many digits agree, and warns of what moves by more than 1 %") {
  const Folder folder;
  const Finished good =
      run_program(folder, {"simulate", three_panel_file(), "--t-end", "12", "--check"});
  CHECK(good.code == 0);
  CHECK_THAT(good.out, HasFacts({"CHECK by dopri5 at rtol 1e-10", "digits", "root.latch_time",
                                 "tip.peak_moment"}));
  CHECK(good.out.find("moves by") == std::string::npos);
  Json scene = parse_json_file(three_panel_file());
  for (Json& hinge : scene["hinges"])
    hinge["latch"] = {{"stiffness", 1e7}, {"damping", 1}, {"backlash", 0.004}};
  const std::string rattling = folder.write("rattling.json", scene.dump());
  const Finished moved = run_program(folder, {"simulate", rattling, "--t-end", "12", "--check"});
  CHECK(moved.code == 0);
  CHECK_THAT(moved.out, HasFacts({"CHECK by", "WARNING", "moves by", "smaller rtol"}));
  const Json check =
      parse_json(run_program(folder, {"simulate", rattling, "--t-end", "12", "--check", "--json"})
                     .out)["check"];
  CHECK(check["reference_rtol"] == 1e-10);
  CHECK(check["outputs"][0]["output"] == "root.latch_time");
  CHECK(check["outputs"][0]["digits"] >= 9);
  CHECK_FALSE(check["warnings"].empty());
  const auto plain = run_program(folder, {"simulate", rattling, "--t-end", "12", "--json"});
  CHECK_FALSE(parse_json(plain.out).contains("check"));
}
