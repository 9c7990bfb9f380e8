#include "montecarlo/model/campaign/distribution_json.hpp"
#include "tests/montecarlo/spec_support.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;

namespace {

/// What came of a distribution, and of a CSV file "data.csv" beside it.
struct ReadDistribution {
  Distribution distribution;
  std::string problems;
};

ReadDistribution read_law(const std::string& json, const std::string& csv = "") {
  const test::Folder folder;
  folder.write("data.csv", csv);
  ReadDistribution reading;
  reading.problems = test::problems_of(parse_json(json), [&](const JsonCursor& at) {
    reading.distribution = read_distribution(at, folder.path());
  });
  // The folder differs from machine to machine.
  const std::string prefix = folder.path().string() + "/";
  for (auto at = reading.problems.find(prefix); at != std::string::npos;
       at = reading.problems.find(prefix))
    reading.problems.erase(at, prefix.size());
  return reading;
}

constexpr const char* from_file = R"({"type": "empirical", "file": "data.csv", "column": "x"})";

} // namespace

TEST_CASE("Every law is written as it was read", "[distribution_json]") {
  const char* json = GENERATE(
      R"({"type":"normal","mean":1.5,"std":0.05})",
      R"({"type":"uniform","lower":-1.0,"upper":2.0})",
      R"({"type":"triangular","lower":0.0,"mode":0.25,"upper":1.0})",
      R"({"type":"lognormal","mu_log":0.5,"sigma_log":0.1})",
      R"({"type":"weibull","shape":1.5,"scale":2.0})",
      R"({"type":"gamma","shape":3.0,"scale":0.5})",
      R"({"type":"beta","alpha":2.0,"beta":5.0,"lower":0.5,"upper":1.5})",
      R"({"type":"exponential","rate":4.0})",
      R"({"type":"discrete","values":[1.0,2.5],"weights":[3.0,0.0]})",
      R"({"type":"empirical","values":[3.0,1.0,2.0]})", R"({"type":"constant","value":7.0})",
      R"({"type":"normal","mean":0.0,"std":1.0,"truncate":{"lower":-3.0,"upper":3.0}})",
      R"({"type":"exponential","rate":1.0,"truncate":{"upper":3.0}})");
  const auto [distribution, problems] = read_law(json);
  CHECK(problems.empty());
  CHECK(write_distribution(distribution).dump() == json);
  CHECK(type_of(distribution.law) == parse_json(json)["type"]);
}

TEST_CASE("Each fault of a distribution is told", "[distribution_json]") {
  struct Case {
    const char *json, *message;
  };
  const auto [json, message] = GENERATE(values<Case>(
      {{"3", "found 3, expected a distribution: an object with its type"},
       {"{}",
        "/type: found nothing, expected \"normal\", \"uniform\", \"triangular\", \"lognormal\", "
        "\"weibull\", \"gamma\", \"beta\", \"exponential\", \"discrete\", \"empirical\" or "
        "\"constant\""},
       {R"({"type": "gauss"})", "/type: found string \"gauss\", expected \"normal\", \"uniform\", "
                                "\"triangular\", \"lognormal\", "
                                "\"weibull\", \"gamma\", \"beta\", \"exponential\", \"discrete\", "
                                "\"empirical\" or \"constant\""},
       {R"({"type": "normal", "mean": "one", "sigma": 1})",
        "/mean: found string \"one\", expected a number\n"
        "/std: found nothing, expected a number, > 0\n"
        "/sigma: found the unknown key \"sigma\", expected \"type\", \"mean\", \"std\" or "
        "\"truncate\""},
       {R"({"type": "normal", "mean": 1, "std": -2})", "/std: found -2, expected > 0"},
       {R"({"type": "beta", "alpha": 2, "beta": 1e19, "lower": 0, "upper": 1})",
        "/beta: found 1e+19, expected > 0 and ≤ 1e6"},
       {R"({"type": "beta", "alpha": 2, "lower": 0, "upper": 1})",
        "/beta: found nothing, expected a number, > 0 and ≤ 1e6"},
       {R"({"type": "discrete", "values": [1, 2], "weights": [1, -1]})",
        "/weights/1: found -1, expected ≥ 0"},
       {R"({"type": "discrete", "values": [1, "a"], "weights": 1})",
        "/values/1: found string \"a\", expected a number\n"
        "/weights: found 1, expected an array of numbers, ≥ 0"},
       {R"({"type": "normal", "mean": 0, "std": 1, "truncate": 3})",
        "/truncate: found 3, expected an object with lower and upper"},
       {R"({"type": "normal", "mean": 0, "std": 1, "truncate": {}})",
        "/truncate: found neither lower nor upper, expected at least one of them"},
       {R"({"type": "normal", "mean": 0, "std": 1, "truncate": {"lower": null, "uper": 1}})",
        "/truncate/lower: found null, expected a number\n"
        "/truncate/uper: found the unknown key \"uper\", expected \"lower\" or \"upper\" (did you "
        "mean "
        "\"upper\"?)"},
       {R"({"type": "constant", "value": 0, "truncate": {"lower": 1}})",
        "/truncate: found a truncated constant law, expected a continuous law"},
       {R"({"type": "empirical"})", "/values: found nothing, expected an array of numbers"},
       {R"({"type": "empirical", "values": []})", "/values: found none, expected at least one"},
       {R"({"type": "empirical", "file": "data.csv"})",
        "/column: found nothing, expected a string, a column's name in the header"},
       {R"({"type": "empirical", "column": "x"})",
        "/file: found nothing, expected a string, the name of a CSV file"},
       {R"({"type": "empirical", "file": "none.csv", "column": "x"})",
        "/file: found no file that can be read at \"none.csv\", expected a CSV file"},
       {R"({"type": "empirical", "values": [1], "file": "none.csv", "column": "x"})",
        "found both values and a file, expected either of them\n"
        "/file: found no file that can be read at \"none.csv\", expected a CSV file"}}));
  CAPTURE(json);
  CHECK(test::facts_of(read_law(json).problems) == test::facts_of(message));
}

