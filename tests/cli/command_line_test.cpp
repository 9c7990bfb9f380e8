#include "montecarlo/interfaces/commands/cli.hpp"
#include "montecarlo/report/text/method_list.hpp"
#include "montecarlo/results/results_folder/version.hpp"
#include "tests/cli/program.hpp"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

#include <regex>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("every command explains itself, with an example") {
  const Folder folder;
  for (const char* command :
       {"new", "run", "simulate", "replay", "check", "sample", "analyze", "merge", "size",
        "sensitivity", "rare", "margin", "report", "export", "schema", "methods", "version"}) {
    CAPTURE(command);
    const auto [code, out, error] = run_program(folder, {command, "--help"});
    CHECK(code == 0);
    CHECK(error.empty());
    CHECK(out.find("Example:\n  wingspread " + std::string(command)) != std::string::npos);
    for (const std::string& line : lines_of(out)) CHECK(line.size() <= 100);
    CHECK(out.find("… ...") == std::string::npos); // CLI11 adds the dots of a list
  }
  const auto [code, out, error] = run_program(folder, {"--help"});
  CHECK(code == 0);
  CHECK(out.find("Exit codes: 0 done, requirements met; 1 done, a requirement is not") !=
        std::string::npos);
}

TEST_CASE("a command line that makes no sense is refused") {
  const Folder folder;
  struct Refused {
    std::vector<std::string> arguments;
    std::string error;
  };
  const std::vector<Refused> list{
      {{}, "error: no command is given\nerror: see wingspread --help\n"},
      {{"frobnicate"},
       "error: found the unknown command \"frobnicate\", expected a command of wingspread\n"
       "error: see wingspread --help\n"},
      {{"rnu", "c.json"},
       "error: found the unknown command \"rnu\", expected a command of wingspread (did you mean "
       "\"run\"?)\nerror: see wingspread --help\n"},
      {{"run", "c.json", "--otu", "r", "--seeds=3"},
       "error: found the unknown option \"--otu\", expected an option of wingspread run (did you "
       "mean \"--out\"?)\n"
       "error: found the unknown option \"--seeds\", expected an option of wingspread run (did you "
       "mean \"--seed\"?)\n"
       "error: --out is required\nerror: see wingspread run --help\n"},
      {{"size", "--prob", "0.9", "--confidence", "0.9"},
       "error: found the unknown option \"--prob\", expected an option of wingspread size (did you "
       "mean \"--probability\"?)\nerror: see wingspread size --help\n"},
      {{"version", "-x"},
       "error: found the unknown option \"-x\", expected an option of wingspread version\n"
       "error: see wingspread version --help\n"},
      {{"version", "-"},
       "error: found the argument \"-\", expected no further argument\n"
       "error: see wingspread version --help\n"},
      {{"version", "now"},
       "error: found the argument \"now\", expected no further argument\n"
       "error: see wingspread version --help\n"},
      {{"run", "c.json", "--out", "r", "--until", "deployed 0.1", "requirement deployed"},
       "error: found the argument \"requirement deployed\", expected no further argument (write "
       "--until before each of its values)\nerror: see wingspread run --help\n"},
      {{"run", "c.json", "--out", "r", "now"}, // no option of the line takes several values
       "error: found the argument \"now\", expected no further argument\n"
       "error: see wingspread run --help\n"},
      {{"schema", "scnee"},
       "error: of: found \"scnee\", expected \"scene\" or \"campaign\" (did you mean "
       "\"scene\"?)\nerror: see wingspread schema --help\n"},
      {{"run", "c.json"}, "error: --out is required\nerror: see wingspread run --help\n"},
      {{"run", "c.json", "--out", "r", "--shard", "0/2"},
       "error: --shard: found 0/2, expected I/N with whole numbers 1 ≤ I ≤ N ≤ 1000000\n"
       "error: see wingspread run --help\n"},
      {{"run", "c.json", "--out", "r", "--shard", "1/2x"},
       "error: --shard: found 1/2x, expected I/N with whole numbers 1 ≤ I ≤ N ≤ 1000000\n"
       "error: see wingspread run --help\n"},
      {{"run", "c.json", "--out", "r", "--shard", "3/2"},
       "error: --shard: found 3/2, expected I/N with whole numbers 1 ≤ I ≤ N ≤ 1000000\n"
       "error: see wingspread run --help\n"},
      {{"run", "c.json", "--out", "r", "--runs", "0"},
       "error: --runs: found 0, expected a whole number from 1 to 2147483647\n"
       "error: see wingspread run --help\n"},
      {{"run", "c.json", "--out", "r", "--runs", "1e3"},
       "error: --runs: found 1e3, expected a whole number from 1 to 2147483647\n"
       "error: see wingspread run --help\n"},
      {{"simulate", "s.json", "--rtol", "1e-8x"},
       "error: --rtol: found \"1e-8x\", expected a number\nerror: see wingspread simulate "
       "--help\n"},
      {{"margin", "c.json", "--out", "m", "--range", "1", "two"},
       "error: --range: found \"1,two\", expected numbers\nerror: see wingspread margin --help\n"},
      {{"margin", "c.json", "--out", "m", "--range", "2"},
       "error: --range: found 1, expected 2 values\nerror: see wingspread margin --help\n"},
      {{"run", "c.json", "--out"},
       "error: --out: found no value, expected a value\nerror: see wingspread run --help\n"},
      {{"simulate", "s.json", "--dt"},
       "error: --dt: found no value, expected S\nerror: see wingspread simulate --help\n"},
      {{"replay", "r", "--run", "1.5"},
       "error: --run: found 1.5, expected a whole number at least 0\n"
       "error: see wingspread replay --help\n"},
      {{"run", "c.json", "--out", "r", "--threads", "0"},
       "error: --threads: found 0, expected a whole number from 1 to 1024\n"
       "error: see wingspread run --help\n"},
      {{"run", "c.json", "--out", "r", "--seed", "-1"},
       "error: --seed: found -1, expected an integer from 0 to 2^64 - 1\nerror: see wingspread run "
       "--help\n"},
      {{"simulate", "s.json", "--latch", "smoothed:x"},
       "error: --latch: found smoothed:x, expected event, or smoothed:EPS with EPS in rad, e.g. "
       "smoothed:1e-4\nerror: see wingspread simulate --help\n"}};
  for (const auto& [arguments, expected] : list) {
    const auto [code, out, error] = run_program(folder, arguments);
    CHECK(code == 2);
    CHECK(out.empty());
    CHECK(error == expected);
  }
}

