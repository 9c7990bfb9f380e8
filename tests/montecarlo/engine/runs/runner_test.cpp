#include "montecarlo/engine/runs/runner.hpp"
#include "montecarlo/model/campaign/campaign_json.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/support/source_folder.hpp"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <filesystem>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// The row as its line of runs.csv: bit for bit, missing numbers included.
std::string line(const ResultRow& row) {
  std::string text;
  append_row(text, row);
  return text;
}

} // namespace

TEST_CASE("a row is the scene with the draws applied, run") {
  const Campaign campaign = campaign_of(quick_campaign(10));
  const RunPlan plan(campaign);
  const ResultRow row = Runner(plan).run(3);
  Scene scene = campaign.scene;
  scene.hinges[0].spring.torque_stowed *= row.draws[0];
  scene.hinges[0].spring.torque_latched *= row.draws[0];
  for (std::size_t i = 0; i < 3; ++i) scene.bodies[i].mass = row.draws[i + 1];
  const Outcome outcome = Deployment().run(scene, campaign.integration, goal_of(campaign.outputs));
  CHECK(row.run == 3);
  CHECK(row.status == Status::deployed);
  CHECK(row.latch_order == latch_order(scene, outcome));
  CHECK(row.outputs.back() == outcome.latches.back().time);
}

TEST_CASE("a row does not depend on the runs made before it") {
  const Campaign campaign = campaign_of(full_campaign(20));
  const RunPlan plan(campaign);
  Runner forth(plan), back(plan);
  std::vector<std::string> lines;
  for (long k = 0; k < 20; ++k) lines.push_back(line(forth.run(k)));
  for (long k = 19; k >= 0; --k) CHECK(line(back.run(k)) == lines[static_cast<std::size_t>(k)]);
}

TEST_CASE("watching a run and auditing its energy changes no bit of its row") {
  const Campaign campaign = campaign_of(full_campaign(24));
  const RunPlan plan(campaign);
  Runner runner(plan);
  std::set<Status> seen;
  for (long k = 0; k < 24; ++k) {
    long samples = 0;
    const auto [outcome, row, scene] = Runner(plan).replay(k, [&](const Sample&) { ++samples; });
    CHECK(line(row) == line(runner.run(k)));
    CHECK((samples > 1) == (row.status != Status::invalid));
    // rounding alone leaves some
    CHECK((outcome.energy.drift_before_first_latch > 0) == (row.status != Status::invalid));
    if (row.status == Status::invalid) CHECK(row.peaks_final == PeaksFinal::unknown);
    seen.insert(row.status);
  }
  CHECK(seen.contains(Status::deployed));
  CHECK(seen.contains(Status::timed_out));
  CHECK(seen.contains(Status::invalid));
}

TEST_CASE("an unphysical draw makes an invalid run, with its reason") {
  Json json = quick_campaign(1);
  json["dispersions"][1]["distribution"] = {{"type", "constant"}, {"value", -2}};
  const Campaign campaign = campaign_of(json);
  const ResultRow row = Runner(RunPlan(campaign)).run(0);
  CHECK(row.status == Status::invalid);
  CHECK(row.reason.starts_with("bodies.panel_1.mass is -2"));
  CHECK(row.draws[1] == -2);
  CHECK(std::ranges::all_of(row.outputs, [](double value) { return std::isnan(value); }));
  CHECK(row.latch_order.empty());
}

TEST_CASE("a draw may raise the kinetic friction over the static one: that run is invalid") {
  Json json = quick_campaign(1);
  json["scene"]["hinges"][1]["friction"] = {{"model", "exact"}, {"coulomb", 0.25}, {"static", 0.5}};
  json["dispersions"] = parse_json(R"([
    { "name": "static", "distribution": { "type": "constant", "value": 0.5 }, "apply": "scale",
      "to": ["hinges.mid.friction.static"] },
    { "name": "kinetic", "distribution": { "type": "constant", "value": 0.125 }, "apply": "add",
      "to": ["hinges.mid.friction.coulomb"] } ])");
  const ResultRow row = Runner(RunPlan(campaign_of(json))).run(0);
  CHECK(row.status == Status::invalid);
  CHECK(row.reason == "hinges.mid.friction.static is 0.25, expected >= friction.coulomb");
}

TEST_CASE("a draw beyond a double makes an invalid run, and has no number") {
  Json json = quick_campaign(1);
  json["dispersions"][1]["distribution"] = {
      {"type", "lognormal"}, {"mu_log", 5000}, {"sigma_log", 1}};
  const Campaign campaign = campaign_of(json);
  const ResultRow row = Runner(RunPlan(campaign)).run(0);
  CHECK(row.status == Status::invalid);
  CHECK(row.reason.starts_with("bodies.panel_1.mass is inf"));
  CHECK(std::isnan(row.draws[1]));
}

