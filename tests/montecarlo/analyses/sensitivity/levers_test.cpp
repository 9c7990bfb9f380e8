#include "montecarlo/analyses/sensitivity/levers.hpp"
#include "montecarlo/engine/runs/run_plan.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// The seed scene with springs and masses, 99 % of whose runs have to deploy within 9.4 s.
Campaign limited_campaign() {
  Json json = quick_campaign(2000);
  json["dispersions"].push_back(parse_json(R"({ "name": "temperature",
    "distribution": { "type": "normal", "mean": 20, "std": 5 },
    "through": [ { "to": ["hinges.*.friction.coulomb"], "apply": "scale",
                   "table": { "at": [-70, 70], "value": [2, 0.5] } } ] })"));
  json["requirements"] = parse_json(
      R"([ { "output": "deployment_time", "max": 9.4, "probability": 0.99, "confidence": 0.9 } ])");
  return campaign_of(json);
}

/// Invented rows with the output as a function of the draws: spring, three masses, temperature.
template <class Output> Results rows_with(const Campaign& campaign, Output output) {
  const ResultNames names = RunPlan(campaign).names();
  const auto column = std::ranges::find(names.outputs, "deployment_time") - names.outputs.begin();
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Results results(names);
  for (long run = 0; run < 2000; ++run) {
    const std::vector<double> draws{1 + 0.05 * normal(random), 10 + 0.4 * normal(random),
                                    10 + 0.4 * normal(random), 10 + 0.4 * normal(random),
                                    20 + 5 * normal(random)};
    std::vector<double> outputs(names.outputs.size(), 1.0);
    outputs[static_cast<std::size_t>(column)] = output(draws);
    results.append({run, Status::deployed, draws, outputs, "root>mid>tip", ""});
  }
  return results;
}

LeverChanges levers_found(const Campaign& campaign, const Results& results) {
  const Verdict verdict = judge(campaign.requirements.front(), results);
  REQUIRE(verdict.decision == Decision::fail);
  const auto all = lever_changes(NeededFor::limit, campaign, verdict, results, {}, 0.95, 9);
  REQUIRE(all);
  return *all;
}

} // namespace

TEST_CASE("inputs of one quantity move together where they act alike, and alone where one acts",
          "[needed]") {
  const Campaign campaign = limited_campaign();
  const Results alike = rows_with(campaign, [](const std::vector<double>& x) {
    return 9 + 0.2 * (x[1] + x[2] + x[3] - 30) - 4 * (x[0] - 1) - 0.04 * (x[4] - 20);
  });
  const LeverChanges together = levers_found(campaign, alike);
  REQUIRE(together.levers.size() == 3);
  CHECK(together.explained == Approx(1).epsilon(1e-6));
  const auto of = [](const LeverChanges& all, const std::string& words) {
    const auto at = std::ranges::find(all.levers, words,
                                      [](const LeverChange& each) { return each.lever.words; });
    REQUIRE(at != all.levers.end());
    return *at;
  };
  const LeverChange masses = of(together, "mass of all bodies");
  CHECK(masses.lever.draws ==
        std::vector<std::string>{"mass.panel_1", "mass.panel_2", "mass.panel_3"});
  CHECK(masses.lever.paths == std::vector<std::string>{"bodies.*.mass"});
  CHECK(masses.lever.moved.scaled);
  CHECK(masses.change.change < 1);
  const LeverChange spring = of(together, "root spring");
  CHECK(spring.change.change > 1);
  CHECK(spring.lever.paths == std::vector<std::string>{"hinges.root.spring.torque_stowed",
                                                       "hinges.root.spring.torque_latched"});
  const LeverChange warmth = of(together, "temperature");
  CHECK(!warmth.lever.moved.scaled);
  CHECK(warmth.change.change > 0);
  CHECK(warmth.lever.paths.empty()); // `margin` cannot scale a temperature
  for (std::size_t i = 1; i < together.levers.size(); ++i)
    CHECK(together.levers[i - 1].change.known >= together.levers[i].change.known);

  const Results of_one = rows_with(campaign, [](const std::vector<double>& x) {
    return 9 + 0.6 * (x[2] - 10) + 0.02 * (x[1] + x[3] - 20);
  });
  CHECK(of(levers_found(campaign, of_one), "panel_2 mass").lever.draws ==
        std::vector<std::string>{"mass.panel_2"});
}

TEST_CASE("of the levers at most so many are named, those that come first", "[needed]") {
  const Campaign campaign = limited_campaign();
  const Results results = rows_with(campaign, [](const std::vector<double>& x) {
    return 9 + 0.2 * (x[1] + x[2] + x[3] - 30) - 4 * (x[0] - 1) - 0.04 * (x[4] - 20);
  });
  const LeverChanges all = levers_found(campaign, results);
  REQUIRE(all.levers.size() == 3);
  const Verdict verdict = judge(campaign.requirements.front(), results);
  for (const std::size_t most : {0, 1, 2, 3, 4}) {
    const auto some = lever_changes(NeededFor::limit, campaign, verdict, results, {}, 0.95, most);
    REQUIRE(some);
    REQUIRE(some->levers.size() == std::min<std::size_t>(most, 3));
    for (std::size_t k = 0; k < some->levers.size(); ++k)
      CHECK(some->levers[k].lever.words == all.levers[k].lever.words);
  }
}