// An option of integers takes one of these numbers, and neither 1.5 nor 0.5.
TEST_CASE("every whole number is decimal, whatever it begins with") {
  CLI::App app;
  Action action;
  for (const Command& command : all_commands()) command.add(app, action);
  /// The text from which the option's value is read; nothing if the option refuses it.
  const auto taken = [](CLI::Option* option,
                        const std::string& text) -> std::optional<std::vector<std::string>> {
    option->clear();
    option->add_result(text);
    try {
      option->run_callback();
    } catch (const CLI::Error&) {
      return std::nullopt;
    }
    return option->reduced_results();
  };
  long numbers = 0;
  for (CLI::App* command : app.get_subcommands(std::function<bool(CLI::App*)>()))
    for (CLI::Option* option : command->get_options()) {
      if (option->get_lnames().empty() || option->get_expected_max() != 1 || taken(option, "1.5") ||
          taken(option, "0.5"))
        continue;
      for (const std::string number : {"1", "8", "10", "100"}) {
        if (taken(option, number) != std::vector{number}) continue;
        CAPTURE(command->get_name(), option->get_name(), number);
        CHECK(taken(option, "0" + number).value_or(std::vector{number}) == std::vector{number});
        CHECK_FALSE(taken(option, "0x" + number));
        ++numbers;
      }
    }
  CHECK(numbers > 60);
  const Folder folder;
  const std::string file = folder.write("c.json", quick_campaign(4).dump());
  const std::string out = folder.path() / "r";
  CHECK(run_program(folder, {"run", file, "--out", out, "--runs", "012", "--seed", "0010"}).code ==
        0);
  const Json sampling = parse_json_file(out + "/campaign.json")["sampling"];
  CHECK((sampling["runs"] == 12 && sampling["seed"] == 10));
}

