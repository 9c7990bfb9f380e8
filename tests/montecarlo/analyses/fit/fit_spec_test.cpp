#include "montecarlo/analyses/fit/fit_spec.hpp"
#include "montecarlo/engine/runs/runner.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <functional>
#include <sstream>

using namespace wingspread;
using namespace wingspread::test;

namespace {

Json tests_json() {
  return parse_json(
      R"({ "tests": [ { "name": "one", "case": "cold", "set": { "hinges.root.initial_rate": "10 deg/s" },
      "trace": { "file": "t1.csv", "time": "t", "time_offset_std": "5 ms", "correlated": false,
        "columns": { "root.angle": { "column": "th", "unit": "deg", "std": "0.3 deg", "offset_std": "0.2 deg" },
                     "root.rate": { "column": "w" } } },
      "values": [ { "output": "root.latch_time", "value": "4.93 s", "std": "20 ms" },
                  { "parameter": "hinges.root.friction.scale", "value": 1.1, "std": 0.1 } ],
      "own": ["fric*"] } ],
    "fit": { "parameters": ["spring", "friction"], "starts": 4, "samples": 500 } })");
}

constexpr const char* trace = "t,th,w [deg/s]\n0,86,0\n0.1,85.5,-1\n0.2,84,-2\n0.3,82,-3\n";

struct Files {
  explicit Files(const std::string& text = trace) {
    folder.write("t1.csv", text);
    Json json = panel_campaign();
    json["cases"] =
        parse_json(R"([ { "name": "cold", "scale": { "hinges.root.friction.scale": 3 } } ])");
    json["dispersions"].push_back(
        parse_json(R"({ "name": "lot", "apply": "set", "to": ["bodies.panel.mass"],
      "distribution": { "type": "discrete", "values": [9, 10], "weights": [1, 1] } })"));
    campaign = campaign_of(json);
  }
  [[nodiscard]] FitSpec read(const Json& json) const {
    return read_fit(json, "tests.json", folder.path(), campaign);
  }
  /// The problems, without the folder's path.
  [[nodiscard]] std::string problems(const Json& json) const {
    std::string text = message_of([&] { return read(json); });
    const std::string path = folder.path().string() + "/";
    for (std::size_t at; (at = text.find(path)) != std::string::npos;) text.erase(at, path.size());
    return text;
  }
  Folder folder;
  Campaign campaign;
};

} // namespace

TEST_CASE("tests: case, changes, traces in SI, values, own parameters") {
  const Files files;
  const FitSpec spec = files.read(tests_json());
  CHECK(spec.parameters == std::vector<std::size_t>{0, 1});
  CHECK((spec.starts == 4 && spec.samples == 500));
  const FitTest& test = spec.tests.at(0);
  constexpr double degree = M_PI / 180;
  CHECK(test.campaign.scene.hinges[0].friction.scale == 3);
  CHECK(test.campaign.scene.hinges[0].initial_rate == Approx(10 * degree));
  CHECK(test.campaign.cases.empty());
  CHECK(test.campaign.outputs.contains(OutputFamily::latch_time));
  CHECK(test.times == std::vector<double>{0, 0.1, 0.2, 0.3});
  CHECK((test.time_offset_std == Approx(0.005) && !test.correlated));
  REQUIRE(test.columns.size() == 2);
  CHECK(test.columns[0].measured[1] == Approx(85.5 * degree));
  CHECK(*test.columns[0].std == Approx(0.3 * degree));
  CHECK(test.columns[0].offset_std == Approx(0.2 * degree));
  CHECK(test.columns[1].measured[2] == Approx(-2 * degree)); // the header's unit
  CHECK_FALSE(test.columns[1].std);
  CHECK((test.values[0].measured == 4.93 && test.values[0].std == 0.02));
  CHECK((test.values[1].parameter && test.values[1].measured == 1.1));
  CHECK(test.own == std::vector<std::size_t>{1});
}

TEST_CASE("a fitted dispersion's name ends in no unit, which its column would be read in") {
  Json json = panel_campaign();
  for (const char* name : {"spring [g]", "k [N*m]", "spring [-]x", "spring [left]"}) {
    json["dispersions"][0]["name"] = name;
    const Campaign campaign = campaign_of(json);
    Json tests = parse_json(R"({ "tests": [ { "name": "one",
      "values": [ { "output": "root.latch_time", "value": 2, "std": 0.1 } ] } ],
      "fit": { "parameters": [""] } })");
    tests["fit"]["parameters"][0] = name;
    const std::string problem =
        message_of([&] { return read_fit(tests, "t.json", ".", campaign); });
    CAPTURE(name, problem);
    const bool is_unit_of = std::string(name).ends_with("[g]") || name[0] == 'k';
    CHECK(problem.starts_with("t.json: /fit/parameters/0: ") == is_unit_of);
    CHECK(problem.empty() == !is_unit_of);
  }
}

