#include "montecarlo/campaign/stopping.hpp"
#include "montecarlo/statistics/confidence.hpp"
#include "montecarlo/statistics/statistics.hpp"
#include "montecarlo/statistics/tolerance.hpp"
#include "tests/montecarlo/campaign_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

using namespace wingspread;
using namespace wingspread::test;

namespace {

const std::vector<std::string> outputs{"root.latch_time", "deployment_time"};

std::string problems_of_rule(const Json& document) {
  StoppingRule rule;
  return problems_of(document,
                     [&](const JsonCursor& at) { read_stopping_rule(at, &outputs, rule); });
}

StoppingRule rule_of(const char* text) {
  StoppingRule rule;
  const Json goals{parse_width_goal(text).value()};
  CHECK(problems_of(goals, [&](const JsonCursor& at) {
          read_stopping_rule(at, &outputs, rule);
        }).empty());
  return rule;
}

/// A campaign that may stop at 1000 or 2000 of 2500 runs.
Campaign stopping_campaign(const char* goal) {
  Json json = quick_campaign(2500);
  json["outputs"] = {"latch_time"};
  json["until"] = Json{parse_width_goal(goal).value()};
  return campaign_of(json);
}

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

} // namespace

TEST_CASE("Widths to stop at are read from words, and written as a campaign has them",
          "[stopping]") {
  struct Case {
    const char *text, *json;
  };
  for (const auto& [text, json] :
       {Case{"root.latch_time@0.99 0.5",
             R"([{"output":"root.latch_time","quantile":0.99,"width":0.5}])"},
        Case{"root.latch_time@0.5 2%",
             R"([{"output":"root.latch_time","quantile":0.5,"relative_width":0.02}])"},
        Case{"timed_out 0.01", R"([{"output":"timed_out","width":0.01}])"}}) {
    CHECK(write_stopping_rule(rule_of(text)).dump() == json);
    CHECK(to_string(rule_of(text)[0]) == text);
  }
  CHECK(to_string(rule_of("root.latch_time@0.5 2 %")[0]) == "root.latch_time@0.5 2%");
  for (const char* text : {"", " ", "deployed", "deployed x", "x@half 1", "deployed 1e999", "%"})
    CHECK_FALSE(parse_width_goal(text));
}

TEST_CASE("Each fault of a width to stop at is told", "[stopping]") {
  const Json good = parse_json(R"([{ "output": "root.latch_time", "quantile": 0.9, "width": 0.5 },
                     { "output": "stalled", "width": 0.01 }])");
  CHECK(problems_of_rule(good).empty());
  const Spoiled change = GENERATE(values<Spoiled>(
      {{"", "3", "found 3, expected an array of widths to be reached"},
       {"/0", "3", "/0: found 3, expected a width to be reached: an object"},
       {"/0/output", "", "/0/output: found nothing, expected a string, an output or a status"},
       {"/1/output", "\"stall\"",
        "/1/output: found string \"stall\", expected an output of the campaign, or a status (did "
        "you mean \"stalled\"?)\n/1/quantile: found nothing, expected a number, > 0 and < 1: the "
        "quantile that is meant"},
       {"/0/quantile", "",
        "/0/quantile: found nothing, expected a number, > 0 and < 1: the quantile that is meant"},
       {"/0/quantile", "1",
        "/0/quantile: found 1, expected a number, > 0 and < 1: the quantile that is meant"},
       {"/1/quantile", "0.5", "/1/quantile: found 0.5, expected no quantile of a share of runs"},
       {"/0/width", "0", "/0/width: found 0, expected a number, in the output's unit, > 0"},
       {"/0/width", "", "/0: found neither width nor relative_width, expected one of them"},
       {"/0/relative_width", "1", "/0: found both width and relative_width, expected one of them"},
       {"/1/widht", "1",
        "/1/widht: found the unknown key \"widht\", expected \"output\", \"width\", "
        "\"relative_width\" or \"quantile\" (did you mean \"width\"?)"}}));
  CAPTURE(change.pointer, change.value);
  CHECK(problems_of_rule(spoil(good, change)) == change.message);
  CHECK(problems_of_rule(parse_json(R"([{ "output": "stalled", "relative_width": 0.5 }])")) ==
        "/0: found a relative_width, expected a width, for a share of runs");
}

