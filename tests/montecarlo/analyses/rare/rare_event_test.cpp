#include "montecarlo/analyses/rare/rare_report.hpp"
#include "montecarlo/foundation/platform/interrupt.hpp"
#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "tests/montecarlo/margin_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace wingspread;
using namespace wingspread::test;

namespace {

const auto untold = [](const StudyProgress&) {};

/// One panel, whose spring pulls 2 N·m at first and 0.2 at last against friction of `coulomb`: it
/// starts, and is at its latch if the mean of 1.1 N·m, scaled, exceeds the friction all the way.
/// With both normal that is a linear limit state:
///
///     P(not deployed) = Φ(−β),  β = (1.1 − coulomb)/√((1.1·0.05)² + 0.03²)
Json one_panel(double coulomb) {
  Json campaign = one_panel_margin(100);
  for (const char* key : {"outputs", "requirements", "margin"}) campaign.erase(key);
  campaign["scene"]["hinges"][0]["friction"]["coulomb"] = coulomb;
  campaign["scene"]["hinges"][0]["friction"]["static"] = coulomb;
  return campaign;
}

double coulomb_for(double beta) { return 1.1 - beta * std::hypot(1.1 * 0.05, 0.03); }
double tail(double beta) { return std::erfc(beta / std::sqrt(2)) / 2; }

RareResult estimate(const Json& campaign, const RareOptions& options, const ThreadPool& crew = {}) {
  ThreadEvaluator evaluator(crew, never);
  return estimate_rare_event(campaign_of(campaign), options, evaluator, untold);
}

/// The limit state of the nominal wing with this static friction, N·m, at its first hinge.
double with_static_friction(const LimitState& limit_state, const Campaign& campaign, double level) {
  Scene scene = campaign.scene;
  scene.hinges[0].friction.static_level = level;
  return limit_state.of(scene, Deployment().run(scene, campaign.integration, limit_state.goal()));
}

} // namespace

TEST_CASE("a wing that stalls once in a thousand, or once in a million") {
  for (const double beta : {3.0, 4.75}) {
    const RareResult found = estimate(one_panel(coulomb_for(beta)),
                                      {.samples = 1000, .repeats = 3, .confidence = 0.999});
    INFO("β = " << beta << ": " << found.estimate.probability << ", exactly " << tail(beta));
    CHECK(found.estimate.reached);
    CHECK(std::abs(std::log(found.estimate.probability / tail(beta))) <
          3.5 * found.estimate.variation);
    CHECK(found.estimate.variation < 0.3);
    CHECK(found.estimate.interval.lower < tail(beta));
    CHECK(found.estimate.interval.upper > tail(beta));
    const auto count = [&](Status status) {
      return found.statuses[static_cast<std::size_t>(status)];
    };
    CHECK(count(Status::deployed) + count(Status::stalled) == found.estimate.evaluations);
    REQUIRE(found.likeliest);
    CHECK(found.likeliest->status == Status::stalled);
    CHECK(found.likeliest->distance > beta - 0.02); // none is nearer than the limit state
    CHECK(found.likeliest->distance < beta + 0.5);
  }
}

TEST_CASE("the same as counted in a campaign of its own") {
  const Json json = one_panel(coulomb_for(2.3)); // 1.07 %
  const Campaign campaign = campaign_of(json);
  const RunPlan plan(campaign);
  constexpr long runs = 10'000;
  const long stalled = std::ranges::count(rows_of(plan, {0, runs}).status, Status::stalled);
  const Interval counted = clopper_pearson(stalled, runs, 0.999);
  CHECK(counted.lower < tail(2.3));
  CHECK(counted.upper > tail(2.3));
  const RareResult found = estimate(json, {.samples = 1000, .repeats = 3, .confidence = 0.99});
  CHECK(found.estimate.interval.upper > counted.lower);
  CHECK(found.estimate.interval.lower < counted.upper);
}

