#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/foundation/statistics/bonferroni.hpp"
#include "montecarlo/foundation/statistics/statistics.hpp"
#include "montecarlo/foundation/statistics/wilks.hpp"
#include "montecarlo/results/summary/stopping.hpp"
#include "tests/montecarlo/campaign_support.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>
#include <utility>

using namespace wingspread;
using namespace wingspread::test;

namespace {

const std::vector<std::string> outputs{"root.latch_time", "deployment_time"};

/// A campaign that may stop at 1000 or 2000 of 2500 runs.
Campaign stopping_campaign(const char* goal) {
  Json json = quick_campaign(2500);
  json["outputs"] = {"latch_time"};
  json["until"] = Json{parse_stopping_goal(goal).value()};
  return campaign_of(json);
}

} // namespace

TEST_CASE("A width is that of the interval that the summary gives", "[stopping]") {
  Results results(ResultNames{{}, outputs});
  for (long run = 0; run < 200; ++run)
    results.append({run,
                    run < 150 ? Status::deployed : Status::stalled,
                    {},
                    {100.0 + static_cast<double>(run), std::nan("")},
                    "",
                    ""});
  const auto find = [&](const char* text) {
    return evaluate_goals(rule_of(text), results, {}, {}, .95).front();
  };
  const Interval share = clopper_pearson(50, 200, .95);
  CHECK(find("stalled 0.2").width == share.upper - share.lower);
  CHECK((find("stalled 0.13").met && !find("stalled 0.12").met));
  const RankBounds ranks = quantile_rank_bounds(200, .5, .95);
  const auto width = static_cast<double>(*ranks.upper - *ranks.lower);
  CHECK(find("root.latch_time@0.5 1").width == width);
  CHECK(find("root.latch_time@0.5 30").met);
  CHECK_FALSE(find("root.latch_time@0.5 30").relative);
  CHECK(*find("root.latch_time@0.5 15%").relative == Approx(width / 199)); // the median
  CHECK((find("root.latch_time@0.5 15%").met && !find("root.latch_time@0.5 10%").met));
  CHECK_FALSE(find("root.latch_time@0.999 1000").width); // too few for its upper bound
  CHECK_FALSE(find("deployment_time@0.5 1000").met);     // never happened
  CHECK_FALSE(
      evaluate_goals(rule_of("stalled 1"), Results(ResultNames{{}, outputs}), {}, {}, .95)[0].met);
  CHECK_FALSE(are_met({}));
}

TEST_CASE("An output below 0 meets the goals that its mirror image meets", "[stopping]") {
  Results results(ResultNames{{}, {"root.latch_time", "root.final_angle"}});
  for (long run = 0; run < 201; ++run) {
    const double value = 100 + 0.01 * static_cast<double>(run * run);
    results.append({run, Status::deployed, {}, {value, -value}, "", ""});
  }
  const auto find = [&](const std::string& text) {
    return evaluate_goals(rule_of(text.c_str()), results, {}, {}, .95).front();
  };
  int met = 0, open = 0;
  for (const auto& [below, above] : {std::pair{"0.3", "0.7"}, {"0.7", "0.3"}, {"0.55", "0.45"}})
    for (const char* width : {"5%", "20%", "60%", "3", "30", "90"}) {
      const GoalState one = find(std::string("root.latch_time@") + below + ' ' + width);
      const GoalState other = find(std::string("root.final_angle@") + above + ' ' + width);
      CAPTURE(below, width);
      REQUIRE(one.width);
      CHECK(*other.width == Approx(*one.width).epsilon(1e-12));
      CHECK(other.met == one.met);
      CHECK(other.relative.has_value() == one.relative.has_value());
      if (one.relative) CHECK(*other.relative == Approx(*one.relative).epsilon(1e-12));
      ++(one.met ? met : open);
    }
  CHECK(std::min(met, open) >= 3);
}

