#include "montecarlo/model/campaign/outputs.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace wingspread;
using namespace wingspread::test;

namespace {

struct OutputsCase {
  const char *json, *message;
};

std::vector<std::string> column_names(const Scene& scene, const Outputs& outputs) {
  std::vector<std::string> names;
  for (const OutputColumn& column : output_columns(scene, outputs)) names.push_back(column.name);
  return names;
}

/// A wing of two hinges of which both latched.
Outcome some_outcome() {
  Outcome outcome;
  outcome.status = Status::deployed;
  outcome.latches = {{1, 2.0, {-0.5, 0.25}}, {0, 3.0, {-1.5, 0.125}}};
  outcome.peak_moment = {{10, 3}, {20, 2}};
  outcome.peak_force = {{30, 3}, {40, 2}};
  outcome.overtravel = {0.5, 0};
  outcome.final_angle = {0.0625, -0.5};
  outcome.mode_frequencies = {0.75, 9}; // whatever became of the run
  return outcome;
}

std::vector<double> outputs_of(const Outcome& outcome) {
  Scene scene = read_campaign(small_campaign().dump(), "").scene;
  scene.hinges[1].latch = Latch{1e4, 100};
  std::vector<double> values;
  for (const OutputColumn& column : output_columns(scene, all_outputs()))
    values.push_back(output_of(column, outcome));
  return values;
}

void check_same(const std::vector<double>& found, const std::vector<double>& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CAPTURE(i);
    if (std::isnan(expected[i]))
      CHECK(std::isnan(found[i]));
    else
      CHECK(found[i] == expected[i]);
  }
}

} // namespace

TEST_CASE("Outputs are families, all but rate_at by default", "[campaign_settings]") {
  CHECK(write_outputs(default_outputs()).dump() ==
        R"(["latch_time","latch_rate","peak_moment","peak_force","overtravel"])");
  const auto [outputs, problems] =
      read(R"(["rate_at", "latch_time"])", default_outputs(), read_outputs);
  CHECK(problems.empty());
  CHECK(outputs == Outputs{OutputFamily::latch_time, OutputFamily::rate_at});
  CHECK(read("[]", default_outputs(), read_outputs).settings.empty());
  const auto [json, message] = GENERATE(values<OutputsCase>(
      {{"\"latch_time\"", "found string \"latch_time\", expected an array of output families"},
       {R"(["latch_times"])", "/0: found string \"latch_times\", expected \"latch_time\", "
                              "\"latch_rate\", \"peak_moment\", \"peak_force\", \"rate_at\", "
                              "\"overtravel\", \"peaks_final\", \"base_motion\", \"frequency\", "
                              "\"hold_moment\", \"captures\", \"held\", \"final_angle\" or "
                              "\"motor_energy\" (did you mean "
                              "\"latch_time\"?)"},
       {R"(["rate_at", "rate_at"])",
        "/1: found string \"rate_at\" a second time, expected each family once"}}));
  CHECK(facts_of(read(json, default_outputs(), read_outputs).problems) == facts_of(message));
}

TEST_CASE("a free base has columns of its own, for which runs go to t_end") {
  Scene scene = read_scene_file(three_panel_file());
  const Outputs asked{OutputFamily::base_motion};
  for (const BaseMotion imposed : {BaseMotion::fixed, BaseMotion::prescribed}) {
    scene.base.motion = imposed;
    CHECK(column_names(scene, asked) == std::vector<std::string>{"deployment_time"});
  }
  scene.base.motion = BaseMotion::free;
  CHECK(column_names(scene, asked) ==
        std::vector<std::string>{"base.peak_angle", "base.peak_rate", "deployment_time"});
  CHECK(goal_of(asked).base_motion);
  CHECK_FALSE(goal_of(default_outputs()).base_motion);
  Outcome outcome;
  outcome.status = Status::timed_out;
  const std::vector<OutputColumn> columns = output_columns(scene, asked);
  CHECK(std::isnan(output_of(columns[0], outcome)));
  outcome.base_peaks = {0.25, 0.5};
  CHECK(output_of(columns[0], outcome) == 0.25);
  CHECK(output_of(columns[1], outcome) == 0.5);
  outcome.status = Status::failed; // a larger one may have been to come
  CHECK(std::isnan(output_of(columns[1], outcome)));
}

