#include "montecarlo/engine/runs/runner.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>

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
  CHECK(row.reason.starts_with("the limit of 10 steps was reached, at t = "));
}
