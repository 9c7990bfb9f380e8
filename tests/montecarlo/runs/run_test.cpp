#include "montecarlo/runs/run.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>

using namespace wingspread;
using namespace wingspread::test;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
const Outputs all_outputs{OutputFamily::latch_time, OutputFamily::latch_rate,
                          OutputFamily::peak_moment, OutputFamily::peak_force,
                          OutputFamily::rate_at};

std::vector<std::string> column_names(const Scene& scene, const Outputs& outputs) {
  std::vector<std::string> names;
  for (const OutputColumn& column : output_columns(scene, outputs)) names.push_back(column.name);
  return names;
}

/// The row as its line of runs.csv: bit for bit, missing numbers included.
std::string line(const ResultRow& row) {
  std::string text;
  append_row(text, row);
  return text;
}

/// A wing of two hinges of which both latched.
Outcome some_outcome() {
  Outcome outcome;
  outcome.status = Status::deployed;
  outcome.latches = {{1, 2.0, {-0.5, 0.25}}, {0, 3.0, {-1.5, 0.125}}};
  outcome.peak_moment = {{10, 3}, {20, 2}};
  outcome.peak_force = {{30, 3}, {40, 2}};
  return outcome;
}

std::vector<double> outputs_of(const Outcome& outcome) {
  Scene scene = read_campaign(small_campaign().dump(), "").scene;
  scene.hinges[1].latch = Latch{1e4, 100};
  std::vector<double> values;
  for (const OutputColumn& column : output_columns(scene, all_outputs))
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

TEST_CASE("the columns stand hinge by hinge, then the deployment time") {
  const Scene scene = read_scene_file(three_panel_file());
  CHECK(column_names(scene, default_outputs()) ==
        std::vector<std::string>{"root.latch_time", "root.latch_rate", "root.peak_moment",
                                 "root.peak_force", "mid.latch_time", "mid.latch_rate",
                                 "mid.peak_moment", "mid.peak_force", "tip.latch_time",
                                 "tip.latch_rate", "tip.peak_moment", "tip.peak_force",
                                 "deployment_time"});
  CHECK(column_names(scene, {OutputFamily::rate_at}) ==
        std::vector<std::string>{"root.rate_at.mid", "root.rate_at.tip", "mid.rate_at.root",
                                 "mid.rate_at.tip", "tip.rate_at.root", "tip.rate_at.mid",
                                 "deployment_time"});
  CHECK(column_names(scene, {}) == std::vector<std::string>{"deployment_time"});
}

TEST_CASE("a hinge without a latch has no latch time, but a rate when others latch") {
  const Scene scene = campaign_of(small_campaign()).scene; // mid has no latch
  CHECK(column_names(scene, all_outputs) ==
        std::vector<std::string>{"root.latch_time", "root.latch_rate", "root.peak_moment",
                                 "root.peak_force", "mid.peak_moment", "mid.peak_force",
                                 "mid.rate_at.root", "deployment_time"});
}

TEST_CASE("a run goes no further than the outputs need") {
  const Goal latches = goal_of({OutputFamily::latch_time, OutputFamily::rate_at});
  CHECK_FALSE(latches.peak_moment);
  CHECK_FALSE(latches.peak_force);
  CHECK_FALSE(latches.audit);
  CHECK_FALSE(latches.to_t_end);
  CHECK(goal_of({OutputFamily::peak_moment}).peak_moment);
  CHECK_FALSE(goal_of({OutputFamily::peak_moment}).peak_force);
  CHECK(goal_of({OutputFamily::peak_force}).peak_force);
}

TEST_CASE("outputs are taken from the outcome, and missing where they did not happen") {
  Outcome outcome = some_outcome();
  // root: latch time, latch rate, peak moment, peak force, rate at mid; mid likewise; the last
  // latch
  check_same(outputs_of(outcome), {3, -1.5, 10, 30, -0.5, 2, 0.25, 20, 40, 0.125, 3});

  SECTION("stalled or timed out: peaks up to the end, and no deployment time") {
    outcome.status = GENERATE(Status::stalled, Status::timed_out);
    outcome.latches.pop_back();
    check_same(outputs_of(outcome), {none, none, 10, 30, -0.5, 2, 0.25, 20, 40, none, none});
  }
  SECTION("failed: what latched did, but a larger peak might have come") {
    outcome.status = Status::failed;
    outcome.latches.pop_back();
    check_same(outputs_of(outcome),
               {none, none, none, none, -0.5, 2, 0.25, none, none, none, none});
  }
  SECTION("a number that is not finite is none") {
    outcome.peak_force[0].value = std::numeric_limits<double>::infinity();
    check_same(outputs_of(outcome), {3, -1.5, 10, none, -0.5, 2, 0.25, 20, 40, 0.125, 3});
  }
  SECTION("invalid: nothing") {
    outcome = {};
    outcome.status = Status::invalid;
    check_same(outputs_of(outcome), std::vector<double>(11, none));
  }
}

TEST_CASE("the latch order names the hinges in order of time") {
  Scene scene = campaign_of(small_campaign()).scene;
  CHECK(latch_order(scene, some_outcome()) == "mid>root");
  CHECK(latch_order(scene, {}).empty());
}

TEST_CASE("a draw depends on seed, run and name alone") {
  const Campaign few = campaign_of(quick_campaign(10)), many = campaign_of(quick_campaign(1000));
  const RunPlan plan_few(few), plan_many(many);
  CHECK(plan_few.names().draws ==
        std::vector<std::string>{"root_spring", "mass.panel_1", "mass.panel_2", "mass.panel_3"});
  std::vector<double> one(4), other(4);
  for (const long k : {0L, 1L, 9L}) {
    plan_few.draw(k, one);
    plan_many.draw(k, other);
    CHECK(one == other);
    const double u = uniform(7, static_cast<std::uint64_t>(k), stream_name("mass.panel_2"));
    CHECK(one[2] == PreparedDistribution({Uniform{9, 11}, {}}).quantile(u));
  }
}

TEST_CASE("every design draws by the dispersions' names, not by their places") {
  for (const char* design : {"random", "latin_hypercube", "sobol"}) {
    Json json = quick_campaign(64);
    json["sampling"]["design"] = design;
    json["sampling"]["replicates"] = 4;
    json["correlations"] =
        parse_json(R"([{ "between": ["root_spring", "mass.panel_2"], "spearman": -0.5 }])");
    Json turned = json;
    std::reverse(turned["dispersions"].begin(), turned["dispersions"].end());
    const Campaign one = campaign_of(json), other = campaign_of(turned);
    const RunPlan plan(one), turned_plan(other);
    std::vector<double> here(4), there(4);
    for (long k = 0; k < 64; ++k) {
      plan.draw(k, here);
      turned_plan.draw(k, there);
      std::rotate(there.begin(), there.end() - 1, there.end()); // the spring has come last
      CHECK(here == there);
    }
  }
}

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
    const auto [outcome, row] = Runner(plan).replay(k, [&](const Sample&) { ++samples; });
    CHECK(line(row) == line(runner.run(k)));
    CHECK((samples > 1) == (row.status != Status::invalid));
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
