#include "montecarlo/analyses/fit/fit_spec.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"

#include <catch2/catch.hpp>

#include <numbers>

using namespace wingspread;
using namespace wingspread::test;

TEST_CASE("a trace whose numbers are in another unit is refused with the factor between them") {
  const Folder folder;
  const Campaign campaign = campaign_of(panel_campaign());
  const auto refusal = [&](double factor, double std) {
    std::string text = "t,th\n";
    for (int k = 0; k <= 80; ++k)
      text += csv_cell(0.02 * k) + "," + csv_cell(factor * panel_angle(0.02 * k, 1.03, 0.8)) + "\n";
    folder.write("t1.csv", text);
    Json tests =
        parse_json(R"({ "tests": [ { "name": "one", "trace": { "file": "t1.csv", "time": "t",
      "columns": { "root.angle": { "column": "th" } } } } ], "fit": { "parameters": ["spring", "friction"] } })");
    tests["tests"][0]["trace"]["columns"]["root.angle"]["std"] = std;
    return message_of([&] { return read_fit(tests, "t", folder.path(), campaign); });
  };
  CHECK(refusal(1, 0.01).empty());
  constexpr double degrees = 180 / std::numbers::pi;
  for (const auto& [factor, printed, is_angle] :
       {std::tuple(degrees, "57.3", true), std::tuple(1 / degrees, "0.0175", true),
        std::tuple(1e3, "1e+03", false), std::tuple(1e-3, "0.001", false)}) {
    const std::string told = refusal(factor, 0.01);
    CAPTURE(factor, told);
    CHECK_THAT(told, Catch::Contains("/columns/root.angle: found numbers " + std::string(printed) +
                                     " times those of the motion"));
    CHECK((told.find("\"deg\"") != std::string::npos) == is_angle);
  }
}

TEST_CASE("a header's unit counts whether the column is named with it or without") {
  const Folder folder;
  const Campaign campaign = campaign_of(panel_campaign());
  std::string rows;
  constexpr double degrees = 180 / std::numbers::pi;
  for (int k = 0; k <= 80; ++k)
    rows += csv_cell(20.0 * k) + "," + csv_cell(degrees * panel_angle(0.02 * k, 1.03, 0.8)) + "," +
            csv_cell(panel_angle(0.02 * k, 1.03, 0.8)) + "\n";
  const auto measured = [&](const char* time, const char* column) {
    Json tests = parse_json(R"({ "tests": [ { "name": "one", "trace": { "file": "t1.csv",
      "columns": { "root.angle": { "std": 0.01 } } } } ], "fit": { "parameters": ["spring", "friction"] } })");
    tests["tests"][0]["trace"]["time"] = time;
    tests["tests"][0]["trace"]["columns"]["root.angle"]["column"] = column;
    const FitSpec spec = read_fit(tests, "t", folder.path(), campaign);
    return std::pair(spec.tests[0].times.back(), spec.tests[0].columns[0].measured.back());
  };
  const double last = panel_angle(1.6, 1.03, 0.8);
  for (const std::string header :
       {"t [ms],th [deg],side (left)", " t [ms] ,  th [deg], side (left) "}) {
    folder.write("t1.csv", header + "\n" + rows);
    for (const char* time : {"t", "t [ms]"})
      for (const char* column : {"th", "th [deg]", "side (left)"}) {
        CAPTURE(time, column);
        CHECK(measured(time, column).first == Approx(1.6));
        CHECK(measured(time, column).second == Approx(last).margin(1e-9));
      }
  }
}