TEST_CASE("A width of an output that is 1 or 0 is that of its share of all runs", "[stopping]") {
  Results results(ResultNames{{}, {"root.held"}});
  for (long run = 0; run < 200; ++run) // the last five failed
    results.append({run,
                    run < 195 ? Status::deployed : Status::failed,
                    {},
                    {run < 150   ? 1.0
                     : run < 195 ? 0.0
                                 : std::nan("")},
                    "",
                    ""});
  Json goals = Json::array({parse_stopping_goal("root.held 13%").value()});
  StoppingRule rule;
  const std::vector<std::string> names{"root.held"};
  CHECK(problems_of(goals, [&](const JsonCursor& at) {
          read_stopping_rule(at, &names, nullptr, rule);
        }).empty());
  const GoalState found = evaluate_goals(rule, results, {}, {}, .95).front();
  const Interval share = clopper_pearson(150, 200, .95);
  CHECK(found.width == share.upper - share.lower);
  CHECK(found.met); // 0.125
}

TEST_CASE("a campaign stops at the same run for any threads and interruptions", "[parallel]") {
  const Folder folder;
  const Campaign campaign = stopping_campaign("root.latch_time@0.5 0.38%");
  const auto whole = folder.path() / "whole";
  const long made = run_into(whole, campaign);
  REQUIRE(made == 2000); // not met at 1000, nor only at the end
  const auto on_three = folder.path() / "on_three";
  CHECK(run_into(on_three, campaign, {.threads = 3}) == made);
  CHECK(contents(on_three) == contents(whole));
  const auto broken = folder.path() / "broken";
  long done = 0;
  for (const long stop_after :
       {400L, 600L, 700L, 5000L}) // the second stops at a checkpoint, or near
    done += run_into(broken, campaign, {.threads = 2, .resume = true, .stop_after = stop_after});
  CHECK(done == made);
  CHECK(run_into(broken, campaign, {.resume = true}) == 0);
  CHECK(contents(broken) == contents(whole));
  const Json summary = parse_json_file(whole / summary_file);
  CHECK_FALSE(summary["wingspread"].contains("partial"));
  CHECK(summary["until"]["stopped"] == true);
  CHECK(summary["until"]["checkpoints"] == 3);
  CHECK(summary["until"]["widths"][0]["met"] == true);
}

TEST_CASE("a campaign whose widths are not reached makes all of its runs", "[stopping]") {
  const Folder folder;
  Json json = quick_campaign(1100);
  json["until"] = Json{parse_stopping_goal("root.latch_time@0.5 1e-9").value()};
  CHECK(run_into(folder.path() / "r", campaign_of(json)) == 1100);
  const Json until = parse_json_file(folder.path() / "r" / summary_file)["until"];
  CHECK((until["stopped"] == false && until["widths"][0]["met"] == false));
}

TEST_CASE("of two goals both have to be met", "[stopping]") {
  const auto made = [](const std::vector<const char*>& goals) {
    const Folder folder;
    Json json = quick_campaign(2500);
    json["outputs"] = {"latch_time"};
    json["until"] = Json::array();
    for (const char* goal : goals) json["until"].push_back(parse_stopping_goal(goal).value());
    const long runs = run_into(folder.path() / "r", campaign_of(json));
    std::vector<bool> met;
    const Json summary = parse_json_file(folder.path() / "r" / summary_file);
    for (const Json& goal : summary["until"]["widths"]) met.push_back(goal["met"]);
    CHECK(summary["until"]["stopped"] == (runs < 2500));
    CHECK(summary.at("accuracy").at("runs") >
          0); // of a campaign that stopped early as of a whole one
    return std::pair(runs, met);
  };
  const char *soon = "deployed 0.5", *late = "root.latch_time@0.5 0.38%", *never = "stalled 1e-9";
  CHECK(made({soon}) == std::pair(1000L, std::vector{true}));
  CHECK(made({soon, late}) == std::pair(2000L, std::vector{true, true}));
  CHECK(made({late, soon}) == std::pair(2000L, std::vector{true, true}));
  CHECK(made({soon, never}) == std::pair(2500L, std::vector{true, false}));
  CHECK(made({never, soon}) == std::pair(2500L, std::vector{false, true}));
  const GoalState met{WidthGoal{}, 1., true}, open{DecisionGoal{}, {}, false};
  CHECK(are_met(std::vector{met, met}));
  CHECK_FALSE(are_met(std::vector{met, open}));
  CHECK_FALSE(are_met(std::vector{open, met}));
}