TEST_CASE("a limit state runs on through 0 where a single hinge stops short of its latch") {
  // the work of all torques over the travel, before and after it changes its sign
  const Campaign campaign = campaign_of(one_panel(1.0));
  const LimitState limit_state(campaign, {});
  const auto at = [&](double coulomb) {
    Scene scene = campaign.scene;
    scene.hinges[0].friction.coulomb = *(scene.hinges[0].friction.static_level = coulomb);
    const Outcome outcome = Deployment().run(scene, campaign.integration, limit_state.goal());
    CHECK((outcome.status == Status::deployed) == (limit_state.of(scene, outcome) > 0));
    return limit_state.of(scene, outcome);
  };
  CHECK(at(1.0) == Approx(1).epsilon(1e-9)); // the nominal wing
  CHECK(at(1.05) == Approx(0.5).epsilon(1e-6));
  CHECK(at(1.09) == Approx(0.1).epsilon(1e-5));
  CHECK(at(1.099) > 0);
  CHECK(at(1.101) < 0);
  CHECK(at(1.2) < at(1.15));
  CHECK(at(2.5) == -1); // it never starts
}

TEST_CASE("a wing that creeps runs out of time") {
  Json json = one_panel(0.5);
  json["integration"]["t_end"] = 4;
  const Campaign campaign = campaign_of(json);
  const LimitState limit_state(campaign, {});
  const auto at = [&](double viscous) {
    Scene scene = campaign.scene;
    scene.hinges[0].friction.viscous = viscous;
    return limit_state.of(scene, Deployment().run(scene, campaign.integration, limit_state.goal()));
  };
  CHECK(at(0) == Approx(1));
  CHECK(at(0.2) < at(0.1));
  CHECK(at(0.2) > 0);
  CHECK(at(50) < 0);
  CHECK(at(50) > -1); // it is under way
  Outcome late = Deployment().run(campaign.scene, campaign.integration, limit_state.goal());
  late.t_end = 4 - 0.25 * (4 - late.t_end); // a quarter of the time that the nominal wing has left
  late.energy.final *= 10;
  CHECK(limit_state.of(campaign.scene, late) == Approx(0.25));
}

TEST_CASE("a wing that its spring barely breaks loose is near to staying stowed") {
  const Campaign campaign = campaign_of(one_panel(0.5));
  const LimitState limit_state(campaign, {});
  const auto at = [&](double level) { return with_static_friction(limit_state, campaign, level); };
  CHECK(at(1.7) == Approx(0.2)); // 0.3 of the 1.5 N·m that the nominal spring has left
  CHECK(at(1.99) > 0);
  CHECK(at(1.99) < at(1.98));
  CHECK(at(2.01) == -1);
}

TEST_CASE("a motor helps to break the wing loose, with its torque at rest") {
  Campaign campaign = campaign_of(one_panel(0.5));
  Motor& motor = campaign.scene.hinges[0].motor.emplace();
  motor.rate = 0.5, motor.gain = 10, motor.torque_limit = 1.25; // at rest 1.25 N·m
  const LimitState limit_state(campaign, {});
  const auto at = [&](double level) { return with_static_friction(limit_state, campaign, level); };
  CHECK(at(2.7) == Approx(0.2)); // 0.55 of the 2.75 N·m that spring and motor have left
  CHECK(at(3.24) > 0);
  CHECK(at(3.26) == -1);
}