TEST_CASE("each fault of the tests has its place") {
  const Files files;
  const auto change = [&](const char* pointer, const char* value) {
    return files.problems(spoil(tests_json(), {pointer, value, ""}));
  };
  CHECK(files.problems(tests_json()).empty());
  CHECK(change("/fit/parameters/0", R"("sprink")") ==
        "tests.json: /fit/parameters/0: found \"sprink\", expected the name of a dispersion (did "
        "you mean \"spring\"?)");
  CHECK(change("/fit/parameters/0", R"("lot")").find("whose law has steps") != std::string::npos);
  CHECK(change("/fit/parameters/1", R"("spring")").find("\"spring\" a second time") !=
        std::string::npos);
  CHECK(change("/tests/0/case", R"("colt")")
            .starts_with("tests.json: /tests/0/case: found \"colt\""));
  CHECK(change("/tests/0/set", R"({ "hinges.roof.initial_rate": 1 })")
            .starts_with("tests.json: /tests/0/set/hinges.roof.initial_rate: found the path"));
  CHECK(change("/tests/0/set", R"({ "bodies.panel.mass": 9 })").find("\"lot\" sets in every run") !=
        std::string::npos);
  CHECK(change("/tests/0/set", R"({ "bodies.panel.inertia": -1 })")
            .find("bodies.panel.inertia of -1") != std::string::npos);
  Json twice = tests_json();
  Json nameless = twice;
  nameless["tests"][0]["name"] = "", nameless["tests"].push_back(nameless["tests"][0]);
  CHECK_THAT(files.problems(nameless),
             Catch::Contains("/tests/1/name") && !Catch::Contains("a name of its own"));
  twice["tests"][0]["values"].push_back(twice["tests"][0]["values"][0]);
  CHECK(
      files.problems(twice).starts_with("tests.json: /tests/0/values/2: found a second value of"));
  CHECK(change("/tests/0/trace/file", R"("none.csv")")
            .starts_with("tests.json: /tests/0/trace/file: found no file"));
  CHECK(change("/tests/0/trace/columns", R"({ "tip.angle": "th" })") ==
        "tests.json: /tests/0/trace/columns/tip.angle: found \"tip.angle\", expected a column of "
        "the trajectory (did you mean \"root.angle\"?)");
  CHECK(change("/tests/0/trace/columns/root.angle/unit", R"("deg/s")")
            .starts_with("tests.json: /tests/0/trace/columns/root.angle: found the unit \"deg/s\" "
                         "of the column \"th\", expected one such as"));
  CHECK(change("/tests/0/trace/columns/root.rate", R"({ "column": "w", "unit": "rad/s" })")
            .find("the unit \"rad/s\", and \"deg/s\" in the header") != std::string::npos);
  CHECK(change("/tests/0/trace/columns/root.angle/column", R"("th2")").find("a column of t1.csv") !=
        std::string::npos);
  CHECK(change("/tests/0/values/0/output", R"("root.latch_tim")")
            .find("did you mean \"root.latch_time\"?") != std::string::npos);
  for (const char* word : {R"("deployed")", R"("latch_order")", R"("status")"})
    CHECK(change("/tests/0/values/0/output", word)
              .find("which is no number, expected a number that a test measures, such as "
                    "\"root.latch_time\"") != std::string::npos);
  CHECK(change("/tests/0/values/0/std", R"("20 deg")")
            .starts_with("tests.json: /tests/0/values/0/std"));
  CHECK(change("/tests/0/values/1/parameter", R"("hinges.*.x")")
            .starts_with("tests.json: /tests/0/values/1/parameter"));
  CHECK(change("/tests/0/own/0", R"("lot")") ==
        "tests.json: /tests/0/own/0: found \"lot\", which is not fitted, expected one of "
        "fit.parameters");
  CHECK(change("/tests/0/tracee", "1").find("the unknown key \"tracee\"") != std::string::npos);
  CHECK(change("/candidates", R"([ { "name": "x", "own": ["spring"], "values":
          [ { "output": "root.latch_time", "std": 1 } ] } ])")
            .starts_with("tests.json: /candidates/0/own"));
}

