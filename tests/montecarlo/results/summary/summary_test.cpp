#include "montecarlo/foundation/statistics/binomial_bounds.hpp"
#include "montecarlo/results/summary/summary.hpp"
#include "tests/montecarlo/sample_support.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace wingspread;
using namespace wingspread::test;

namespace {

/// Ten runs: k and the latch time rise together; runs 8 and 9 stall, and run 7 latches tip first.
Results ten_runs() {
  Results results(ResultNames{{"k", "fixed"}, {"root.latch_time", "root.peak_moment"}});
  for (long run = 0; run < 10; ++run) {
    const bool stalled = run >= 8;
    const double k = static_cast<double>(run);
    results.append({run,
                    stalled ? Status::stalled : Status::deployed,
                    {k, 1},
                    {stalled ? none : 10 + k * k, 5 - k},
                    stalled ? "" : (run == 7 ? "tip>root" : "root>tip"),
                    stalled ? "friction holds root" : ""});
  }
  return results;
}

const DrawCorrelation& find(const Summary& summary, const std::string& draw,
                            const std::string& output) {
  for (const DrawCorrelation& each : summary.correlations)
    if (each.draw == draw && each.output == output) return each;
  throw std::out_of_range(draw + " × " + output);
}

} // namespace

TEST_CASE("a summary counts every run once, by status, with bounds") {
  const Summary summary = summarize(ten_runs(), {});
  CHECK(summary.runs == 10);
  REQUIRE(summary.statuses.size() == 5);
  long sum = 0;
  for (const StatusShare& share : summary.statuses) sum += share.count;
  CHECK(sum == 10);
  CHECK((summary.statuses[0].status == Status::deployed && summary.statuses[0].count == 8));
  CHECK(summary.statuses[0].rate == 0.8);
  CHECK(*summary.statuses[0].bounds.lower == clopper_pearson(8, 10, 0.95).lower);
  CHECK(*summary.statuses[2].bounds.upper == clopper_pearson(0, 10, 0.95).upper);
}

TEST_CASE("a summary says where stalled hinges stopped") {
  Results results(ResultNames{{}, {"root.latch_time", "root.final_angle", "tip.final_angle"}});
  for (long run = 0; run < 9; ++run) {
    const bool stalled = run >= 4, latched = run == 8; // the root has latched in run 8
    results.append(
        {run,
         stalled ? Status::stalled : Status::deployed,
         {},
         {stalled && !latched ? none : 10, static_cast<double>(run), stalled ? -0.5 : 1e-3},
         "",
         ""});
  }
  const Summary summary = summarize(results, {});
  REQUIRE(summary.stalled_at.size() == 2);
  const StoppedHinge &root = summary.stalled_at[0], &tip = summary.stalled_at[1];
  CHECK((root.hinge == "root" && root.runs == 4));
  CHECK((root.median == 5 && root.least == 4 && root.largest == 7));
  CHECK((tip.hinge == "tip" && tip.runs == 5 && tip.median == -0.5));
  CHECK(summarize(ten_runs(), {}).stalled_at.empty());
}

TEST_CASE("a summary of an output is over the runs in which it happened, and says so") {
  const Summary summary = summarize(ten_runs(), {{0.5, 0.99}, 0.5, 4});
  const OutputSummary& latch_time = summary.outputs[0];
  CHECK(latch_time.name == "root.latch_time");
  CHECK((latch_time.moments.count == 8 && latch_time.missing == 2));
  CHECK(latch_time.moments.mean == 10 + 140.0 / 8);
  CHECK(latch_time.mean_error == latch_time.moments.std / std::sqrt(8));
  CHECK(latch_time.quantiles[0].all.value == 26); // the fifth of ten
  CHECK(latch_time.quantiles[0].all.bounds.upper);
  CHECK_FALSE(latch_time.quantiles[1].all.bounds.upper);
  REQUIRE(latch_time.quantiles[0].among);
  CHECK(latch_time.quantiles[0].among->value == 19); // the fourth of eight
  CHECK(latch_time.histogram.counts.size() == 4);
  CHECK(summary.outputs[1].missing == 0);
  CHECK_FALSE(summary.outputs[1].quantiles[0].among);
}