TEST_CASE("peaks that t_end cut count as the event, as they break a requirement, and are counted") {
  const RareOptions options{
      .event = {"root.peak_moment", 20, true}, .samples = 100, .repeats = 2, .confidence = 0.9};
  const Campaign campaign = campaign_of(ringing_panel(100, 2.3, 0));
  ThreadEvaluator evaluator({}, never);
  const RareResult cut = estimate_rare_event(campaign, options, evaluator, untold);
  CHECK(cut.estimate.probability == 1);
  CHECK((cut.cut == cut.estimate.evaluations && cut.cut == 200));
  CHECK(rare_json(cut, options, campaign, {})["peaks_cut"] == 200);
  const std::string said = "t_end cut the peak in 200 of 200 runs: they count as the event";
  CHECK_THAT(doubts_of(cut).at(0), Catch::StartsWith(said) && Catch::EndsWith("Lengthen t_end"));
  CHECK_THAT(rare_text(cut, options, campaign), Catch::Contains(said));
  Campaign rattling = campaign; // no t_end proves its peaks final
  rattling.scene.hinges[0].latch->backlash = 0.002;
  CHECK_THAT(doubts_of(estimate_rare_event(rattling, options, evaluator, untold)).at(0),
             Catch::StartsWith(said) && Catch::Contains("No t_end will do with backlash"));

  // A peak is at least what it has come to: none lies below 1 N·m, as the spring alone has 2.
  RareOptions below = options;
  below.event = {"root.peak_moment", 1, false}, below.smallest = 0.01;
  const RareResult risen = estimate_rare_event(campaign, below, evaluator, untold);
  CHECK((risen.cut == 0 && risen.estimate.hits == 0));
  below.event.limit = 1000; // one that is below may still rise above: t_end has not decided it
  const RareResult undecided = estimate_rare_event(campaign, below, evaluator, untold);
  CHECK(undecided.estimate.probability == 1);
  CHECK((undecided.cut == undecided.estimate.evaluations && undecided.cut == 200));

  const Campaign longer = campaign_of(ringing_panel(100, 15, 0));
  RareOptions small = options;
  small.smallest = 0.01;
  const RareResult whole = estimate_rare_event(longer, small, evaluator, untold);
  CHECK((whole.cut == 0 && whole.estimate.hits == 0)); // no draw comes to 20 N·m
  CHECK(rare_json(whole, small, longer, {})["reached"] == false);
  CHECK(rare_text(whole, small, longer).find("t_end") == std::string::npos);
}

TEST_CASE(
    "wings that stall count by their value if they have one, which is told with their number") {
  const Json json = one_panel(coulomb_for(1)); // one in six stalls
  for (const std::string output : {"root.peak_moment", "root.latch_rate", ""}) {
    const RareResult found = estimate(
        json, {.event = {output, 1e6, true}, .samples = 100, .repeats = 2, .smallest = 0.01});
    CAPTURE(output);
    const long stalled = found.statuses[static_cast<std::size_t>(Status::stalled)];
    REQUIRE(stalled > 10);
    const bool counts =
        output == "root.peak_moment"; // one that stalls has no latch rate: the event
    CHECK(found.undeployed == (counts ? stalled : 0));
    const std::vector<std::string> said = doubts_of(found);
    CHECK(std::ranges::count_if(said, [&](const std::string& doubt) {
            return doubt.starts_with(std::to_string(stalled) + " of ") &&
                   doubt.find("count by their value") != std::string::npos;
          }) == (counts ? 1 : 0));
    const bool is_absent = output == "root.latch_rate";
    CHECK(found.absent == (is_absent ? stalled : 0));
    CHECK(std::ranges::count_if(said, [&](const std::string& doubt) {
            return doubt.starts_with(std::to_string(stalled) + " of ") &&
                   doubt.find("no value") != std::string::npos;
          }) == (is_absent ? 1 : 0));
  }
}

TEST_CASE("latches that may let go after t_end count as deployed, and are counted") {
  Json json = ringing_panel(100, 2.3, 0.01);
  json["scene"]["hinges"][0]["latch"]["holding_moment"] = 8; // it will bear 13 N·m
  const RareOptions options{.samples = 100, .repeats = 2};
  const RareResult found = estimate(json, options);
  CHECK(found.statuses[static_cast<std::size_t>(Status::deployed)] == found.estimate.evaluations);
  CHECK(found.open_latches == found.estimate.evaluations);
  CHECK_THAT(doubts_of(found).back(), Catch::Contains("every latch with a holding_moment"));
}

