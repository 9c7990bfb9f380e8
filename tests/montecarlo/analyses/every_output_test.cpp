// Each output alone, in every study that asks runs for single outputs: its value is the one it has beside all others.
#include "montecarlo/analyses/rare/limit_state.hpp"
#include "montecarlo/engine/runs/run_plan.hpp"
#include "montecarlo/model/campaign/outputs.hpp"
#include "montecarlo/results/streaming/streaming_statistics.hpp"
#include "montecarlo/results/summary/judge_campaign.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <vector>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// A wing that has an output of each quantity: a free base, a hold, a motor, latches that may miss and let go, a
/// bending panel, an elastic joint.
Json wing_with_all() {
  return parse_json(R"({ "name": "all",
    "base": { "motion": "free", "mass": 50, "inertia": 8 },
    "bodies": [ { "name": "yoke", "mass": 2, "inertia": 0.1 },
      { "name": "arm", "mass": 2, "inertia": 0.1 },
      { "name": "panel", "mass": 4, "inertia": 0.33,
        "plate": { "from": [-0.5, 0], "to": [0.5, 0], "width": 1, "drag_coefficient": 0 },
        "flexible": { "joints": 1, "bending_stiffness": 300, "damping_ratio": 0.02 } } ],
    "hinges": [
      { "name": "root", "parent": "base", "child": "yoke",
        "parent_point": [0.5, 0], "child_point": [-0.4, 0],
        "angle": { "stowed": 1.5, "latched": 0 },
        "spring": { "torque_stowed": 2, "torque_latched": 1 },
        "friction": { "model": "exact", "coulomb": 0.1, "static": 0.1 },
        "latch": { "stiffness": 2000, "damping": 20, "holding_moment": 300 },
        "motor": { "rate": 0.8, "gain": 10, "torque_limit": 2 },
        "release": { "time": 0.2 } },
      { "name": "tape", "parent": "yoke", "child": "arm",
        "parent_point": [0.4, 0], "child_point": [-0.4, 0],
        "angle": 0, "joint": { "stiffness": 2000, "damping": 10 } },
      { "name": "tip", "parent": "arm", "child": "panel",
        "parent_point": [0.4, 0], "child_point": [-0.5, 0],
        "angle": { "stowed": -3, "latched": 0 },
        "spring": { "torque_stowed": 1, "torque_latched": 0.5 },
        "friction": { "model": "exact", "coulomb": 0.1, "static": 0.1 },
        "latch": { "stiffness": 2000, "damping": 20, "capture_rate": 6 } } ] })");
}

Json campaign_of_all(int runs) {
  Json campaign = parse_json(R"({
    "dispersions": [
      { "name": "spring", "distribution": { "type": "uniform", "lower": 0.9, "upper": 1.1 },
        "apply": "scale", "to": ["hinges.root.spring.scale"] },
      { "name": "mass", "distribution": { "type": "uniform", "lower": 3.8, "upper": 4.2 },
        "apply": "set", "to": ["bodies.panel.mass"] } ],
    "integration": { "t_end": 20 } })");
  campaign["scene"] = wing_with_all();
  campaign["sampling"] = {{"runs", runs}, {"seed", 5}};
  campaign["outputs"] = Json::array();
  for (const std::string_view family : output_family_names) campaign["outputs"].push_back(family);
  return campaign;
}

Scene scene_of_all() { return campaign_of(campaign_of_all(1)).scene; }

Outcome outcome_with(const Scene& scene, const Goal& goal) {
  Integration how;
  how.t_end = 20;
  return Deployment().run(scene, how, goal, {});
}

} // namespace

TEST_CASE("The wing of these tests has every output") {
  std::set<OutputQuantity> found;
  for (const OutputColumn& column : output_columns(scene_of_all(), all_outputs()))
    found.insert(column.quantity);
  CHECK(found.size() == output_kinds.size());
}