TEST_CASE("a quantile exists up to the share of runs with a value, or mirrored for a min") {
  Results results(ResultNames{{}, {"deployment_time", "rate"}});
  for (long run = 0; run < 1000; ++run) { // 24 stall: 976 values, 10.001 to 10.976
    const double value = run < 24 ? none : 10 + static_cast<double>(run - 23) / 1000;
    results.append(
        {run, run < 24 ? Status::stalled : Status::deployed, {}, {value, value}, "", ""});
  }
  const StatisticsSpec spec{{0.01, 0.024, 0.025, 0.5, 0.976, 0.977, 0.99}, 0.9, AutoBins{}};
  Requirement least;
  least.output = "rate";
  least.min = 1;
  const Summary summary = summarize(results, spec, {}, 0, std::span<const Requirement>(&least, 1));
  const auto &late = summary.outputs[0].quantiles, &low = summary.outputs[1].quantiles;
  for (std::size_t i = 0; i < spec.quantiles.size(); ++i) {
    const double p = spec.quantiles[i];
    CAPTURE(p);
    CHECK(std::isnan(late[i].all.value) == (p > 0.976)); // more than the share that deploys
    CHECK(std::isnan(low[i].all.value) == (p <= 0.024));
    CHECK(why_no_quantile(summary.outputs[0], late[i]).empty() == (p <= 0.976));
    if (p <= 0.976) CHECK(late[i].all.value == Approx(10 + p));
    if (p > 0.024) CHECK(low[i].all.value == Approx(9.976 + p)); // no jump, at the median neither
    CHECK(late[i].among->value == Approx(10 + std::ceil(p * 976) / 1000));
    CHECK(late[i].among->value == low[i].among->value);
  }
  CHECK(low[2].all.value == 10.001); // 24 of 25 runs rank below
  CHECK((late[6].all.bounds.lower == std::nullopt && late[4].all.bounds.lower > 10.9));
  CHECK_FALSE(late[4].all.bounds.upper); // a stalled run ranks there
  CHECK(why_no_quantile(summary.outputs[0], late[6]) ==
        "976 of 1000 runs have a value; the others rank above every value");
  CHECK(why_no_quantile(summary.outputs[1], low[0]) ==
        "976 of 1000 runs have a value; the others rank below every value");
}

TEST_CASE("limits on both sides: runs without a value rank above, and bounds hold for both ends") {
  Results results(ResultNames{{}, {"root.latch_rate"}});
  for (long run = 0; run < 1000; ++run) // 10 stall
    results.append({run,
                    run < 10 ? Status::stalled : Status::deployed,
                    {},
                    {run < 10 ? none : static_cast<double>(run - 9)},
                    "",
                    ""});
  Requirement most;
  most.output = "root.latch_rate";
  most.max = 2000, most.absolute = true;
  const StatisticsSpec spec{{0.25, 0.5, 0.75}, 0.9, AutoBins{}};
  const auto of = [&](std::span<const Requirement> requirements) {
    return summarize(results, spec, {}, 0, requirements).outputs[0];
  };
  const OutputSummary above = of({}), either = of({&most, 1});
  most.absolute = false, most.max = std::nullopt, most.min = 0;
  const OutputSummary below = of({&most, 1});
  for (std::size_t i = 0; i < spec.quantiles.size(); ++i) {
    CHECK(above.quantiles[i].all.value == below.quantiles[i].all.value + 10);
    const auto& [value, bounds, error] = either.quantiles[i].all;
    CHECK(value == above.quantiles[i].all.value);
    CHECK(bounds.lower == below.quantiles[i].all.bounds.lower);
    CHECK(bounds.upper == above.quantiles[i].all.bounds.upper);
    CHECK(either.quantiles[i].among->value == above.quantiles[i].among->value);
  }
}

