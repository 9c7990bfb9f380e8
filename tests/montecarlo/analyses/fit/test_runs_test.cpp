#include "montecarlo/analyses/fit/test_runs.hpp"
#include "montecarlo/engine/mpi/rank_evaluator.hpp"
#include "tests/montecarlo/analyses/fit/fit_support.hpp"
#include "tests/montecarlo/engine/mpi/memory_transport.hpp"

#include <catch2/catch.hpp>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A trace with a clock offset and a latch time of one test; a moment's trace of another.
constexpr const char* two_tests = R"({ "tests": [
    { "name": "angle", "trace": { "file": "t1.csv", "time": "t", "time_offset_std": "10 ms",
        "columns": { "root.angle": { "column": "th", "std": 0.005 } } },
      "values": [ { "output": "root.latch_time", "value": 2, "std": 0.01 } ] },
    { "name": "moment", "set": { "hinges.root.initial_rate": 0.5 },
      "trace": { "file": "t1.csv", "time": "t", "columns": { "root.moment": { "column": "th", "std": 0.1 } } } } ],
  "fit": { "parameters": ["spring", "friction"] } })";

std::vector<Prediction> predictions(const Campaign& campaign, const FitSpec& spec,
                                    Evaluator& evaluator, RunAccuracy accuracy) {
  const ParameterSpace space(campaign, spec);
  TestRuns runs(spec.tests, spec.parameters, space, evaluator);
  std::vector<FitPoint> points;
  for (int k = 0; k < 20; ++k) {
    points.emplace_back(FitPoint::Constant(static_cast<Eigen::Index>(space.size()), 0.1 * k - 1));
    points.back()[1] = 0.3;
  }
  return runs.predict(points, accuracy);
}

} // namespace

TEST_CASE("several ranks predict tests as one does, bit by bit", "[parallel]") {
  const Folder folder;
  folder.write("t1.csv", panel_trace(1, 1, 0, 0.005, 1));
  folder.write("rows.csv", "mass,lever\n10,-0.5\n11,-0.55\n9.5,-0.52\n");
  Json json = panel_campaign();
  json["integration"]["rtol"] = 1e-6;
  Json rows = parse_json(R"({ "name": "flight", "rows": { "file": "rows.csv", "apply": "set",
    "columns": { "mass": "bodies.panel.mass", "lever": { "to": ["hinges.root.child_point.0"] } } } })");
  rows["rows"]["file"] = (folder.path() / "rows.csv").string();
  json["dispersions"].insert(json["dispersions"].begin(), rows);
  for (const bool with_rows : {true, false}) {
    if (!with_rows) json["dispersions"].erase(0);
    const Campaign campaign = campaign_of(json);
    const FitSpec spec = read_fit(parse_json(two_tests), "", folder.path(), campaign);
    for (const RunAccuracy accuracy : {RunAccuracy::campaign, RunAccuracy::derivative}) {
      ThreadEvaluator threads({.threads = 2}, never);
      const auto expected = predictions(campaign, spec, threads, accuracy);
      REQUIRE(expected.size() == 20);
      REQUIRE(expected[0].size() == 81 + 1 + 81);
      for (const double number : expected[0]) REQUIRE(std::isfinite(number));
      CHECK(expected[0] != expected[1]);
      Job job(3);
      RankEvaluator ranks = job.evaluator(1);
      CHECK(predictions(campaign, spec, ranks, accuracy) == expected);
      CHECK(ranks.ranks() == 3);
    }
  }
}

// The motion is known in closed form; the samples of a run stand on a grid that need not end where the trace does.
TEST_CASE("each time of a trace is predicted by the motion at that time, also the last one") {
  const Folder folder;
  Json json = panel_campaign();
  for (const char* end : {"torque_stowed", "torque_latched"})
    json["scene"]["hinges"][0]["spring"][end] = 1;
  const Campaign campaign = campaign_of(json);
  RandomStream random(1, 0, stream_name("times"));
  for (int trial = 0; trial < 40; ++trial) {
    const double span = 0.5 + 2.2 * open_uniform(random()); // before the latch
    std::vector<double> times{0};
    while (times.back() < span)
      times.push_back(times.back() + 0.002 + 0.1 * open_uniform(random()));
    std::string text = "t,th\n";
    for (const double t : times)
      text += csv_cell(t) + "," + csv_cell(panel_angle(t, 0.5, 1)) + "\n";
    folder.write("t1.csv", text);
    const FitSpec spec = read_fit(parse_json(one_way), "", folder.path(), campaign);
    const ParameterSpace space(campaign, spec);
    ThreadEvaluator threads({.threads = 1}, never);
    const std::vector<FitPoint> points{FitPoint::Zero(2)};
    TestRuns runs(spec.tests, spec.parameters, space, threads);
    const Prediction prediction = runs.predict(points, RunAccuracy::campaign).at(0);
    REQUIRE(prediction.size() == times.size());
    CAPTURE(trial, times.back());
    for (std::size_t k = 0; k < times.size(); ++k)
      CHECK(prediction[k] == Approx(panel_angle(times[k], 0.5, 1)).margin(1e-6));
  }
}