TEST_CASE("a run that cannot go on fails, with its reason") {
  Json json = quick_campaign(1);
  json["integration"]["max_steps"] = 10;
  const Campaign campaign = campaign_of(json);
  const ResultRow row = Runner(RunPlan(campaign)).run(0);
  CHECK(row.status == Status::failed);
  CHECK(row.reason.starts_with("the limit of 10 steps (max_steps) was reached, at t = "));
}

namespace {

/// A campaign of a wing that bends, on an elastic bracket, with frequencies; some draws are unphysical.
Json bending_campaign() {
  Json json = quick_campaign(12);
  Json& scene = json["scene"];
  for (Json& body : scene["bodies"]) {
    body["inertia"] = 1.0;
    body["plate"] =
        parse_json(R"({ "from": [-0.5, 0], "to": [0.5, 0], "width": 1, "drag_coefficient": 0 })");
  }
  scene["bodies"][1]["flexible"] =
      parse_json(R"({ "joints": 2, "frequency": "20 Hz", "damping_ratio": 0.02 })");
  scene["bodies"].push_back({{"name", "bracket"}, {"mass", 1}, {"inertia", 0.01}});
  Json bracket = parse_json(R"({ "name": "bracket", "parent": "base", "child": "bracket",
    "parent_point": [0, 0], "child_point": [-0.1, 0], "angle": 0,
    "joint": { "stiffness": 20000, "damping": 20 } })");
  scene["hinges"][0]["parent"] = "bracket";
  scene["hinges"].push_back(bracket);
  json["dispersions"][1] = parse_json(R"({ "name": "bending", "distribution":
    { "type": "discrete", "values": [0.8, 1.2, -1], "weights": [4, 4, 1] }, "apply": "scale",
    "to": ["bodies.*.flexible.frequency", "hinges.*.joint.stiffness"] })");
  json["outputs"] = {"latch_time", "peak_moment", "frequency"};
  json["requirements"] = parse_json(R"([{ "output": "mode_1.frequency", "min": "300 mHz",
    "probability": 0.5, "confidence": 0.5 }])");
  return json;
}

} // namespace

TEST_CASE("a campaign of wings that bend has moments and frequencies, alone as in lanes") {
  const Campaign campaign = campaign_of(bending_campaign());
  CHECK(campaign.requirements[0].min == 0.3);
  const RunPlan plan(campaign);
  const std::vector<std::string>& names = plan.names().outputs;
  const auto column = [&](const std::string& name) {
    const auto found = std::ranges::find(names, name);
    REQUIRE(found != names.end());
    return static_cast<std::size_t>(found - names.begin());
  };
  const std::size_t bending = column("panel_2.peak_bending_moment"),
                    mode = column("mode_1.frequency");
  CHECK(column("bracket.peak_moment") > 0);
  CHECK(std::ranges::find(names, "bracket.latch_time") == names.end());
  CHECK(std::ranges::find(names, "panel_1.peak_bending_moment") == names.end());
  CHECK(column("mode_6.frequency") == column("mode_1.frequency") + 5); // 4 hinges and 2 joints
  CHECK(std::ranges::find(names, "mode_7.frequency") == names.end());
  const Results rows = rows_of(plan, {0, 12});
  std::set<double> frequencies;
  for (long k = 0; k < 12; ++k) {
    const ResultRow alone = Runner(plan).run(k);
    CHECK(line(rows.row(k)) == line(alone));
    if (alone.status == Status::invalid) {
      CHECK(std::isnan(alone.outputs[mode]));
      CHECK_THAT(alone.reason, Catch::Contains("bodies.panel_2.flexible.frequency is -20"));
      continue;
    }
    CHECK(alone.status == Status::deployed);
    CHECK(alone.outputs[bending] > 1);
    frequencies.insert(alone.outputs[mode]);
  }
  CHECK(frequencies.size() > 2); // the spring is part of the stiffness
}

TEST_CASE("a yoke's hinges that creep on soft latches let go and stick a few times, not for ever") {
  for (const double stiffness : {100.0, 200.0, 400.0, 800.0, 1600.0}) {
    Scene scene =
        read_scene_file(std::filesystem::path(source_folder) / "studies/scenes/yoke_wing.json");
    for (Hinge& hinge : scene.hinges)
      if (hinge.latch) hinge.latch->stiffness = stiffness;
    const Outcome out = Deployment().run(scene, Integration{}, Goal{});
    CAPTURE(stiffness, out.reason);
    CHECK(out.status == Status::deployed);
    CHECK(out.work.rhs_evaluations < 100'000);
  }
}
