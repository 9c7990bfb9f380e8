#include "montecarlo/report/text/method_list.hpp"
#include "montecarlo/results/results_folder/version.hpp"
#include "tests/cli/program.hpp"

#include <catch2/catch.hpp>

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
       "error: The following argument was not expected: frobnicate\n"
       "error: see wingspread --help\n"},
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
       "error: --runs: Value 0 not in range 1 to 2147483647\n"
       "error: see wingspread run --help\n"},
      {{"run", "c.json", "--out", "r", "--threads", "0"},
       "error: --threads: Value 0 not in range 1 to 1024\nerror: see wingspread run --help\n"},
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