TEST_CASE("what stops at a width has no shards to make or to merge", "[stopping]") {
  const Folder folder;
  const Campaign campaign = stopping_campaign("deployed 0.5");
  const auto path = folder.path() / "r";
  CHECK(message_of([&] {
          return run_into(path, campaign, {.shard = Shard{1, 2}});
        }) ==
        "found shard 1/2 of a campaign that may stop early, expected all runs: only they tell "
        "when to stop");
  CHECK_FALSE(std::filesystem::exists(path));
}

namespace {

struct Coverage {
  double share;
  int early; ///< stopped before the last look
};

/// How often the share's interval at which a campaign of 1000, 2000 or 4000 runs stops holds p.
Coverage cover_share(double p, double width, double confidence, int trials) {
  std::mt19937_64 random(71);
  int covered = 0, early = 0;
  for (int trial = 0; trial < trials; ++trial) {
    long seen = 0, run = 0;
    for (const long n : {1000L, 2000L, 4000L}) {
      for (; run < n; ++run) seen += uniform(random) < p ? 1 : 0;
      const Interval interval = clopper_pearson(seen, n, confidence);
      if (interval.upper - interval.lower > width && n < 4000) continue;
      if (interval.lower <= p && p <= interval.upper) ++covered;
      if (n < 4000) ++early;
      break;
    }
  }
  return {static_cast<double>(covered) / trials, early};
}

} // namespace

// A rule favours intervals that are narrow by luck. Exact coverage, by summing over all hits at
// each look with scipy 1.10.1: .9446 at a confidence of .95 each, .9903 with α shared among three
// looks.
TEST_CASE("the share's interval at which a campaign stops covers as often as it says",
          "[stopping][long]") {
  constexpr int trials = 4000;
  const auto band = [](double share) { return 5 * std::sqrt(share * (1 - share) / trials); };
  const Coverage shared = cover_share(.004, .005, at_each_of(.95, 3), trials);
  CHECK(shared.share == Approx(.9903).margin(band(.9903)));
  CHECK(shared.early > 100);
  CHECK(cover_share(.004, .005, .95, trials).share == Approx(.9446).margin(band(.9446)));
}

TEST_CASE("the quantile's interval at which a campaign stops covers as often as it says",
          "[stopping][long]") {
  constexpr int trials = 1000;
  const double confidence = at_each_of(.9, 3), median = std::log(2.0);
  const StoppingRule rule = rule_of("root.latch_time@0.5 13%");
  std::mt19937_64 random(72);
  int covered = 0, early = 0;
  for (int trial = 0; trial < trials; ++trial) {
    Results results(ResultNames{{}, {"root.latch_time"}});
    for (long n = 1000; n <= 4000; n *= 2) {
      while (std::cmp_less(results.size(), n))
        results.append({std::ssize(results.runs),
                        Status::deployed,
                        {},
                        {-std::log1p(-uniform(random))},
                        "",
                        ""});
      if (!are_met(evaluate_goals(rule, results, {}, {}, confidence)) && n < 4000) continue;
      const Bounds bounds =
          quantile_bounds(sorted_present(results.outputs[0].values), .5, confidence);
      if (*bounds.lower <= median && median <= *bounds.upper) ++covered;
      if (n < 4000) ++early;
      break;
    }
  }
  CHECK(static_cast<double>(covered) / trials >= .9 - 5 * std::sqrt(.9 * .1 / trials));
  CHECK((early > trials / 10 && early < trials));
}