TEST_CASE("Checkpoints are the powers of two times 1000, and the end", "[stopping]") {
  const StoppingRule rule = rule_of("deployed 0.1");
  const auto all = [](long runs) {
    std::vector<long> checkpoints;
    for (long done = 0; done < runs; done = checkpoints.back())
      checkpoints.push_back(next_checkpoint(done, runs));
    return checkpoints;
  };
  CHECK(all(10000) == std::vector<long>{1000, 2000, 4000, 8000, 10000});
  CHECK(all(8000) == std::vector<long>{1000, 2000, 4000, 8000});
  CHECK(all(1500) == std::vector<long>{1000, 1500});
  CHECK(all(300) == std::vector<long>{300});
  CHECK(next_checkpoint(1500, 10000) == 2000);
  CHECK((is_checkpoint(2000, 10000) && is_checkpoint(10000, 10000) && !is_checkpoint(0, 10000) &&
         !is_checkpoint(1500, 10000)));
  CHECK(
      (count_looks(rule, 10000) == 5 && count_looks(rule, 300) == 1 && count_looks({}, 9999) == 1));
  CHECK(count_looks(rule, std::numeric_limits<long>::max()) == 55); // 1000 · 2^53 and the end
}

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
    return find_widths(rule_of(text), results, .95).front();
  };
  const Interval share = clopper_pearson(50, 200, .95);
  CHECK(find("stalled 0.2").width == share.upper - share.lower);
  CHECK((find("stalled 0.13").met && !find("stalled 0.12").met));
  const RankBounds ranks = quantile_rank_bounds(200, .5, .95);
  const auto width = static_cast<double>(*ranks.upper - *ranks.lower);
  CHECK(find("root.latch_time@0.5 1").width == width);
  CHECK(find("root.latch_time@0.5 30").met);
  CHECK((find("root.latch_time@0.5 15%").met && !find("root.latch_time@0.5 10%").met));
  CHECK_FALSE(find("root.latch_time@0.999 1000").width); // too few for its upper bound
  CHECK_FALSE(find("deployment_time@0.5 1000").met);     // never happened
  CHECK_FALSE(find_widths(rule_of("stalled 1"), Results(ResultNames{{}, outputs}), .95)[0].met);
  CHECK_FALSE(are_met({}));
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
  json["until"] = Json{parse_width_goal("root.latch_time@0.5 1e-9").value()};
  CHECK(run_into(folder.path() / "r", campaign_of(json)) == 1100);
  const Json until = parse_json_file(folder.path() / "r" / summary_file)["until"];
  CHECK((until["stopped"] == false && until["widths"][0]["met"] == false));
}

TEST_CASE("what stops at a width has no shards to make or to merge", "[stopping]") {
  const Folder folder;
  const Campaign campaign = stopping_campaign("deployed 0.5");
  const auto path = folder.path() / "r";
  CHECK(message_of([&] {
          return run_into(path, campaign, {.shard = Shard{1, 2}});
        }) ==
        "found shard 1/2 of a campaign that stops at a width, expected all runs: only they tell "
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
          "[stopping]") {
  constexpr int trials = 4000;
  const auto band = [](double share) { return 5 * std::sqrt(share * (1 - share) / trials); };
  const Coverage shared = cover_share(.004, .005, at_each_look(.95, 3), trials);
  CHECK(shared.share == Approx(.9903).margin(band(.9903)));
  CHECK(shared.early > 100);
  CHECK(cover_share(.004, .005, .95, trials).share == Approx(.9446).margin(band(.9446)));
}

TEST_CASE("the quantile's interval at which a campaign stops covers as often as it says",
          "[stopping]") {
  constexpr int trials = 1000;
  const double confidence = at_each_look(.9, 3), median = std::log(2.0);
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
      if (!are_met(find_widths(rule, results, confidence)) && n < 4000) continue;
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