TEST_CASE("fewer samples than unknowns are enough where the noise is known") {
  const Files files;
  files.folder.write("short.csv", "t,angle\n0,1.5\n0.5,1.4\n0.7,1.3\n");
  Json tests = parse_json(R"({ "tests": [ { "name": "t", "own": ["friction"],
      "trace": { "file": "short.csv", "time": "t",
                 "columns": { "root.angle": { "column": "angle", "std": 0.1 } } },
      "values": [ { "output": "root.latch_time", "value": 2, "std": 0.1 } ] } ],
    "fit": { "parameters": ["spring", "friction"] } })");
  const auto of_trace = [&]() -> Json& { return tests["tests"][0]["trace"]; };
  const auto column = [&]() -> Json& { return of_trace()["columns"]["root.angle"]; };
  const auto refused = [&](const char* what) {
    return files.problems(tests).starts_with(
        std::string("tests.json: /tests/0/trace/columns/root.angle: found ") + what);
  };
  of_trace()["time_offset_std"] = 0.02;
  column()["offset_std"] = 0.01;
  CHECK(files.problems(tests) == "");
  column().erase("std"); // the test's own friction replaces that of all tests
  CHECK(refused("3 samples for 4 unknowns"));
  column().erase("offset_std");
  CHECK(refused("3 samples for 3 unknowns"));
  of_trace().erase("time_offset_std");
  CHECK(files.problems(tests) == "");
}

TEST_CASE("the numbers of a fit are accepted up to their limits, and no further") {
  const Files files;
  Json json = tests_json();
  json["candidates"] =
      parse_json(R"([ { "name": "next", "trace": { "times": { "to": 2, "step": 0.5 },
      "columns": { "root.angle": { "std": 0.01 } } } } ])");
  const auto check = [&](const char* pointer, const Json& good, const Json& bad) {
    CAPTURE(pointer, good, bad);
    Json changed = json;
    changed[Json::json_pointer(pointer)] = good;
    CHECK(files.problems(changed).empty());
    changed[Json::json_pointer(pointer)] = bad;
    CHECK_THAT(files.problems(changed), Catch::StartsWith("tests.json: /"));
  };
  check("/fit/starts", 1, 0);
  check("/fit/starts", 1000, 1001);
  check("/fit/samples", 100, 99);
  check("/fit/samples", 10'000'000, 10'000'001);
  check("/candidates/0/trace/times/to", 0.5, 0.4);       // at least the first step
  check("/candidates/0/trace/times/step", 2e-5, 1.9e-5); // 1e5 times
  check("/candidates/0/trace/times/step", 2, 0);
}

TEST_CASE("no object of the tests has a key that is not read") {
  const Files files;
  Json json = tests_json();
  json["tests"][0]["trace"]["time"] = {{"column", "t"}, {"unit", "s"}};
  json["candidates"] = parse_json(
      R"([ { "name": "next", "trace": { "times": { "to": 2, "step": 0.5 },
        "columns": { "root.angle": { "std": 0.01, "offset_std": 0.01 } } },
        "values": [ { "output": "root.latch_time", "std": 0.1 } ] } ])");
  REQUIRE(files.problems(json).empty());
  const auto message_for = [&](const Json& changed) { return files.problems(changed); };
  CHECK(objects_with_unread_keys(json, message_for) == std::vector<std::string>{});
}

TEST_CASE("each fault of a trace has its line") {
  const auto with = [&](const std::string& text) { return Files(text).problems(tests_json()); };
  CHECK(with("t,th,w\n0,86,0\n0.2,85.5,-1\n0.1,84,-2\n") ==
        "t1.csv: line 4, column 't': found 0.1 after 0.2, expected ascending times: sort the rows");
  CHECK(
      with("t,th,w\n0,86,0\n0.2,85.5,-1\n0.20,84,-2\n") ==
      "t1.csv: line 4, column 't': found 0.20 after 0.2, expected each time once: drop one of the "
      "rows");
  CHECK(with("t;th;w\n0;86;0\n0.2;85.5;-1\n") ==
        "tests.json: /tests/0/trace/file: found one column in the header of t1.csv: \"t;th;w\", "
        "expected columns separated by commas");
  CHECK(with("t,th,w\n0,86,0\n0.1,x,-1\n") == "t1.csv: line 3, column 'th': found 'x', expected a "
                                              "finite number: leave out rows that lack one");
  CHECK(with("t,th,w\n0,86,0\n0.1,86\n") ==
        "t1.csv: line 3: found 2 cells, expected 3, as in the header");
  CHECK(with("t,th,w\n0,86,0\n0.1,86,-1\n0.2,86,-2\n").find("\"th\", which is 86 in every row") !=
        std::string::npos);
  CHECK(with("t,th,w\n0,86,0\n").find("1 row in t1.csv") != std::string::npos);
  CHECK_THAT(
      with("t,th,w\n-3,86,0\n-2,85,-1\n-0,84,-1\n"),
      Catch::Contains("/tests/0/trace/time: found times that end at -0 s in t1.csv, before the "
                      "run begins, expected times since the run begins"));
  CHECK_THAT(with("t,th,w\n0,86,0\n1e300,85,-1\n"),
             Catch::Contains("/tests/0/trace/time: found times up to 1e+300 s"));
  CHECK(with("").find("no header") != std::string::npos);
}