TEST_CASE("a limit state on an output of the run's end has runs that go there") {
  Json json = one_panel(0.5);
  json["scene"]["base"] = parse_json(R"({ "motion": "free", "mass": 100, "inertia": 50,
    "position": [0, 0], "angle": 0, "velocity": [0, 0], "rate": 0 })");
  const Campaign campaign = campaign_of(json);
  CHECK(LimitState(campaign, {"root.final_angle", 1, true}).goal().to_rest);
  CHECK(LimitState(campaign, {"base.peak_angle", 1, true}).goal().base_motion);
  CHECK_FALSE(LimitState(campaign, {"root.latch_time", 1, true}).goal().to_rest);
}

TEST_CASE("an output beyond a limit, above and below, agrees with its own quantiles",
          "[parallel]") {
  Json json = one_panel(0.5);
  json["outputs"] = {"latch_time"};
  const Campaign campaign = campaign_of(json);
  const RunPlan plan(campaign);
  Spilled<double> times = rows_of(plan, {0, 4000}).outputs.front().values;
  std::ranges::sort(times);
  for (const bool above : {true, false}) {
    const double limit = above ? times[4000 - 41] : times[40]; // about 1 %
    const RareResult found =
        estimate(json, {.event = {"root.latch_time", limit, above}, .samples = 1000, .repeats = 3});
    CHECK(std::abs(std::log(found.estimate.probability / 0.01)) <
          3.5 * std::hypot(found.estimate.variation, 1 / std::sqrt(40)));
    CHECK(found.strata[0].estimates[0].levels.front().threshold > 0);
    CHECK((level_of({"root.latch_time", limit, above}, 1.0) < limit) == above);
  }
}

TEST_CASE("the same seed gives the same estimate for any threads and lanes, another seed another",
          "[parallel]") {
  Json json = one_panel(coulomb_for(3));
  const auto with = [&](const ThreadPool& crew) {
    return estimate(json, {.samples = 200, .repeats = 2}, crew);
  };
  const RareResult one = with({.threads = 1});
  std::vector<ThreadPool> crews{{.threads = 2}, {.threads = 5}};
  for (const InstructionSet set : instruction_sets()) crews.push_back({.threads = 2, .set = set});
  for (const ThreadPool& crew : crews) {
    const RareResult again = with(crew);
    CHECK(again.estimate.probability == one.estimate.probability);
    CHECK(again.estimate.variation == one.estimate.variation);
    CHECK(again.statuses == one.statuses);
    CHECK(again.likeliest->draws == one.likeliest->draws);
  }
  json["sampling"]["seed"] = 4;
  CHECK(with({}).estimate.probability != one.estimate.probability);
}

TEST_CASE("draws of the far tails are those of their laws, correlated ones too") {
  Json json = one_panel(coulomb_for(4));
  json["correlations"] = {{{"between", {"spring", "friction"}}, {"spearman", 0.4}}};
  // along with the spring's strength goes the friction: the limit state's variance is less by the
  // normal correlation's share, 2 sin(0.4π/6)
  const double r = 2 * std::sin(0.4 * 3.14159265358979324 / 6), a = 1.1 * 0.05, b = 0.03;
  const double beta = (1.1 - coulomb_for(4)) / std::sqrt(a * a + b * b - 2 * r * a * b);
  const RareResult found = estimate(json, {.samples = 1000, .repeats = 4});
  CHECK(beta > 4.5);
  CHECK(std::abs(std::log(found.estimate.probability / tail(beta))) <
        3.5 * found.estimate.variation);
}