TEST_CASE("a folder may have the name of a command") {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"report", "rare"},
                                             {"report", "none", "rare"},
                                             {"merge", "none", "fit", "--out", "x"}}) {
    const auto refused = run_program(Folder(), arguments);
    CAPTURE(refused.error);
    CHECK(refused.code == 2);
    CHECK_THAT(refused.error, Catch::Contains("found no such folder"));
  }
}

TEST_CASE("the version and the methods") {
  const Folder folder;
  const std::string expected = "wingspread " + std::string(version()) + "\n";
  CHECK(run_program(folder, {"version"}).out == expected);
  CHECK(run_program(folder, {"--version"}).out == expected);
  const auto [code, out, error] = run_program(folder, {"methods"});
  CHECK(code == 0);
  CHECK(error.empty());
  CHECK(out == methods_text(methods()));
  const auto json = run_program(folder, {"methods", "--json"});
  CHECK(json.code == 0);
  CHECK(parse_json(json.out) == methods_json(methods()));
}

TEST_CASE("an empty argument is refused, wherever it stands") {
  const Folder folder;
  const std::string empty = ": found an empty argument, expected a value (a shell variable that is "
                            "not set?)\nerror: see wingspread ";
  const std::vector<std::pair<std::vector<std::string>, std::string>> list{
      {{"report", "a", ""}, "folders"},
      {{"report", ""}, "folders"},
      {{"report", "a", "--out", ""}, "--out"},
      {{"run", "c.json", "--out", ""}, "--out"},
      {{"check", ""}, "file"},
      {{"check", "s.json", "--draw", ""}, "--draw"},
      {{"simulate", "s.json", "--out", ""}, "--out"},
      {{"analyze", "a", "--requirements", ""}, "--requirements"},
      {{"merge", "a", "", "--out", "b"}, "folders"},
      {{"new", "--out", ""}, "--out"},
      {{"sensitivity", "a", "--out", ""}, "--out"},
      {{"export", "", "--out", "x.h5"}, "folder"}};
  for (const auto& [arguments, place] : list) {
    CAPTURE(arguments, place);
    const auto [code, out, error] = run_program(folder, arguments);
    CHECK(code == 2);
    CHECK(out.empty());
    CHECK(error == "error: " + place + empty + arguments.front() + " --help\n");
  }
}

// A number's limits are in its line of --help: "from 1 to 1024", "> 0 and < 1", "at least 0".
TEST_CASE("the help of a command says the limits of every number") {
  const Folder folder;
  const std::regex number(R"(  --(\S+) (N|K|L|R|S|INT|UINT|FLOAT|SCALE)( |$).*)"),
      wrapped(R"(\n {28,})"), limits(R"(from \S+ to |at least |> 0|≥ 0|1, 2, 4 or 8|each > 0)");
  long numbers = 0;
  for (const Command& command : all_commands()) {
    const std::string help = run_program(folder, {std::string(command.name), "--help"}).out;
    for (const std::string& line : lines_of(std::regex_replace(help, wrapped, " "))) {
      if (!std::regex_match(line, number)) continue;
      CAPTURE(command.name, line);
      CHECK(std::regex_search(line, limits));
      ++numbers;
    }
  }
  CHECK(numbers > 40);
}

TEST_CASE("a program without MPI that mpirun starts several times warns of it once") {
  const Folder folder;
  const auto warned = [&](const char* size, const char* rank) {
    setenv("OMPI_COMM_WORLD_SIZE", size, 1);
    setenv("OMPI_COMM_WORLD_RANK", rank, 1);
    const Finished end = run_program(folder, {"--version"});
    unsetenv("OMPI_COMM_WORLD_SIZE");
    unsetenv("OMPI_COMM_WORLD_RANK");
    CHECK(end.code == 0);
    return end.error;
  };
  CHECK_THAT(warned("4", "0"), HasFacts({"warning: mpirun", " 4 times", "MPI"}));
  CHECK(warned("4", "3").empty());
  CHECK(warned("1", "0").empty());
}