TEST_CASE("empty lines in a trace are no rows; one cell too few or too many is a fault") {
  const std::string rows = "0,86,0\n0.1,85.5,-1\n0.2,84,-2\n";
  const std::string whole = Files("t,th,w\n" + rows).problems(tests_json());
  for (const std::string& text :
       {"t,th,w\n" + rows + "\n", "t,th,w\n\n" + rows, "t,th,w\r\n\r\n" + rows + "\n\n"}) {
    CAPTURE(text);
    CHECK(Files(text).problems(tests_json()) == whole);
  }
  for (const char* row : {"0.3\n", "0.3,80\n", "0.3,80,-3,1\n", ",\n"})
    CHECK_THAT(Files("t,th,w\n" + rows + row).problems(tests_json()),
               Catch::Contains("t1.csv: line 5: found ") &&
                   Catch::EndsWith("expected 3, as in the header"));
}

TEST_CASE("a trace of another unit, sense, column or zero of time is refused") {
  const Folder folder;
  const Campaign campaign = campaign_of(panel_campaign());
  const auto told = [&](const std::function<std::string(double t, double angle)>& row,
                        const char* column = "root.angle") {
    std::string text = "t,th\n";
    for (int k = 0; k <= 80; ++k) text += row(0.02 * k, panel_angle(0.02 * k, 1.03, 0.8)) + "\n";
    folder.write("t1.csv", text);
    Json tests =
        parse_json(R"({ "tests": [ { "name": "one", "trace": { "file": "t1.csv", "time": "t",
      "columns": {} } } ], "fit": { "parameters": ["spring", "friction"] } })");
    tests["tests"][0]["trace"]["columns"][column] = {{"column", "th"}, {"std", 0.01}};
    return message_of([&] { return read_fit(tests, "t", folder.path(), campaign); });
  };
  constexpr const char* at_column = "t: /tests/0/trace/columns/root.angle: ";
  const auto row = [](double t, double angle) { return csv_cell(t) + "," + csv_cell(angle); };
  CHECK(told(row).empty());
  CHECK(told([&](double t, double angle) { return row(t, angle * 180 / M_PI); }) ==
        std::string(at_column) +
            "found numbers 57.3 times those of the motion, expected a \"unit\" "
            "that fits the numbers: \"rad\" or \"deg\"?");
  CHECK(told([&](double t, double angle) { return row(t, -angle); }) ==
        std::string(at_column) + "found the motion in the opposite sense, expected the sense of "
                                 "root.angle, towards the latched angle as in the scene");
  CHECK(told([&](double t, double angle) { return row(1000 * t, angle); }) ==
        "t: /tests/0/trace/time: found times a thousand times too long for the motion, as in "
        "milliseconds, expected seconds, or \"time\": { \"column\": \"t\", \"unit\": \"ms\" }");
  CHECK(told([&](double t, double angle) { return row(t + 7, angle); }) ==
        "t: /tests/0/trace/time: found times that begin at 7 s, with a motion that begins there, "
        "expected times since the release");
  const auto travel = [&](double factor) {
    return told(
        [&, factor](double t, double angle) { return row(t, factor * (panel_travel - angle)); });
  };
  CHECK_THAT(
      travel(1),
      Catch::Contains(std::string(at_column) +
                      "found the travel from the start of the motion, in the opposite sense") &&
          Catch::Contains("stowed angle"));
  CHECK_THAT(travel(-1),
             Catch::Contains("found the travel from the start") && !Catch::Contains("opposite"));
  CHECK_THAT(travel(180 / M_PI),
             Catch::Contains("in the opposite sense") && Catch::Contains("\"unit\""));
  for (const double factor :
       {0.5 / M_PI, 1 / 360.0, 1e3 * M_PI / 180}) // turns; turns, milliradians as degrees
    CHECK_THAT(told([&, factor](double t, double angle) { return row(t, factor * angle); }),
               Catch::Contains("times those of the motion"));
  const auto late = [&](double by, double std) {
    std::string text = "t,th\n";
    for (int k = 0; k <= 80; ++k)
      text += row(0.02 * k + by, panel_angle(0.02 * k, 1.03, 0.8)) + "\n";
    folder.write("t1.csv", text);
    Json tests =
        parse_json(R"({ "tests": [ { "name": "one", "trace": { "file": "t1.csv", "time": "t",
      "columns": { "root.angle": { "column": "th", "std": 0.01 } } } } ], "fit": { "parameters": ["spring", "friction"] } })");
    if (std > 0) tests["tests"][0]["trace"]["time_offset_std"] = std;
    return message_of([&] { return read_fit(tests, "t", folder.path(), campaign); });
  };
  CHECK_THAT(late(1.5, 0.2), Catch::Contains("times that begin at 1.5 s"));
  CHECK(late(1.5, 0.5).empty()); // a clock that may be so far off
  // a wrong trace that nothing explains is for the fit to judge
  CHECK(told([&](double t, double) { return row(t, std::sin(9 * t)); }).empty());
}