TEST_CASE("a requirement is decided when it is passed or disproved, and all of that name are",
          "[stopping]") {
  const auto verdict = [](const char* name, const char* output, Decision decision, bool disproved) {
    Verdict made;
    made.requirement.name = name;
    made.requirement.output = output;
    made.decision = decision;
    made.disproved = disproved;
    return made;
  };
  const std::vector<Verdict> verdicts{verdict("", "deployed", Decision::pass, false),
                                      verdict("T-1", "root.latch_time", Decision::fail, true),
                                      verdict("T-2", "root.latch_time", Decision::fail, false),
                                      verdict("", "root.latch_time", Decision::pass, false),
                                      verdict("", "root.latch_time", Decision::undecided, false)};
  const auto met = [&](const char* text) {
    return evaluate_goals(rule_of(text), Results{}, {}, verdicts, .95).front().met;
  };
  CHECK(met("requirement deployed"));
  CHECK(met("requirement T-1"));
  CHECK_FALSE(met("requirement T-2"));
  CHECK_FALSE(met("requirement root.latch_time")); // one of the two is open
  CHECK_FALSE(met("requirement T-3"));
}

TEST_CASE("a campaign stops once its requirement is decided, at its confidence shared out",
          "[stopping]") {
  const auto stopped_at = [](const char* probability) {
    const Folder folder;
    Json json = quick_campaign(4000);
    json["outputs"] = {"latch_time"};
    json["integration"]["t_end"] = 7; // some do not come to it
    json["requirements"] = {
        {{"output", "deployed"}, {"probability", parse_json(probability)}, {"confidence", 0.9}}};
    json["until"] = {{{"requirement", "deployed"}}};
    const long made = run_into(folder.path() / "r", campaign_of(json));
    const Json summary = parse_json_file(folder.path() / "r" / summary_file);
    const Json& found = summary["requirements"][0];
    CHECK(found["confidence_at_this_analysis"].get<double>() == Approx(1 - 0.1 / 3).epsilon(1e-12));
    CHECK(summary["until"]["stopped"] == (made < 4000));
    CHECK(summary["until"]["widths"][0]["met"] == (found["verdict"] == "pass" || made < 4000));
    return std::pair(made, found["verdict"].get<std::string>());
  };
  CHECK(stopped_at("0.01") == std::pair(1000L, std::string("pass")));
  CHECK(stopped_at("0.9999") == std::pair(1000L, std::string("fail"))); // disproved
}

// The advice that it replaces: of a wing that just misses its requirement (P = p exactly, where a pass
// has its greatest probability), "fail, then as many again" passes nearly half as often again as it
// says; with its risk shared out over the looks it does not.
TEST_CASE("a requirement looked at until it passes misleads no more often than it says",
          "[stopping]") {
  constexpr int trials = 4000;
  constexpr double p = .9, c = .9;
  const auto misled = [&](long looks) { // at each of 1000, 2000, 4000
    std::mt19937_64 random(74);
    int passed = 0;
    for (int trial = 0; trial < trials; ++trial) {
      long failures = 0, n = 0;
      for (const long checkpoint : {1000, 2000, 4000}) {
        for (; n < checkpoint; ++n) failures += uniform(random) >= p ? 1 : 0;
        const auto allowed = allowed_failures(n, p, at_each_of(c, looks));
        if (!allowed || failures > *allowed) continue;
        ++passed;
        break;
      }
    }
    return static_cast<double>(passed) / trials;
  };
  const double band = 5 * std::sqrt(.1 * .9 / trials);
  CHECK(misled(3) <= 1 - c + band);
  CHECK(misled(1) > 1 - c + band); // each look taken at c
}
