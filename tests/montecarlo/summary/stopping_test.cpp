#include "montecarlo/statistics/binomial_bounds.hpp"
#include "montecarlo/statistics/bonferroni.hpp"
#include "montecarlo/statistics/statistics.hpp"
#include "montecarlo/statistics/wilks.hpp"
#include "montecarlo/summary/stopping.hpp"
#include "tests/montecarlo/campaign_support.hpp"

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
  json["until"] = Json{parse_width_goal(goal).value()};
  return campaign_of(json);
}

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

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
  const Coverage shared = cover_share(.004, .005, at_each_of(.95, 3), trials);
  CHECK(shared.share == Approx(.9903).margin(band(.9903)));
  CHECK(shared.early > 100);
  CHECK(cover_share(.004, .005, .95, trials).share == Approx(.9446).margin(band(.9446)));
}

TEST_CASE("the quantile's interval at which a campaign stops covers as often as it says",
          "[stopping]") {
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