TEST_CASE("a trace of another hinge is refused, with its name") {
  const Folder folder;
  Json json = panel_campaign();
  Json& scene = json["scene"];
  scene["bodies"].push_back({{"name", "outer"}, {"mass", 1}, {"inertia", 0.1}});
  Json hinge = scene["hinges"][0];
  hinge["name"] = "tip", hinge["parent"] = "panel", hinge["child"] = "outer";
  hinge["parent_point"] = {0.5, 0};
  hinge["angle"] = {{"stowed", -2.5}, {"latched", 0}};
  scene["hinges"].push_back(hinge);
  const Campaign campaign = campaign_of(json);
  const RunPlan plan(campaign, {}, SampledColumns{{1, 4}, 0.02, 1});
  const std::vector<double> samples = Runner(plan).run(3).outputs;
  std::string text = "t,a,b\n";
  for (std::size_t k = 0; k < samples.size() / 4; ++k)
    text += csv_cell(0.02 * static_cast<double>(k)) + "," + csv_cell(samples[4 * k]) + "," +
            csv_cell(samples[4 * k + 2]) + "\n";
  folder.write("t1.csv", text);
  const auto told = [&](const char* root, const char* tip) {
    Json tests =
        parse_json(R"({ "tests": [ { "name": "one", "trace": { "file": "t1.csv", "time": "t" } } ],
      "fit": { "parameters": ["spring", "friction"] } })");
    tests["tests"][0]["trace"]["columns"] = {{"root.angle", root}, {"tip.angle", tip}};
    return message_of([&] { return read_fit(tests, "t", folder.path(), campaign); });
  };
  CHECK(told("a", "b").empty());
  CHECK(told("b", "a").find("t: /tests/0/trace/columns/root.angle: found the motion of tip.angle, "
                            "expected the motion of root.angle: is it another hinge's column?") !=
        std::string::npos);
  // another clock is told once, not of every column
  for (const auto& [times, later] : {std::pair(1000.0, 0.0), {1.0, 7.0}}) {
    std::istringstream rows(text);
    std::string changed, row;
    std::getline(rows, changed);
    while (std::getline(rows, row)) {
      const std::size_t comma = row.find(',');
      changed +=
          '\n' + csv_cell(times * std::stod(row.substr(0, comma)) + later) + row.substr(comma);
    }
    folder.write("t1.csv", changed + '\n');
    const std::string message = told("a", "b");
    CAPTURE(message);
    CHECK_THAT(message, Catch::StartsWith("t: /tests/0/trace/time: found times"));
    CHECK(std::ranges::count(message, '\n') == 0);
  }
}

TEST_CASE("a correlation of a fitted and another dispersion is refused") {
  const Folder folder;
  folder.write("t1.csv", trace);
  Json json = panel_campaign();
  json["correlations"] =
      parse_json(R"([ { "between": ["spring", "friction"], "spearman": 0.5 } ])");
  Json tests = tests_json();
  tests["fit"]["parameters"] = {"spring"};
  tests["tests"][0].erase("own");
  tests["tests"][0].erase("case");
  const std::string message =
      message_of([&] { return read_fit(tests, "", folder.path(), campaign_of(json)); });
  CHECK(message.find("one of \"spring\" and \"friction\", which the campaign correlates") !=
        std::string::npos);
}