TEST_CASE("with replicates too, a quantile exists up to the share of runs with a value") {
  std::mt19937_64 random(3);
  Results results(ResultNames{{}, {"t"}});
  Replication four{4, {}};
  for (long run = 0; run < 400; ++run) {
    results.append({run, Status::deployed, {}, {run % 20 == 7 ? none : uniform(random)}, "", ""});
    four.of_row.push_back(static_cast<int>(run % 4 + (run % 3 == 0 && run % 4 < 3)));
  }
  const Summary summary = summarize(results, {{0.5, 0.95, 0.96}, 0.9, AutoBins{}}, four);
  const auto& found = summary.outputs[0].quantiles;
  CHECK((found[1].all.value < 1 && std::isnan(found[2].all.value)));
  CHECK((found[0].all.bounds.upper && !found[1].all.bounds.upper));
  CHECK((found[1].all.bounds.lower && *found[1].all.bounds.lower < found[1].all.value));
  CHECK((found[2].among && found[2].among->value < found[1].all.value));
}

TEST_CASE("a summary counts latch orders and reasons, the most frequent first") {
  Results results = ten_runs();
  results.append({10, Status::invalid, {none, 1}, {none, none}, "", "mass is -1"});
  results.append({11, Status::stalled, {0, 1}, {none, 3}, "tip", "harness holds tip"});
  const Summary summary = summarize(results, {});
  REQUIRE(summary.latch_orders.size() == 3);
  CHECK((summary.latch_orders[0].order == "root>tip" && summary.latch_orders[0].count == 7));
  CHECK((summary.latch_orders[1].order == "tip" && summary.latch_orders[2].order == "tip>root"));
  CHECK(summary.without_latch == 3);
  REQUIRE(summary.reasons.size() == 3);
  CHECK((summary.reasons[0].reason == "friction holds root" && summary.reasons[0].count == 2));
  CHECK(summary.reasons[1].reason == "harness holds tip");
  CHECK(summary.reasons[2].status == Status::invalid);
}

TEST_CASE("reasons that differ in their numbers alone are one") {
  Results results(ResultNames{{}, {}});
  const auto add = [&](Status status, const char* reason) {
    results.append({std::ssize(results.runs), status, {}, {}, "", reason});
  };
  add(Status::stalled, "root lacks 0.5 J, from t = 3 s on");
  add(Status::invalid, "mass is -1, expected > 0");
  add(Status::stalled, "every hinge sticks, from t = 2 s on");
  add(Status::stalled, "root lacks 0.25 J, from t = 3 s on");
  add(Status::invalid, "mass is -2, expected > 0");
  add(Status::failed, "mass is -2, expected > 0"); // of another status
  const std::vector<ReasonCount> reasons = summarize(results, {}).reasons;
  REQUIRE(reasons.size() == 4);
  CHECK((reasons[0].reason == "root lacks … J, from t = 3 s on" && reasons[0].count == 2));
  CHECK((reasons[1].reason == "every hinge sticks, from t = 2 s on" && reasons[1].count == 1));
  CHECK((reasons[2].reason == "mass is …, expected > 0" && reasons[2].count == 2));
  CHECK((reasons[3].status == Status::failed && reasons[3].count == 1));
}

TEST_CASE("a summary correlates each draw with each output and with deployed") {
  const Summary summary = summarize(ten_runs(), {});
  CHECK(summary.correlations.size() == 6);
  const Correlation& latch_time = find(summary, "k", "root.latch_time").value;
  CHECK((latch_time.count == 8 && latch_time.spearman == Approx(1) && latch_time.pearson < 0.99));
  CHECK(find(summary, "k", "root.peak_moment").value.pearson == Approx(-1));
  CHECK(std::isnan(find(summary, "fixed", "root.peak_moment").value.spearman));
  // By hand: k = 0 … 9 against eight ones and two zeros has Σdkdy = 28 − 0.8 · 45 = −8, Σdk² = 82.5
  // and Σdy² = 1.6.
  CHECK(find(summary, "k", "deployed").value.pearson == Approx(-8 / std::sqrt(82.5 * 1.6)));
}