TEST_CASE("a shift is small or large against half of the range drawn, where the mean is about 0",
          "[needed]") {
  int telling = 0; // against the whole range the shift would seem smaller than the factor
  for (const double slope : {4., 5., 6., 7.})
    for (const double limit : {11.6, 11.9, 12.2, 12.5}) {
      Json json = limited_campaign().resolved;
      json["requirements"][0]["max"] = limit;
      const Campaign campaign = campaign_of(json);
      const ResultNames names = RunPlan(campaign).names();
      const auto column =
          std::ranges::find(names.outputs, "deployment_time") - names.outputs.begin();
      std::mt19937_64 random(2);
      std::normal_distribution<double> normal;
      Results results(names);
      for (long run = 0; run < 2000; ++run) {
        const double spring = 1 + 0.15 * normal(random), temperature = 5 * normal(random);
        std::vector<double> outputs(names.outputs.size(), 1.0);
        outputs[static_cast<std::size_t>(column)] = 9 - slope * (spring - 1) - 0.25 * temperature;
        const std::vector<double> draws{spring, 10 + normal(random), 10 + normal(random),
                                        10 + normal(random), temperature};
        results.append({run, Status::deployed, draws, outputs, "root>mid>tip", ""});
      }
      const Verdict verdict = judge(campaign.requirements.front(), results);
      if (verdict.decision != Decision::fail) continue;
      const auto all = lever_changes(NeededFor::limit, campaign, verdict, results, {}, 0.95, 9);
      if (!all || all->levers.size() != 2) continue;
      const bool spring_first = all->levers[0].lever.words == "root spring";
      const NeededChange &factor = all->levers[spring_first ? 0 : 1].change,
                         &shift = all->levers[spring_first ? 1 : 0].change;
      if (!factor.known || !shift.known) continue;
      const double log = std::log(factor.change), half = (shift.most - shift.least) / 2;
      CAPTURE(slope, limit, log, shift.change / half);
      CHECK(spring_first == (log < shift.change / half));
      telling += spring_first && log > shift.change / (2 * half) ? 1 : 0;
    }
  CHECK(telling > 0);
}

// A factor of an angle depends on where 0 lies; a factor of a scale, or of a mass that is drawn, does not.
TEST_CASE("factors and masses are scaled, angles and what is added are shifted", "[needed]") {
  struct Target {
    const char *path, *apply;
    double middle;
    bool scaled;
  };
  for (const Target& target : {Target{"hinges.root.spring.scale", "scale", 1, true},
                               Target{"bodies.panel_2.mass", "set", 10, true},
                               Target{"hinges.root.latch.stiffness", "set", 1e4, true},
                               Target{"hinges.root.angle.stowed", "set", 1.5, false},
                               Target{"hinges.root.angle.stowed", "scale", 1, true},
                               Target{"hinges.root.spring.offset", "add", 5, false},
                               Target{"hinges.root.initial_rate", "set", 0.1, false}}) {
    CAPTURE(target.path, target.apply);
    Json json = quick_campaign(1000);
    json["dispersions"] = {
        {{"name", "x"},
         {"distribution",
          {{"type", "uniform"}, {"lower", 0.9 * target.middle}, {"upper", 1.1 * target.middle}}},
         {"apply", target.apply},
         {"to", {target.path}}}};
    json["requirements"] = parse_json(
        R"([ { "output": "deployment_time", "max": 9, "probability": 0.9, "confidence": 0.9 } ])");
    const Campaign campaign = campaign_of(json);
    const ResultNames names = RunPlan(campaign).names();
    const auto column = std::ranges::find(names.outputs, "deployment_time") - names.outputs.begin();
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> draw(0.9 * target.middle, 1.1 * target.middle);
    Results results(names);
    for (long run = 0; run < 1000; ++run) {
      const double x = draw(random);
      std::vector<double> outputs(names.outputs.size(), 1.0);
      outputs[static_cast<std::size_t>(column)] =
          8.6 + 5 * (x / target.middle - 1); // 20 % are late
      results.append({run, Status::deployed, {x}, outputs, "", ""});
    }
    const LeverChanges all = levers_found(campaign, results);
    REQUIRE(all.levers.size() == 1);
    CHECK(all.levers[0].lever.moved.scaled == target.scaled);
    CHECK(all.levers[0].lever.paths.empty() != target.scaled); // `margin` scales paths
  }
}