TEST_CASE("An output's family has it, and no other family has") {
  const Scene scene = scene_of_all();
  for (const OutputColumn& column : output_columns(scene, all_outputs()))
    for (const OutputFamilyInfo& each : output_families) {
      CAPTURE(column.name, each.name);
      const auto columns = output_columns(scene, {each.family});
      const bool has =
          std::ranges::find(columns, column.name, &OutputColumn::name) != columns.end();
      const bool is_always = column.quantity == OutputQuantity::deployment_time;
      CHECK(has == (is_always || family_of(column.name) == each.family));
    }
  CHECK_FALSE(family_of("deployment_time"));
  CHECK_FALSE(family_of("root.colour"));
}

TEST_CASE("A run that is asked for one output gives the value of a run that is asked for all") {
  const Scene scene = scene_of_all();
  const Outcome all = outcome_with(scene, goal_of(all_outputs()));
  REQUIRE(all.status == Status::deployed);
  for (const OutputColumn& column : output_columns(scene, all_outputs())) {
    CAPTURE(column.name);
    const auto family = family_of(column.name);
    const double alone =
        output_of(column, outcome_with(scene, goal_of(family ? Outputs{*family} : Outputs{})));
    CHECK(std::isfinite(alone));
    CHECK(alone == Approx(output_of(column, all)).epsilon(1e-6).margin(1e-7));
  }
}

TEST_CASE("rare: the event of an output is a run whose value is beyond the limit", "[rare]") {
  const Campaign campaign = campaign_of(campaign_of_all(1));
  const Outcome all = outcome_with(campaign.scene, goal_of(all_outputs()));
  for (const OutputColumn& column : output_columns(campaign.scene, all_outputs())) {
    CAPTURE(column.name);
    const double value = output_of(column, all), step = 1e-3 * std::max(std::abs(value), 1e-3);
    for (const double limit : {value - step, value + step}) {
      const LimitState state(campaign, {column.name, limit, true});
      const Outcome own = outcome_with(campaign.scene, state.goal());
      CHECK((state.of(campaign.scene, own) < 0) == (value > limit));
    }
  }
}

TEST_CASE("margin: with the springs as they are, the runs of `run` break each output's requirement",
          "[margin][parallel]") {
  Json json = campaign_of_all(8);
  const Scene scene = scene_of_all();
  const Results rows = rows_of(RunPlan(campaign_of(json)), {0, 8});
  json["requirements"] = Json::array();
  for (std::size_t i = 0; i < rows.outputs.size(); ++i) {
    std::vector<double> values(rows.outputs[i].values.begin(), rows.outputs[i].values.end());
    std::ranges::sort(values);
    json["requirements"].push_back({{"output", rows.outputs[i].name},
                                    {"max", (values[3] + values[4]) / 2}, // half of the runs
                                    {"probability", 0.1},
                                    {"confidence", 0.5}});
  }
  json["margin"] = {{"scale", {"hinges.root.spring.scale"}}, {"range", {0.95, 1.05}}};
  const Campaign campaign = campaign_of(json);
  const MarginSearch search = margin_of(campaign).searches.front();
  const std::vector<Verdict>& verdicts = search.seen.at(1).front().verdicts;
  REQUIRE(verdicts.size() == rows.outputs.size());
  std::size_t split = 0; // outputs that differ between the runs
  for (std::size_t k = 0; k < verdicts.size(); ++k) {
    CAPTURE(campaign.requirements[k].output);
    const Verdict own = judge(campaign.requirements[k], rows);
    CHECK(verdicts[k].broken == own.broken);
    split += own.broken.size() == 4 ? 1 : 0;
  }
  CHECK(split > verdicts.size() / 2);
}

TEST_CASE("no requirement is judged without its column, from rows or from streaming statistics") {
  Json json = campaign_of_all(8);
  json["requirements"] = parse_json(
      R"([{ "output": "base.peak_rate", "max": 1, "probability": 0.9, "confidence": 0.9 }])");
  const Campaign campaign = campaign_of(json);
  ResultNames names = RunPlan(campaign).names();
  CHECK_NOTHROW(StreamingStatistics(campaign, names, Results(names)));
  CHECK_NOTHROW(judge(campaign.requirements[0], Results(names)));
  std::erase(names.outputs, "base.peak_rate");
  CHECK_THROWS_AS(StreamingStatistics(campaign, names, Results(names)), std::logic_error);
  CHECK_THROWS_AS(judge(campaign.requirements[0], Results(names)), std::logic_error);
}