TEST_CASE("without independent draws the bounds come from the replicates") {
  const Results results = ten_runs();
  const Replication halves{2, {0, 1, 0, 1, 0, 1, 0, 1, 0, 0}}; // six runs and four
  const Summary summary = summarize(results, {{0.5}, 0.6, AutoBins{}}, halves);
  CHECK(summary.replicates == 2);
  // By hand: 4 of 6 and 4 of 4 deploy, 0.8 in all with an error of √(2/1 · (0.8² + 0.8²))/10 = 0.16, so 6.25
  // draws' worth, less (t_9/t_1)² of them; mpmath 1.2.1 for those and for the inverse incomplete beta functions.
  CHECK(*summary.statuses[0].bounds.lower == Approx(0.35694348995831723).epsilon(1e-8));
  CHECK(*summary.statuses[0].bounds.upper == Approx(0.98749147581392793).epsilon(1e-8));
  // By hand, with t_1 = tan(0.3 π) = 1.3764: below 19, the median of the eight latch times that there are, lie 2 of
  // the first replicate's 4 and 1 of the second's 4: an error of √(2/1 · (0.5² + 0.5²))/8 = 1/8, to X_(3) and X_(6).
  const Bounds& time = summary.outputs[0].quantiles[0].among->bounds;
  CHECK((summary.outputs[0].missing == 2 && *time.lower == 14 && *time.upper == 35));
  // Of the ten moments 3 of 6 and 1 of 4 lie below the median, 0: √(2/1 · (0.6² + 0.6²))/10 = 0.12, to X_(4) and X_(7).
  const Bounds& moment = summary.outputs[1].quantiles[0].all.bounds;
  CHECK((*moment.lower == -1 && *moment.upper == 2));
  // 5 − k is 0.5 on average; the replicates' sums of deviations are −2 and 2: √(8 · 2/1)/10
  CHECK(summary.outputs[1].mean_error == Approx(0.4));
  const Replication one{1, std::vector<int>(10, 0)};
  const Summary none_from_one = summarize(results, {}, one);
  CHECK_FALSE(none_from_one.statuses[0].bounds.lower);
  CHECK_FALSE(none_from_one.outputs[0].quantiles[1].all.bounds.lower);
  CHECK(std::isnan(none_from_one.outputs[0].mean_error));
}

TEST_CASE("no runs, or none in which anything happened, still have a summary") {
  const Summary empty = summarize(Results(ResultNames{{"k"}, {"t"}}), {});
  CHECK(empty.runs == 0);
  CHECK((std::isnan(empty.statuses[0].rate) && !empty.statuses[0].bounds.lower));
  Results failed(ResultNames{{"k"}, {"t"}});
  failed.append({0, Status::failed, {1}, {none}, "", "step too small"});
  const Summary summary = summarize(failed, {});
  CHECK((summary.outputs[0].moments.count == 0 && summary.outputs[0].missing == 1));
  CHECK(std::isnan(summary.outputs[0].quantiles[0].all.value));
  CHECK(find(summary, "k", "t").value.count == 0);
}

TEST_CASE("deployed is 1, and 0 of every other status, as in shares and verdicts") {
  Results results(ResultNames{{"k"}, {}});
  const std::vector<Status> all{Status::deployed, Status::stalled, Status::timed_out,
                                Status::invalid, Status::failed};
  for (long run = 0; run < 5; ++run)
    results.append(
        {run, all[static_cast<std::size_t>(run)], {static_cast<double>(run)}, {}, "", ""});
  const Column column = deployed_column(results);
  CHECK((column.name == "deployed" && column.values.size() == 5));
  CHECK(std::ranges::equal(column.values, std::vector<double>{1, 0, 0, 0, 0}));
  const Correlation found = find(summarize(results, {}), "k", "deployed").value;
  CHECK(found.count == 5);
  CHECK(found.spearman == Approx(-std::sqrt(0.5)));
}