// Friction alone varies, and stalls the wing from 9 standard deviations on: 1.1e-19. The point is in the upper tail,
// where u = Φ(z) is 1 to the last bit: by u alone there is no draw beyond 8.2.
TEST_CASE("an event far in the upper tail is reached by draws that are there, coupled or not",
          "[long]") {
  Json json = one_panel(1.1 - 9 * 0.03);
  json["dispersions"][0]["distribution"] = {{"type", "constant"}, {"value", 1}};
  for (const bool coupled : {false, true}) {
    if (coupled) json["correlations"] = {{{"between", {"friction", "mass"}}, {"spearman", 0.5}}};
    const RareResult found =
        estimate(json, {.samples = 1000, .repeats = 2, .confidence = 0.99, .smallest = 1e-25});
    INFO(found.estimate.probability << ", exactly " << tail(9));
    CHECK(found.estimate.reached);
    CHECK(std::abs(std::log(found.estimate.probability / tail(9))) < 4 * found.estimate.variation);
    REQUIRE(found.likeliest);
    const auto& [distance, z, draws, status, reason] = *found.likeliest;
    CHECK(status == Status::stalled);
    CHECK(draws[1] > 9 * 0.03);
    CHECK(draws[1] < 9.5 * 0.03);
    CHECK(draws[1] == Approx(0.03 * z[1]).epsilon(1e-12)); // "friction" is first by name
  }
}

TEST_CASE("an interruption ends it, and bad events are refused") {
  const std::atomic<bool> stop = true;
  ThreadEvaluator stopped({}, stop);
  const Campaign campaign = campaign_of(one_panel(1));
  CHECK_THROWS_AS(estimate_rare_event(campaign, {.samples = 100}, stopped, untold), Stopped);
  CHECK_THROWS_WITH(estimate(one_panel(1), {.event = {"root.peak_momnet", 1}}),
                    Catch::Contains("--output: found \"root.peak_momnet\"") &&
                        Catch::Contains("did you mean \"root.peak_moment\"?"));
  Json json = one_panel(1);
  json.erase("dispersions");
  CHECK_THROWS_WITH(estimate(json, {}), Catch::Contains("/dispersions: found none"));
  json = one_panel(1);
  json["scene"]["hinges"][0].erase("latch");
  CHECK_THROWS_WITH(estimate(json, {}), Catch::Contains("none with a latch"));
  CHECK(describe(RareEvent{}) == "not deployed");
  CHECK(describe(RareEvent{"root.peak_moment", 400, true}) == "root.peak_moment > 400");
  CHECK(describe(RareEvent{"root.latch_rate", 5, true, true}) == "|root.latch_rate| > 5");
}

TEST_CASE("a limit on a magnitude is that on the side to which the hinge turns") {
  const Campaign campaign = campaign_of(one_panel(0.5));
  const double rate =
      Deployment().run(nominal_scene(campaign), campaign.integration, {}).latches.at(0).rates.at(0);
  REQUIRE(rate != 0);
  const auto found = [&](const RareEvent& event) {
    return estimate(one_panel(0.5), {.event = event, .samples = 200, .repeats = 2}).estimate;
  };
  // about half of the runs latch faster than the nominal one
  const auto signed_one = found({"root.latch_rate", rate, rate > 0});
  const auto magnitude = found({"root.latch_rate", std::abs(rate), true, true});
  CHECK((signed_one.probability > 0.1 && signed_one.probability < 0.9));
  CHECK(magnitude.probability == signed_one.probability);
  CHECK(magnitude.evaluations == signed_one.evaluations);
  const auto slower = found({"root.latch_rate", std::abs(rate), false, true});
  CHECK(slower.probability == Approx(1 - magnitude.probability).margin(0.05));
}

TEST_CASE("the progress of subset simulations never runs backwards nor beyond the end") {
  ThreadEvaluator evaluator({.threads = 1}, never);
  StudyProgress last;
  double share = 0;
  const RareResult result =
      estimate_rare_event(campaign_of(one_panel(3)), {.samples = 200, .repeats = 3}, evaluator,
                          [&](const StudyProgress& now) {
                            CHECK(now.runs <= now.most_runs);
                            const double its =
                                static_cast<double>(now.runs) / static_cast<double>(now.most_runs);
                            CHECK(its >= share);
                            share = its;
                            last = now;
                          });
  CHECK(last.runs == result.estimate.evaluations);
  CHECK(most_evaluations({.samples = 200}) == 200 + 10 * 180);
}
