// Outputs of holds, motors, and latches that may miss or let go.
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "montecarlo/model/campaign/outputs.hpp"
#include "montecarlo/model/scene_file/scene_json.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;

namespace {

Scene wing_with_life() {
  Json document = parse_json_file(test::three_panel_file());
  document["hinges"][0]["latch"]["holding_moment"] = 1e4;
  document["hinges"][2]["release"] = {{"time", 0.5}};
  return read_scene(document);
}

std::vector<std::string> names(const Scene& scene, const Outputs& outputs) {
  std::vector<std::string> all;
  for (const OutputColumn& column : output_columns(scene, outputs)) all.push_back(column.name);
  return all;
}

double value(const Scene& scene, const Outcome& outcome, const std::string& name) {
  for (const OutputColumn& column : output_columns(scene, all_outputs()))
    if (column.name == name) return output_of(column, outcome);
  FAIL("no column " << name);
  return 0;
}

} // namespace

TEST_CASE("Only hinges with a life have its outputs, and only scenes with one have them unasked") {
  const Scene scene = wing_with_life();
  const Scene plain = read_scene(parse_json_file(test::three_panel_file()));
  CHECK(default_outputs(plain) == default_outputs());
  const Outputs life{OutputFamily::hold_moment, OutputFamily::captures, OutputFamily::held};
  CHECK(names(scene, life) == std::vector<std::string>{"root.captures", "root.held",
                                                       "tip.hold_moment", "deployment_time"});
  CHECK(names(plain, life) == std::vector<std::string>{"deployment_time"});
  for (const OutputFamily family : life) CHECK(default_outputs(scene).contains(family));
  CHECK_FALSE(default_outputs(scene).contains(OutputFamily::final_angle));
  CHECK(names(plain, {OutputFamily::final_angle}).size() == 4);
}

TEST_CASE("Only hinges with a motor have its energy") {
  Json document = parse_json_file(test::three_panel_file());
  document["hinges"][1]["motor"] = {{"rate", 0.1}, {"gain", 40}, {"torque_limit", 3}};
  const Scene scene = read_scene(document);
  CHECK(default_outputs(scene).contains(OutputFamily::motor_energy));
  CHECK(names(scene, {OutputFamily::motor_energy}) ==
        std::vector<std::string>{"mid.motor_energy", "deployment_time"});
  CHECK(goal_of(default_outputs(scene)).motor_energy);
  CHECK_FALSE(goal_of(default_outputs()).motor_energy);
  Outcome outcome;
  outcome.status = Status::timed_out;
  CHECK(std::isnan(value(scene, outcome, "mid.motor_energy")));
  outcome.motor_energy = {0, -1.5, 0};
  CHECK(value(scene, outcome, "mid.motor_energy") == -1.5);
  outcome.status = Status::failed;
  CHECK(std::isnan(value(scene, outcome, "mid.motor_energy")));
}

TEST_CASE("A latch that let go has the time of the engagement that holds, or none") {
  const Scene scene = wing_with_life();
  Outcome outcome;
  outcome.status = Status::deployed;
  outcome.latches = {{0, 1, {-1, 0, 0}}, {1, 2, {0, 3, 0}}, {0, 3, {-0.5, 0, 0}}, {2, 4, {}}};
  outcome.let_go = {{0, 1.5, 2}};
  outcome.final_angle = {0, 0, -0.25};
  outcome.hold_moment = {{}, {}, {7, 0.1}};
  CHECK(value(scene, outcome, "root.latch_time") == 3);
  CHECK(value(scene, outcome, "root.latch_rate") == -0.5);
  CHECK(value(scene, outcome, "root.captures") == 2);
  CHECK(value(scene, outcome, "root.held") == 1);
  CHECK(value(scene, outcome, "tip.hold_moment") == 7);
  CHECK(value(scene, outcome, "tip.final_angle") == -0.25);
  CHECK(value(scene, outcome, "deployment_time") == 4);
  CHECK(latch_order(scene, outcome) == "mid>root>tip");
  outcome.let_go.push_back({0, 5, 2});
  outcome.status = Status::timed_out;
  CHECK(std::isnan(value(scene, outcome, "root.latch_time")));
  CHECK(value(scene, outcome, "root.held") == 0);
  CHECK(value(scene, outcome, "root.captures") == 2);
  CHECK(latch_order(scene, outcome) == "mid>tip");
  outcome.status = Status::failed;
  for (const char* name : {"root.held", "root.captures", "tip.hold_moment", "tip.final_angle"})
    CHECK(std::isnan(value(scene, outcome, name)));
}

TEST_CASE("A final angle is that of the wing at t_end: at rest where its latch bears its spring") {
  // J φ̈ = τ − k (φ − φ_latched) − d φ̇ with J = 1, τ = 1.2, k = 200, d = 0.2: at rest at τ/k; at 200 s the swing has
  // fallen to e^(−0.1 · 198) of its first amplitude, 1e-10 rad.
  Json document = parse_json(R"({
    "scene": { "name": "lid", "base": { "motion": "fixed" },
               "bodies": [ { "name": "lid", "mass": 3, "inertia": 0.25 } ],
               "hinges": [ { "name": "h", "parent": "base", "child": "lid",
                             "parent_point": [0, 0], "child_point": [-0.5, 0],
                             "angle": { "stowed": 0, "latched": 1.5 },
                             "spring": { "torque_stowed": 1.2, "torque_latched": 1.2 },
                             "latch": { "stiffness": 200, "damping": 0.2 } } ] },
    "sampling": { "runs": 1 }, "integration": { "t_end": 200 },
    "outputs": ["latch_time", "final_angle"] })");
  for (const bool peaks : {false, true}) {
    if (peaks) document["outputs"].push_back("peak_moment");
    const Campaign campaign = read_campaign(document.dump(), "");
    const Outcome out =
        Deployment().run(campaign.scene, campaign.integration, goal_of(campaign.outputs));
    CHECK(value(campaign.scene, out, "h.final_angle") == Approx(0.006).margin(1e-8));
  }
}