TEST_CASE("A value out of its range is told beside one that cannot be read",
          "[distribution_json]") {
  CHECK(read_law(R"({"type": "normal", "mean": "x", "std": -1})").problems ==
        "/mean: found string \"x\", expected a number\n/std: found -1, expected > 0");
  CHECK(read_law(R"({"type": "discrete", "values": [1, "x"], "weights": [-1, 2]})").problems ==
        "/values/1: found string \"x\", expected a number\n/weights/0: found -1, expected ≥ 0");
  // an end that was not read is no bound of the other, and a value that was not read has no range
  CHECK(read_law(R"({"type": "uniform", "lower": "x", "upper": -5})").problems ==
        "/lower: found string \"x\", expected a number");
  CHECK(read_law(R"({"type": "normal", "mean": 1, "std": "x"})").problems ==
        "/std: found string \"x\", expected a number, > 0");
}

TEST_CASE("An empirical law takes a column of a CSV file", "[distribution_json]") {
  const char* csv =
      GENERATE("x,y\n1,0\n-2.5e-3,0\n3,0\n", "y,\"x\"\r\n0,1\r\n0,-0.0025\r\n\r\n0,3");
  const auto [distribution, problems] = read_law(from_file, csv);
  CHECK(problems.empty());
  CHECK(std::get<Empirical>(distribution.law).values == std::vector<double>{1, -0.0025, 3});
}

TEST_CASE("Each fault of the CSV file is told with its line", "[distribution_json]") {
  struct Case {
    const char *csv, *message;
  };
  const auto [csv, message] = GENERATE(values<Case>(
      {{"", "data.csv: line 1, column 'x': found no such column, expected it once in the header"},
       {"y\n1\n",
        "data.csv: line 1, column 'x': found no such column, expected it once in the header"},
       {"x,x\n1,1\n",
        "data.csv: line 1, column 'x': found it more than once, expected it once in the header"},
       {"x,y\n1,2\n1\n", "data.csv: line 3: found 1 cells, expected 2, as in the header"},
       {"x\n1\n1 m\n", "data.csv: line 3, column 'x': found '1 m', expected a finite number"},
       {"x\ninf\n", "data.csv: line 2, column 'x': found 'inf', expected a finite number"},
       {"x,y\n,2\n", "data.csv: line 2, column 'x': found '', expected a finite number"},
       // of a single column an empty line is a number that is missing
       {"x\n1\n\n2\n", "data.csv: line 3, column 'x': found '', expected a finite number"},
       {"x\n", "/values: found none, expected at least one"}}));
  CAPTURE(csv);
  CHECK(test::facts_of(read_law(from_file, csv).problems) == test::facts_of(message));
}