TEST_CASE("the columns stand hinge by hinge, then the deployment time") {
  const Scene scene = read_scene_file(three_panel_file());
  CHECK(column_names(scene, default_outputs()) ==
        std::vector<std::string>{
            "root.latch_time", "root.latch_rate", "root.peak_moment", "root.peak_force",
            "root.overtravel", "mid.latch_time", "mid.latch_rate", "mid.peak_moment",
            "mid.peak_force", "mid.overtravel", "tip.latch_time", "tip.latch_rate",
            "tip.peak_moment", "tip.peak_force", "tip.overtravel", "deployment_time"});
  CHECK(column_names(scene, {OutputFamily::rate_at}) ==
        std::vector<std::string>{"root.rate_at.mid", "root.rate_at.tip", "mid.rate_at.root",
                                 "mid.rate_at.tip", "tip.rate_at.root", "tip.rate_at.mid",
                                 "deployment_time"});
  CHECK(column_names(scene, {}) == std::vector<std::string>{"deployment_time"});
}

TEST_CASE("a hinge without a latch has no latch time, but a rate when others latch") {
  const Scene scene = campaign_of(small_campaign()).scene; // mid has no latch
  CHECK(column_names(scene, all_outputs()) ==
        std::vector<std::string>{"root.latch_time", "root.latch_rate", "root.peak_moment",
                                 "root.peak_force", "root.overtravel", "root.final_angle",
                                 "mid.peak_moment", "mid.peak_force", "mid.overtravel",
                                 "mid.final_angle", "mid.rate_at.root", "mode_1.frequency",
                                 "mode_2.frequency", "deployment_time"});
}

TEST_CASE("a run goes no further than the outputs need") {
  const Goal latches = goal_of({OutputFamily::latch_time, OutputFamily::rate_at});
  CHECK_FALSE(latches.peak_moment);
  CHECK_FALSE(latches.peak_force);
  CHECK_FALSE(latches.audit);
  CHECK_FALSE(latches.base_motion);
  CHECK(goal_of({OutputFamily::peak_moment}).peak_moment);
  CHECK_FALSE(goal_of({OutputFamily::peak_moment}).peak_force);
  CHECK(goal_of({OutputFamily::peak_force}).peak_force);
}

TEST_CASE("outputs are taken from the outcome, and missing where they did not happen") {
  Outcome outcome = some_outcome();
  // root: latch time, latch rate, peak moment, peak force, overtravel, final angle, rate at mid; mid likewise;
  // the modes; the last latch
  check_same(outputs_of(outcome),
             {3, -1.5, 10, 30, 0.5, 0.0625, -0.5, 2, 0.25, 20, 40, 0, -0.5, 0.125, 0.75, 9, 3});

  SECTION("stalled or timed out: peaks up to the end, and no deployment time") {
    outcome.status = GENERATE(Status::stalled, Status::timed_out);
    outcome.latches.pop_back();
    check_same(outputs_of(outcome), {none, none, 10, 30, 0.5, 0.0625, -0.5, 2, 0.25, 20, 40, 0,
                                     -0.5, none, 0.75, 9, none});
  }
  SECTION("failed: what latched did, but a larger peak might have come") {
    outcome.status = Status::failed;
    outcome.latches.pop_back();
    check_same(outputs_of(outcome), {none, none, none, none, none, none, -0.5, 2, 0.25, none, none,
                                     none, none, none, 0.75, 9, none});
  }
  SECTION("a number that is not finite is none") {
    outcome.peak_force[0].value = std::numeric_limits<double>::infinity();
    check_same(outputs_of(outcome),
               {3, -1.5, 10, none, 0.5, 0.0625, -0.5, 2, 0.25, 20, 40, 0, -0.5, 0.125, 0.75, 9, 3});
  }
  SECTION("invalid: nothing") {
    outcome = {};
    outcome.status = Status::invalid;
    check_same(outputs_of(outcome), std::vector<double>(17, none));
  }
}

TEST_CASE("the latch order names the hinges in order of time") {
  Scene scene = campaign_of(small_campaign()).scene;
  CHECK(latch_order(scene, some_outcome()) == "mid>root");
  CHECK(latch_order(scene, {}).empty());
}
